// SPDX-License-Identifier: BSD-3-Clause
// Soft shadows: first a few depths around the point tell how far above it the occluder is, then the
// width of the percentage-closer filter grows with that distance (R. Fernando, "Percentage-closer
// soft shadows", 2005): sharp where a thing stands on the ground, soft where it hovers.
#include "render/shaders/shaders.h"

namespace cprsim::shaders {

const char* const kVersion = "#version 330 core\n";

const char* const kLighting = R"(
const int kLights = 4;
uniform vec3 to_key, key_color, ambient_up, ambient_down;
uniform int light_count;
uniform vec4 light_place[kLights];  // w = 0: direction towards the light
uniform vec4 light_axis[kLights];   // w: cosine of the spot's half angle, -2 for no spot
uniform vec3 light_color[kLights];
uniform mat4 light_clip;
uniform float shadow_texel, shadow_softness, shadow_normal_offset;
uniform float still_shadow, moving_shadow;  // 1: the map is looked up
uniform sampler2DShadow still_map, moving_map;
uniform sampler2D still_depth, moving_depth;

const vec2 kDisc[12] = vec2[](
    vec2(-0.326, -0.406), vec2(-0.840, -0.074), vec2(-0.696, 0.457), vec2(-0.203, 0.621),
    vec2(0.962, -0.195), vec2(0.473, -0.480), vec2(0.519, 0.767), vec2(0.185, -0.893),
    vec2(0.507, 0.064), vec2(0.896, 0.412), vec2(-0.322, -0.933), vec2(-0.792, -0.598));

vec3 light_coordinates(vec3 p) { return (light_clip * vec4(p, 1.0)).xyz * 0.5 + 0.5; }

bool lit_region(vec3 q) {
  return all(greaterThan(q.xy, vec2(0.0))) && all(lessThan(q.xy, vec2(1.0)));
}

// 1 in full light, 0 in full shadow; for points on surfaces that cast no shadow on themselves
float seen_softly(sampler2DShadow map, sampler2D depth, vec3 q) {
  float search = shadow_softness + 1.5 * shadow_texel;
  float blockers = 0.0, above = 0.0;
  for (int i = 0; i < 12; i += 1) {
    float d = textureLod(depth, q.xy + kDisc[i] * search, 0.0).r;
    if (d < q.z) {
      blockers += 1.0;
      above += q.z - d;
    }
  }
  if (blockers == 0.0) return 1.0;
  float width = clamp(above / blockers * 2.0, 0.0, 1.0) * shadow_softness + 1.5 * shadow_texel;
  float sum = 0.0;
  for (int i = 0; i < 12; ++i) sum += textureLod(map, vec3(q.xy + kDisc[i] * width, q.z), 0.0);
  return sum / 12.0;
}

// 1 in full light, 0 in full shadow; cheaper, for the objects themselves
float seen_sharply(sampler2DShadow map, vec3 q) {
  vec2 a = vec2(0.45, 1.05) * shadow_texel, b = vec2(-1.05, 0.45) * shadow_texel;
  return 0.25 * (textureLod(map, vec3(q.xy + a, q.z), 0.0) +
                 textureLod(map, vec3(q.xy - a, q.z), 0.0) +
                 textureLod(map, vec3(q.xy + b, q.z), 0.0) +
                 textureLod(map, vec3(q.xy - b, q.z), 0.0));
}

vec3 decoded(vec3 display) { return display * display; }
vec3 encoded(vec3 linear) { return sqrt(clamp(linear, 0.0, 1.0)); }

vec3 ambient_light(vec3 n) { return mix(ambient_down, ambient_up, 0.5 + 0.5 * n.z); }

// what the lights without shadows add
vec3 other_lights(vec3 p, vec3 n) {
  vec3 sum = vec3(0.0);
  for (int i = 0; i < light_count; ++i) {
    vec3 l = light_place[i].w == 0.0 ? light_place[i].xyz : normalize(light_place[i].xyz - p);
    float cone = light_axis[i].w < -1.5
                     ? 1.0
                     : smoothstep(light_axis[i].w, 0.5 + 0.5 * light_axis[i].w,
                                  dot(-l, light_axis[i].xyz));
    sum += light_color[i] * (cone * max(dot(n, l), 0.0));
  }
  return sum;
}
)";

}  // namespace cprsim::shaders
