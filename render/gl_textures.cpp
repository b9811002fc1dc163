// SPDX-License-Identifier: BSD-3-Clause
#include "render/gl_textures.h"

namespace cprsim {

namespace {

constexpr int kSamples = 4;  // all that Mesa's software renderer offers

}  // namespace

GlTextures::Shadow::Shadow(const Gl& gl, int size)
    : depth(make_texture(gl, GL_DEPTH_COMPONENT16, size, size, 1)),
      cover(make_texture(gl, GL_RG16, size, size, 1)),
      target(make_target(gl, {cover}, depth, 1)) {}

GlTextures::GlTextures(const Gl& gl, int w, int h, int shadow_size)
    : object_color(make_texture(gl, GL_RGBA8, w, h, kSamples)),
      object_depth(make_texture(gl, GL_DEPTH_COMPONENT24, w, h, kSamples)),
      kept_depth(make_texture(gl, GL_DEPTH_COMPONENT24, w, h, kSamples)),
      picture(make_texture(gl, GL_RGBA8, w, h, 1)),
      in_light(make_texture(gl, GL_RGBA8, w, h, 1)),
      in_shade(make_texture(gl, GL_RGBA8, w, h, 1)),
      range(make_texture(gl, GL_R32F, w, h, 1)),
      to_objects(make_target(gl, {object_color}, object_depth, kSamples)),
      to_kept_depth(make_target(gl, {}, kept_depth, kSamples)),
      to_picture(make_target(gl, {picture}, 0, 1)),
      to_in_light(make_target(gl, {in_light, range}, 0, 1)),
      to_in_shade(make_target(gl, {in_shade}, 0, 1)),
      to_range(make_target(gl, {range}, 0, 1)),
      still(gl, shadow_size),
      moving(gl, shadow_size),
      compare(gl, GlName::Kind::kSampler),
      levels(gl, GlName::Kind::kSampler) {
  for (GLuint sampler : {GLuint(compare), GLuint(levels)}) {
    gl.SamplerParameteri(sampler, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    gl.SamplerParameteri(sampler, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  }
  for (const GLenum filter : {GLenum{GL_TEXTURE_MIN_FILTER}, GLenum{GL_TEXTURE_MAG_FILTER}}) {
    gl.SamplerParameteri(compare, filter, GL_LINEAR);
    gl.SamplerParameteri(levels, filter, GL_LINEAR);
  }
  gl.SamplerParameteri(levels, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_NEAREST);
  gl.SamplerParameteri(compare, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  gl.SamplerParameteri(compare, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
}

}  // namespace cprsim
