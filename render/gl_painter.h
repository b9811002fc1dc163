// SPDX-License-Identifier: BSD-3-Clause
// Draws with OpenGL. The objects are drawn alone with 4 samples a pixel; a second pass puts them
// over ground and sky, which need no samples because their edges are computed. While the camera
// rests, what never moves is drawn once, in and out of the light, and every later frame only mixes
// the two by the shadow of what moves, inside the region where anything does. Include in .cpp files
// only.
#pragma once

#include <map>
#include <memory>
#include <tuple>
#include <vector>

#include "render/gl_objects.h"
#include "render/scenery.h"
#include "render/tiles.h"

namespace cprsim {

struct GlTextures;

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
  /// @param other_lights  there are lights besides the key light
  GlPainter(const Gl& gl, int width, int height, int shadow_size, bool other_lights,
            const std::vector<Part>& parts);
  ~GlPainter();

  /// The whole picture, from nothing. @param changes  of a TileMap for pictures drawn anew
  void paint(const Frame& frame, const Changes& changes);

  /// Draws what does not move, for paint_moving() with the same view, light and backdrop.
  void store_still(const Frame& frame);

  /// The changing tiles of the picture, on what store_still() has kept.
  void paint_moving(const Frame& frame, const Changes& changes);

  /// @param pixels  RGBA, 4 × width × height of the region, rows from the bottom
  void read(const Region& region, std::vector<std::uint8_t>& pixels) const;

  /// Likewise the whole of what store_still() has kept, in the light, and the depth of its pixels.
  void read_still(std::vector<std::uint8_t>& pixels, std::vector<float>& range) const;

  Mat4 light_clip(const Frame& frame) const;

  /// Widest half shadow, as a fraction of the shadow map's edge.
  static double softness();

 private:
  enum class Which { kStill, kMoving, kAll };

  /// With which light a pass is drawn: the key light may be out, and its shadows left away.
  struct Shine {
    bool key = true, shadows = true;
    Which casters = Which::kAll;
  };

  void draw_shadows(const Frame& frame, Which which);
  void draw_objects(const Frame& frame, Which which, const Region& region, const Shine& shine);
  void draw_sweeps_and_glass(const Frame& frame, Which which);
  void draw_part(const Frame& frame, std::size_t i) const;
  /// Over which background the objects are put.
  enum class Ground { kDirect, kRanged, kCached };

  void compose(Ground ground, const Frame& frame, GLuint target, const Shine& shine,
               const std::vector<TileRun>& runs);
  const Program& program_for(Ground ground, const TileRun& kind);
  void upload_sweeps(const Frame& frame);
  bool upload_tiles(const std::vector<TileRun>& runs, const TileRun& kind);
  void set_backdrop(const Program& program, const Frame& frame) const;
  void set_lighting(const Program& program, const Frame& frame, const Shine& shine) const;
  void bind(GLuint unit, GLenum kind, GLuint texture, GLuint sampler = 0) const;
  void limit(const Region& region) const;
  bool drawn(std::size_t part, Which which) const;

  Region whole() const { return {0, 0, width_, height_}; }

  const Gl& gl_;
  int width_, height_, shadow_size_;
  bool other_lights_;
  const std::vector<Part>& parts_;
  std::unique_ptr<Program> objects_, shadows_;
  std::map<std::tuple<Ground, bool, bool, bool, bool>, std::unique_ptr<Program>> grounds_;
  std::unique_ptr<GlTextures> textures_;
  std::vector<Geometry> geometries_;
  Geometry tubes_, tube_shadows_, ribbons_, tiles_;
};

}  // namespace cprsim
