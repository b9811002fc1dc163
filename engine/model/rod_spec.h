// SPDX-License-Identifier: BSD-3-Clause
// A slender elastic rod as the scene describes it. The cross-section frame's z axis is the tangent,
// base → tip; arc length is that of the unloaded rod.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "engine/math/types.h"
#include "engine/model/body_spec.h"
#include "engine/model/geometry.h"
#include "engine/model/place.h"
#include "engine/model/profile.h"
#include "engine/model/solver_spec.h"

namespace cprsim {

enum class SectionShape { kCircle, kAnnulus, kRectangle, kEllipse };

/// size: circle (radius, _); annulus (outer, inner); rectangle (width along x, height along y);
/// ellipse semi-axes along x and y. All in m.
struct SectionSpec {
  SectionShape shape = SectionShape::kCircle;
  Vec2 size = Vec2::Zero();
  double s = 0;  ///< where it is, as a fraction of the rod's length
  Place place;
};

struct MaterialSpec {
  double density = 0;         ///< kg/m³
  double youngs_modulus = 0;  ///< Pa
  double shear_modulus = 0;   ///< Pa, also when the scene gives Poisson's ratio
  Place place;
  double thermal_expansion = 0;  ///< relative, 1/K
};

/// A ring of another material around the rod, bonded to what is within.
struct LayerSpec {
  SectionSpec section;  ///< an annulus
  MaterialSpec material;
  Place place;
};

/// Direct stiffnesses that replace those of section and material. Bending x: about the section's x
/// axis, N m²; torsion N m²; axial and shear N.
struct StiffnessSpec {
  std::optional<double> bending_x, bending_y, torsion, axial, shear_x, shear_y;
  Place place;
};

/// Kelvin-Voigt coefficients: bending, torsion N m² s; axial, shear N s.
struct DampingSpec {
  double bending = 0, torsion = 0, axial = 0, shear = 0;
  Place place;
};

/// Of the fluid around a rod, at rest or in a steady current.
struct DragSpec {
  double normal = 0, tangential = 0;  ///< force per length and squared speed, kg/m²
  double fluid_density = 0;           ///< kg/m³; 0: neither buoyancy nor added mass
  double added_mass = 0;  ///< fluid that follows a motion across the rod, over the fluid displaced
  Place place;
};

/// Magnetisation from one place of a rod to another, fractions of its length: magnetic moment per
/// length, in section axes, A m.
struct MagnetSpec {
  double from = 0, to = 1;
  Vec3 moment = Vec3::Zero();
};

/// How much warmer a rod is than when it was without stress, the same all along it; times
/// profile(t) (constant 1 if the scene gives no time function).
struct TemperatureSpec {
  double rise = 0;               ///< of the centreline, K
  Vec2 gradient = Vec2::Zero();  ///< across the section along its x and y axes, K/m
  bool has_profile = false;
  Profile profile;
  Place place;
};

/// Curvature about x and y and twist of the unloaded rod at s, a fraction of its length; 1/m.
struct RestSample {
  double s = 0;
  Vec3 curvature = Vec3::Zero();
};

/// A point of a rod's centreline at s, a fraction of its length; world axes.
struct CurveSample {
  double s = 0;
  Vec3 position = Vec3::Zero();
};

/// A rigid thin disk across the rod, its centre on the centreline; without a radius a point mass.
struct DiskSpec {
  double s = 1;                 ///< where it is, as a fraction of the rod's length, above 0
  double mass = 0, radius = 0;  ///< kg, m
};

enum class EndJoint { kFree, kFixed, kRevolute, kBall, kUniversal };

/// How a rod's end is held. The rod's end frame coincides with `at` when the joint's freedoms are
/// 0: at the base z points into the rod, at the tip out of it.
struct RodEndSpec {
  EndJoint joint = EndJoint::kFree;
  FrameRef at;
  Vec3 axis = Vec3::UnitX();  ///< revolute: unit axis in the frame `at`
  bool spin_free = false;     ///< turns freely about the rod's tangent
  Place place;
};

/// How finely a rod is cut.
struct RodCut {
  int elements = 0;  ///< cells of shooting, elements of the other methods
  int order = 0;     ///< highest degree of a strain basis
};

struct RodSpec {
  // Compiled once, in scene.cpp: dozens of files make and copy one.
  RodSpec();
  RodSpec(const RodSpec&);
  RodSpec(RodSpec&&) noexcept;
  RodSpec& operator=(const RodSpec&);
  RodSpec& operator=(RodSpec&&) noexcept;
  ~RodSpec();

  std::string name;  ///< scoped
  Place place;
  RodEndSpec base, tip;
  double length = 0;             ///< m, unloaded; a length drive replaces it
  std::optional<Method> method;  ///< where it is not the scene's
  std::optional<RodCut> cut;     ///< what a tool chose for it, before what the solver says
  SectionSpec section;
  /// Where sections vary: two or more by ascending s, of one shape between different s; linear
  /// between them, a step where two have the same s. `section` is the first then.
  std::vector<SectionSpec> sections;
  std::optional<MaterialSpec> material;
  std::vector<LayerSpec> layers;  ///< from the inside out
  StiffnessSpec stiffness;
  /// Bending about x and y, twist: of the unloaded rod, section axes, 1/m.
  Vec3 rest_curvature = Vec3::Zero();
  std::vector<RestSample> rest_samples;  ///< instead of it, from 0 to 1; a cubic spline between
  std::vector<CurveSample> start;        ///< where it is to begin, from 0 to 1; empty: unloaded
  std::optional<DampingSpec> damping;
  std::optional<DragSpec> drag;
  std::vector<DiskSpec> disks;  ///< by ascending s
  std::vector<MagnetSpec> magnets;
  std::optional<TemperatureSpec> temperature;
  bool gravity = true;
  SurfaceSpec surface;
  std::vector<std::string> without;  ///< effects switched off for this rod
  Look look;

  /// What is seen of it from outside, where sections do not vary.
  const SectionSpec& outline() const { return layers.empty() ? section : layers.back().section; }

  bool lacks(const std::string& effect) const {
    return std::find(without.begin(), without.end(), effect) != without.end();
  }
};

}  // namespace cprsim
