// SPDX-License-Identifier: BSD-3-Clause
#include "render/tiles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace cprsim {

namespace {

constexpr int kTile = 16;   // pixels; smaller ones cost more to look after than they save
constexpr int kCells = 64;  // along an edge of the shadow map

using Box2 = Eigen::AlignedBox2d;

/// A grid of marks.
class Marks {
 public:
  Marks(int columns, int rows)
      : columns_(columns), rows_(rows), set_(static_cast<std::size_t>(columns * rows)) {}

  /// @param box  in cells
  void add(const Box2& box) {
    visit(box, [&](std::size_t i) {
      set_[i] = 1;
      return false;
    });
  }

  bool any(const Box2& box) const {
    return const_cast<Marks*>(this)->visit(box, [&](std::size_t i) { return set_[i] != 0; });
  }

  bool at(int column, int row) const {
    return set_[static_cast<std::size_t>(row * columns_ + column)];
  }

  void add_all() { std::fill(set_.begin(), set_.end(), char{1}); }

 private:
  template <class Test>
  bool visit(const Box2& box, Test&& test) {
    if (box.isEmpty()) return false;
    const auto clamped = [](double v, int top) {
      return static_cast<int>(std::clamp(std::floor(v), -1.0, static_cast<double>(top)));
    };
    const int x1 = std::min(clamped(box.max().x(), columns_), columns_ - 1);
    const int y1 = std::min(clamped(box.max().y(), rows_), rows_ - 1);
    for (int y = std::max(clamped(box.min().y(), rows_), 0); y <= y1; ++y) {
      for (int x = std::max(clamped(box.min().x(), columns_), 0); x <= x1; ++x) {
        if (test(static_cast<std::size_t>(y * columns_ + x))) return true;
      }
    }
    return false;
  }

  int columns_, rows_;
  std::vector<char> set_;
};

Vec2 light_place(const Mat4& light_clip, const Vec3& p) {
  const Vec4 q = light_clip * Vec4(p.x(), p.y(), p.z(), 1);
  return 0.5 * q.head<2>() + Vec2::Constant(0.5);
}

/// What moves, cut into pieces small enough to be boxed: their corners and how far they reach about
/// them.
template <class Visit>
void visit_pieces(const std::vector<Part>& parts, const Drawing& drawing, bool all, Visit&& visit) {
  std::vector<Vec3> corners(8);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const bool still = !parts[i].moves && parts[i].look.opacity >= 1;
    if (parts[i].is_ground || (still && !all)) continue;
    for (std::size_t k = 0; k < 8; ++k)
      corners[k] = drawing.part_poses[i] * parts[i].corners[k];
    visit(corners, 0.0, parts[i].casts_shadow);
  }
  std::vector<Vec3> pair(2);
  for (const Tube& tube : drawing.tubes) {
    for (std::size_t k = 0; k + 1 < tube.rings.size(); ++k) {
      pair = {tube.rings[k].position, tube.rings[k + 1].position};
      visit(pair, tube.radius, true);
    }
  }
  for (const Ribbon& ribbon : drawing.ribbons) {
    for (std::size_t k = 0; k + 1 < ribbon.points.size(); ++k) {
      pair = {ribbon.points[k].position, ribbon.points[k + 1].position};
      visit(pair, 0.0, false);
    }
  }
}

/// The box of the corners in the picture, in pixels; nothing if a corner is not in front of the
/// eye.
std::optional<Box2> seen_box(const View& view, const std::vector<Vec3>& corners, double reach) {
  Box2 box;
  for (const Vec3& p : corners) {
    if (!p.allFinite() || -view.to_camera(p).z() < view.near + reach) return std::nullopt;
    // near the edge of a wide picture a ball is seen wider than in the middle, hence 1.5; a ribbon
    // and the thinnest rod are drawn up to 2 pixels to each side
    const Vec2 about = Vec2::Constant(1.5 * reach / view.pixel_size(p) + 3);
    const Vec2 at = view.to_pixel(p);
    box.extend(Vec2(at - about)).extend(Vec2(at + about));
  }
  return box;
}

Region joined(const Region& a, const Region& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  return {std::min(a.x0, b.x0), std::min(a.y0, b.y0), std::max(a.x1, b.x1), std::max(a.y1, b.y1)};
}

}  // namespace

bool alike(const TileRun& a, const TileRun& b) {
  return a.objects == b.objects && a.shadow == b.shadow && a.ground == b.ground && a.sky == b.sky;
}

TileMap::TileMap(const View& view, const Mat4& light_clip, bool anew)
    : view_(view),
      light_clip_(light_clip),
      anew_(anew),
      columns_((view.width + kTile - 1) / kTile),
      rows_((view.height + kTile - 1) / kTile),
      tiles_(static_cast<std::size_t>(columns_ * rows_)) {}

/// From the eye through a point of the picture, of depth 1.
Vec3 TileMap::ray(double x, double y) const {
  return view_.R_WC * Vec3((2 * x / view_.width - 1) * view_.tan_half_x,
                           (2 * y / view_.height - 1) * view_.tan_half_y, -1);
}

TileMap::TileMap(const View& view, const std::vector<float>& range, const Mat4& light_clip)
    : TileMap(view, light_clip, false) {
  for (int y = 0; y < view.height; ++y) {
    for (int x = 0; x < view.width; ++x) {
      const float depth = range[static_cast<std::size_t>(y * view.width + x)];
      if (!(depth > 0)) continue;
      const Vec3 p = view.eye + static_cast<double>(depth) * ray(x + 0.5, y + 0.5);
      tiles_[static_cast<std::size_t>(y / kTile * columns_ + x / kTile)].light.extend(
          light_place(light_clip, p));
    }
  }
}

TileMap::TileMap(const View& view, double ground_z, const Mat4& light_clip)
    : TileMap(view, light_clip, true) {
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      Tile& tile = tiles_[static_cast<std::size_t>(row * columns_ + column)];
      int sky = 0;
      for (int corner = 0; corner < 4; ++corner) {
        const Vec3 r = ray((column + corner % 2) * kTile, (row + corner / 2) * kTile);
        const double depth = (ground_z - view.eye.z()) / r.z();
        const Vec3 p = view.eye + depth * r;
        if (depth > 0 && p.allFinite()) {
          tile.light.extend(light_place(light_clip, p));
        } else {
          ++sky;
        }
      }
      // at the horizon a tile reaches to infinity
      tile.sky = sky > 0;
      if (sky > 0 && sky < 4) tile.light = Box2(Vec2(0, 0), Vec2(1, 1));
    }
  }
}

Changes TileMap::changes(const std::vector<Part>& parts, const Drawing& drawing,
                         double softness) const {
  Marks seen(columns_, rows_), shaded(kCells, kCells);
  visit_pieces(parts, drawing, anew_,
               [&](const std::vector<Vec3>& corners, double reach, bool casts) {
                 const std::optional<Box2> box = seen_box(view_, corners, reach);
                 if (!box) {
                   seen.add_all();
                 } else {
                   seen.add(Box2(box->min() / kTile, box->max() / kTile));
                 }
                 if (!casts) return;
                 // the look-up of a shadow spreads over two texels of the level as wide as the
                 // softness
                 const Vec2 about =
                     Vec2::Constant(2 * softness + reach * light_clip_.block<1, 3>(0, 0).norm());
                 Box2 shadow;
                 for (const Vec3& p : corners) {
                   const Vec2 at = light_place(light_clip_, p);
                   if (at.allFinite()) shadow.extend(Vec2(at - about)).extend(Vec2(at + about));
                 }
                 if (!shadow.isEmpty())
                   shaded.add(Box2(shadow.min() * kCells, shadow.max() * kCells));
               });

  Changes changes;
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      const Tile& tile = tiles_[static_cast<std::size_t>(row * columns_ + column)];
      const Box2& light = tile.light;
      const bool objects = seen.at(column, row);
      const bool shadow =
          !light.isEmpty() && shaded.any(Box2(light.min() * kCells, light.max() * kCells));
      if (!objects && !shadow && !anew_) continue;
      const Region region{column * kTile, row * kTile, std::min((column + 1) * kTile, view_.width),
                          std::min((row + 1) * kTile, view_.height)};
      changes.all = joined(changes.all, region);
      if (objects) changes.objects = joined(changes.objects, region);
      const TileRun run{region, objects, shadow, !light.isEmpty(), tile.sky};
      TileRun* last = changes.runs.empty() ? nullptr : &changes.runs.back();
      if (last != nullptr && last->region.x1 == region.x0 && last->region.y0 == region.y0 &&
          alike(*last, run)) {
        last->region.x1 = region.x1;
      } else {
        changes.runs.push_back(run);
      }
    }
  }
  return changes;
}

}  // namespace cprsim
