// SPDX-License-Identifier: BSD-3-Clause
// What is to be drawn, as plain data: no GL here, and no physics beyond this file.
#pragma once

#include <array>
#include <vector>

#include "engine/model/scene.h"
#include "engine/run/snapshot.h"
#include "render/palette.h"
#include "render/renderer.h"
#include "render/shapes.h"

namespace cprsim {

/// A visual of a body; made once per scene.
struct Part {
  int body = kWorld;
  Pose X_BV;
  TriMesh mesh;
  std::array<Vec3, 8> corners;  ///< of the box about the mesh
  Look look;
  bool moves = false;
  bool casts_shadow = true;
  bool closed = false;     ///< only the outside can be seen
  bool is_ground = false;  ///< a wide level plane: drawn as the ground itself
};

/// A rod at one instant: sections along the centreline, base → tip.
struct Tube {
  struct Ring {
    Vec3 position;
    Mat3 rotation;  ///< section to world, z = tangent
    Color color;
    double s = 0;      ///< fraction of the length
    double width = 1;  ///< of the section here, over what it is elsewhere
  };

  std::vector<Ring> rings;
  SectionSpec section;  ///< with a size of 0: a circle of `radius`
  double radius = 0;
  Look look;
};

/// A line of constant width on the screen.
struct Ribbon {
  struct Point {
    Vec3 position;
    float opacity = 1;
  };

  std::vector<Point> points;
  Color color = Color::Zero();
  double pixels = 3;
};

struct Ball {
  Vec3 centre = Vec3::Zero();
  double radius = 0;
};

struct Drawing {
  std::vector<Pose> part_poses;  ///< X_WV of each Part
  std::vector<Tube> tubes;
  std::vector<Ribbon> ribbons;
  bool tubes_mean_numbers = false;  ///< their colours are those of a legend
};

/// Bodies that never move: static ones and those fixed to the world or to such a body.
std::vector<bool> still_bodies(const Scene& scene);

std::vector<Part> make_parts(const Scene& scene);

/// A pleasant look where the scene gives none.
Look look_of(const VisualSpec& visual, bool fixed);
Look look_of_rod(const RodSpec& rod, std::size_t index);

/// The value a rod point is coloured by: |bending moment|, |curvature|, tension or energy per
/// metre.
double colored_value(ColorBy by, const RodPoint& point);

/// Largest absolute value over all rods.
double largest_value(ColorBy by, const Snapshot& now);

/// @param color_range  of decor.color_by
Drawing make_drawing(const Scene& scene, const std::vector<Part>& parts, const Snapshot& now,
                     const FrameDecor& decor, const Vec2& color_range);

/// Ball about everything but the ground.
Ball bounds_of(const std::vector<Part>& parts, const Drawing& drawing);

/// Height of the floor: a level plane of the scene, else just below the lowest thing that never
/// moves, and low enough for rods with a free end to hang down.
double ground_height(const Scene& scene, const std::vector<Part>& parts, const Drawing& drawing);

/// One colour range from one snapshot: the largest value, rounded up to a number of 1, 2, 5.
Vec2 range_of(ColorBy by, double largest);

}  // namespace cprsim
