// SPDX-License-Identifier: BSD-3-Clause
// Draws with OpenGL. The objects are drawn alone with 4 samples a pixel; a second pass puts them
// over ground and sky, which need no samples because their edges are computed. While the camera
// rests, what never moves is drawn once, in and out of the light, and every later frame only mixes
// the two by the shadow of what moves, inside the region where anything does. Include in .cpp files
// only.
#pragma once

#include <memory>
#include <vector>

#include "render/gl_objects.h"
#include "render/region.h"

namespace cprsim {

/// Everything one picture depends on.
struct Frame {
  View view;
  const Drawing& drawing;
  Lighting light;
  Backdrop backdrop;
  Ball shadow_ball;  ///< what throws shadows lies in it
};

class GlPainter {
 public:
  /// Throws std::runtime_error if the device cannot do it.
  GlPainter(const Gl& gl, int width, int height, int shadow_size, const std::vector<Part>& parts);
  ~GlPainter();

  /// The whole picture, from nothing.
  void paint(const Frame& frame);

  /// Draws what does not move, for paint_moving() with the same view, light and backdrop.
  void store_still(const Frame& frame);

  /// The picture inside the region, on what store_still() has kept.
  void paint_moving(const Frame& frame, const Region& region);

  /// Metres by which the widest shadow exceeds what throws it.
  double softness(const Ball& shadow_ball) const;

  /// @param pixels  RGBA, 4 × width × height of the region, rows from the bottom
  void read(const Region& region, std::vector<std::uint8_t>& pixels) const;

  /// Likewise the whole of what store_still() has kept, in the light.
  void read_still(std::vector<std::uint8_t>& pixels) const;

 private:
  enum class Which { kStill, kMoving, kAll };
  struct Textures;

  void draw_shadows(const Frame& frame, Which which, GLuint target);
  void draw_objects(const Frame& frame, Which which, const Region& region, bool key_light,
                    bool still_shadow, bool moving_shadow);
  void draw_sweeps_and_glass(const Frame& frame, Which which);
  void draw_part(const Frame& frame, std::size_t i) const;
  void resolve(const Region& region) const;
  void compose(const Program& program, const Frame& frame, GLuint target, bool key_light,
               bool still_shadow, bool moving_shadow) const;
  void upload_sweeps(const Frame& frame);
  void read_from(GLuint target, const Region& region, std::vector<std::uint8_t>& pixels) const;
  void set_lighting(const Program& program, const Frame& frame, bool key_light, bool still_shadow,
                    bool moving_shadow) const;
  void bind(GLuint unit, GLuint texture, GLuint sampler = 0) const;
  void limit(const Region& region) const;
  bool drawn(std::size_t part, Which which) const;

  const Gl& gl_;
  int width_, height_, shadow_size_;
  const std::vector<Part>& parts_;
  std::unique_ptr<Program> objects_, shadows_, direct_, ranged_, cached_;
  std::unique_ptr<Textures> textures_;
  std::vector<Geometry> geometries_;
  Geometry tubes_, ribbons_;
  GlName nothing_;  ///< the vertex array of the pass that has no vertices
};

}  // namespace cprsim
