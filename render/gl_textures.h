// SPDX-License-Identifier: BSD-3-Clause
// The pictures that GlPainter draws into and reads from. Include in .cpp files only.
#pragma once

#include "render/gl_objects.h"

namespace cprsim {

/// `to_x` is the framebuffer that draws into x.
struct GlTextures {
  /// What the key light sees: depths, and how much of a texel is covered, at what depth.
  struct Shadow {
    Shadow(const Gl& gl, int size);

    GlName depth, cover, target;
  };

  GlTextures(const Gl& gl, int width, int height, int shadow_size);

  GlName object_color, object_depth, kept_depth, picture, in_light, in_shade, range;
  GlName to_objects, to_kept_depth, to_picture, to_in_light, to_in_shade, to_range;
  Shadow still, moving;
  GlName compare, levels;
};

}  // namespace cprsim
