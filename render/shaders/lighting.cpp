// SPDX-License-Identifier: BSD-3-Clause
// Soft shadows of things that do not shade themselves: the shadow map is kept a second time as how
// much of a texel is covered and at what depth, with its mip levels. A coarse level tells how far
// above the point the occluder is, and with it the width of the half shadow (R. Fernando,
// "Percentage-closer soft shadows", 2005); the level of that width is then the answer, read at four
// places to be smooth. Sharp where a thing stands on the ground, soft where it hovers, at the cost
// of five look-ups.
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
uniform float shadow_texel, shadow_softness, shadow_search, shadow_normal_offset;
uniform float shadowed;  // 1: the map is looked up
uniform sampler2DShadow shadow_map;
uniform sampler2D shadow_cover;  // covered share, and that times the depth

vec3 light_coordinates(vec3 p) { return (light_clip * vec4(p, 1.0)).xyz * 0.5 + 0.5; }

bool lit_region(vec3 q) {
  return all(greaterThan(q.xy, vec2(0.0))) && all(lessThan(q.xy, vec2(1.0)));
}

// 1 in full light, 0 in full shadow; for points on surfaces that cast no shadow on themselves
float seen_softly(sampler2D cover, vec3 q) {
  vec2 near = textureLod(cover, q.xy, shadow_search).rg;
  float above = q.z - near.g / max(near.r, 1e-6);
  // in texels; 1.2 hides the texels of the finest level
  float width = clamp(1.4 * above, 0.0, 1.0) * shadow_softness / shadow_texel + 1.2;
  float level = log2(width) - 0.5;
  vec2 step = 0.36 * width * shadow_texel * vec2(1.0, -1.0);
  float covered = textureLod(cover, q.xy + step.xx, level).r +
                  textureLod(cover, q.xy + step.xy, level).r +
                  textureLod(cover, q.xy + step.yx, level).r +
                  textureLod(cover, q.xy + step.yy, level).r;
  return near.r > 0.002 && above > 0.0 ? 1.0 - 0.25 * covered : 1.0;
}

// likewise, for the objects themselves
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
#ifdef OTHER_LIGHTS
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
#else
vec3 other_lights(vec3 p, vec3 n) { return vec3(0.0); }
#endif
)";

}  // namespace cprsim::shaders
