// SPDX-License-Identifier: BSD-3-Clause
// Kinds of one program: DIRECT paints ground and sky under the objects; with RANGE it also
// writes how far away everything is; CACHED takes the unmoving part of the picture from two stored
// ones, in and out of the light, and decides between them by the shadow of what moves.
#include "render/shaders/shaders.h"

namespace cprsim::shaders {

const char* const kSceneVertex = R"(
layout(location = 0) in vec3 position;  // in clip coordinates
uniform vec3 ray_centre, ray_right, ray_up;  // of the picture's middle and half its edges
out vec3 ray;
void main() {
  ray = ray_centre + position.x * ray_right + position.y * ray_up;
  gl_Position = vec4(position.xy, 0.0, 1.0);
}
)";

const char* const kSceneFragment = R"(
in vec3 ray;
uniform vec3 eye;
layout(location = 0) out vec4 pixel;

#ifdef OBJECTS
uniform sampler2DMS objects;
vec4 object_at(ivec2 at) {
  return 0.25 * (texelFetch(objects, at, 0) + texelFetch(objects, at, 1) +
                 texelFetch(objects, at, 2) + texelFetch(objects, at, 3));
}
#else
vec4 object_at(ivec2 at) { return vec4(0.0); }
#endif

#ifdef CACHED
uniform sampler2D in_light, in_shade, range;

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec4 object = object_at(at);
  vec3 color = texelFetch(in_light, at, 0).rgb;
#ifdef SHADOW
  float distance = texelFetch(range, at, 0).r;
  vec3 q = light_coordinates(eye + distance * ray);
  float seen = distance > 0.0 && lit_region(q) ? seen_softly(shadow_cover, q) : 1.0;
  color = mix(texelFetch(in_shade, at, 0).rgb, color, seen);
#endif
  pixel = vec4(object.rgb + (1.0 - object.a) * color, 1.0);
}
#else
uniform vec3 ground_color, horizon_color, zenith_color, middle;
uniform float ground_z, grid, cell, fade_from, fade_to, line_width, line_shade;
#ifdef RANGE
uniform sampler2DMS object_depth;
uniform vec2 depth_terms;  // distance = x / (y - depth)
layout(location = 1) out float range;
#endif

vec3 sky(vec3 direction) {
  float h = clamp(direction.z * 1.6, 0.0, 1.0);
  return mix(horizon_color, zenith_color, h * (2.0 - h));
}

// how much of a grid line covers the pixel; c: where it is, w: how much of the grid it spans
float line_at(vec2 c, vec2 w, float width) {
  vec2 d = abs(fract(c - 0.5) - 0.5) / w;
  vec2 l = clamp(0.5 * width + 0.5 - d, 0.0, 1.0) * clamp(1.5 - 4.0 * w, 0.0, 1.0);
  return max(l.x, l.y);
}

vec3 ground(vec3 p) {
  vec2 c = p.xy * (1.0 / cell);
  vec2 w = max(fwidth(c), vec2(1e-6));
  float line = max(0.45 * line_at(c, w, line_width),
                   line_at(0.2 * c, 0.2 * w, 1.3 * line_width)) * grid;
  float seen = 1.0;
#ifdef SHADOW
  vec3 q = light_coordinates(p);
  if (lit_region(q)) seen = seen_softly(shadow_cover, q);
#endif
  vec3 albedo = decoded(ground_color) * (1.0 + line_shade * line);
  vec3 light = ambient_up + key_color * (seen * max(to_key.z, 0.0)) +
               other_lights(p, vec3(0.0, 0.0, 1.0));
  vec3 color = encoded(albedo * light);
  return mix(color, horizon_color, smoothstep(fade_from, fade_to, length(p.xy - middle.xy)));
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec4 object = object_at(at);
#ifdef GROUND
  float far = (ground_z - eye.z) / ray.z;
#ifdef SKY
  bool on_ground = far > 0.0;
  vec3 floor_color = ground(eye + (on_ground ? far : 1.0) * ray);
  vec3 color = on_ground ? floor_color : sky(normalize(ray));
#else
  const bool on_ground = true;
  vec3 color = ground(eye + far * ray);
#endif
#else
  const float far = 0.0;
  const bool on_ground = false;
  vec3 color = sky(normalize(ray));
#endif
#ifdef RANGE
  float depth = texelFetch(object_depth, at, 0).r;
  range = depth < 1.0 ? depth_terms.x / (depth_terms.y - depth) : (on_ground ? far : -1.0);
#endif
  pixel = vec4(object.rgb + (1.0 - object.a) * color, 1.0);
}
#endif
)";

}  // namespace cprsim::shaders
