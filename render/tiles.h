// SPDX-License-Identifier: BSD-3-Clause
// Which parts of the picture change from frame to frame: squares of pixels where something moving
// is seen, or where its shadow may fall. Everything else is taken from the picture of what stands
// still.
#pragma once

#include <vector>

#include "render/camera.h"
#include "render/drawing.h"

namespace cprsim {

/// Pixels x0 <= x < x1, y0 <= y < y1, origin at the lower left corner.
struct Region {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;

  int width() const { return x1 - x0; }

  int height() const { return y1 - y0; }

  bool empty() const { return x1 <= x0 || y1 <= y0; }
};

/// Neighbouring tiles of one row that need the same treatment; in a picture drawn anew, everything
/// is taken as moving.
struct TileRun {
  Region region;
  bool objects = false;  ///< something moving may be seen
  bool shadow = false;   ///< something moving may throw a shadow
  bool ground = true;    ///< some of it is not sky
  bool sky = true;       ///< some of it may be sky
};

/// Do they need the same treatment?
bool alike(const TileRun& a, const TileRun& b);

struct Changes {
  std::vector<TileRun> runs;
  Region objects;  ///< box about all runs with objects
  Region all;      ///< box about all runs
};

class TileMap {
 public:
  /// @param range       depth of what stands still, pixel by pixel, rows from the bottom; <= 0: sky
  /// @param light_clip  world → the shadow map's clip coordinates
  TileMap(const View& view, const std::vector<float>& range, const Mat4& light_clip);

  /// Likewise, for a picture drawn anew, of which only the ground's height is known.
  TileMap(const View& view, double ground_z, const Mat4& light_clip);

  /// @param softness  widest half shadow, as a fraction of the shadow map's edge
  Changes changes(const std::vector<Part>& parts, const Drawing& drawing, double softness) const;

 private:
  struct Tile {
    bool sky = true;
    Eigen::AlignedBox2d light;  ///< where its pixels are in the shadow map, in [0,1]²; empty: sky
  };

  TileMap(const View& view, const Mat4& light_clip, bool anew);
  Vec3 ray(double x, double y) const;

  View view_;
  Mat4 light_clip_;
  bool anew_;
  int columns_ = 0, rows_ = 0;
  std::vector<Tile> tiles_;
};

}  // namespace cprsim
