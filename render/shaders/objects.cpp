// SPDX-License-Identifier: BSD-3-Clause
#include "render/shaders/shaders.h"

namespace cprsim::shaders {

const char* const kObjectVertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 color;
uniform mat4 clip_from_world, world_from_object;
uniform vec4 cut;  // nothing is drawn where dot(cut, p) < 0
out vec3 p_W, n_W;
out vec4 tint;
out float gl_ClipDistance[1];
void main() {
  vec4 p = world_from_object * vec4(position, 1.0);
  p_W = p.xyz;
  n_W = mat3(world_from_object) * normal;
  tint = color;
  gl_ClipDistance[0] = dot(cut, p);
  gl_Position = clip_from_world * p;
}
)";

const char* const kObjectFragment = R"(
in vec3 p_W, n_W;
in vec4 tint;
uniform vec3 eye, specular, emissive;
uniform float shininess, unlit, self_lit;  // self_lit: share of the colour that needs no light
layout(location = 0) out vec4 pixel;
void main() {
  if (unlit > 0.5) {
    pixel = vec4(tint.rgb * tint.a, tint.a);
    return;
  }
  vec3 to_eye = normalize(eye - p_W);
  vec3 n = normalize(n_W);
  if (dot(n, to_eye) < 0.0 && !gl_FrontFacing) n = -n;
  float facing = max(dot(n, to_eye), 0.0);
  float toward = dot(n, to_key);
  float seen = 1.0;
  if (toward > 0.0 && shadowed > 0.5) {
    vec3 q = light_coordinates(p_W + n * shadow_normal_offset);
    if (lit_region(q)) seen = seen_sharply(shadow_map, q);
  }
  vec3 albedo = decoded(tint.rgb);
  vec3 key = key_color * (seen * max(toward, 0.0));
  vec3 light = ambient_light(n) + key + other_lights(p_W, n);
  vec3 mirror = reflect(-to_eye, n);
  float grazing = 1.0 - facing;
  float fresnel = 0.03 + 0.35 * grazing * grazing * grazing * grazing;
  vec3 room = mix(ambient_down, ambient_up * 1.4, smoothstep(-0.15, 0.5, mirror.z));
  float highlight = pow(max(dot(mirror, to_key), 0.0), shininess) * (0.25 + 0.02 * shininess);
  light = mix(light, vec3(1.0), self_lit);
  vec3 glow = specular * key_color * (highlight * seen * step(0.0, toward)) + room * fresnel;
  vec3 color = encoded(albedo * light + glow + decoded(emissive));
  pixel = vec4(color * tint.a, tint.a);
}
)";

const char* const kShadowVertex = R"(
layout(location = 0) in vec3 position;
uniform mat4 clip_from_world, world_from_object;
void main() { gl_Position = clip_from_world * (world_from_object * vec4(position, 1.0)); }
)";

const char* const kShadowFragment = R"(
layout(location = 0) out vec2 cover;
void main() { cover = vec2(1.0, gl_FragCoord.z); }
)";

}  // namespace cprsim::shaders
