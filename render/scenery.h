// SPDX-License-Identifier: BSD-3-Clause
// Light, ground and sky of a scene, as numbers for the shaders; plain data, no GL.
#pragma once

#include <vector>

#include "engine/model/scene.h"
#include "engine/run/snapshot.h"
#include "render/drawing.h"

namespace cprsim {

/// One light, the key light, casts shadows; the others only add brightness. Colours are linear.
struct Lighting {
  struct Other {
    Vec4 place;  ///< w = 1: a position; w = 0: the direction towards it
    Vec4 axis;   ///< a spot's direction and the cosine of its half angle; w = -2: no spot
    Vec3 color;
  };

  Vec3 to_key{0, 0, 1};
  Vec3 key_color = Vec3::Zero();
  Vec3 ambient_up = Vec3::Zero(), ambient_down = Vec3::Zero();  ///< on faces turned up and down
  std::vector<Other> others;                                    ///< at most 4
  bool shadows = true;

  bool operator==(const Lighting&) const;
};

struct Backdrop {
  double ground_z = 0;
  bool grid = true;
  double cell = 0.1;                  ///< m between grid lines
  double line_shade = 0;              ///< by which share they are brighter than the ground
  double fade_from = 1, fade_to = 5;  ///< m from `middle`, where the ground melts into the horizon
  Vec3 middle = Vec3::Zero();
  Vec3 ground_color, horizon_color, zenith_color;  ///< display RGB

  bool operator==(const Backdrop&) const = default;
};

/// The first directional light that asks for shadows is the key light; if none asks and the scene
/// allows shadows, the first light is. Without lights there is a sun. Brightness is balanced so
/// that a white surface facing the key light stays just below full white.
Lighting make_lighting(const Scene& scene, const Snapshot& now, const Ball& bounds);

Backdrop make_backdrop(const Scene& scene, const Ball& bounds, double ground_z);

}  // namespace cprsim
