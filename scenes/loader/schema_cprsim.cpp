// SPDX-License-Identifier: BSD-3-Clause
// The flexible half of the table: the elements of the namespace urn:cprsim:1.
#include "engine/model/place_law.h"
#include "scenes/loader/schema.h"

namespace cprsim {

namespace {

using T = ValueType;
using S = Status;

constexpr auto kTimed =
    "cprsim:profile cprsim:drive cprsim:load cprsim:magnetic_field rod_temperature";

std::vector<ElementRule> rod_elements() {
  constexpr auto kRod = "cprsim:rod cprsim:rod_class", kSolid = "cprsim:rod cprsim:rod_class layer";
  return {
      {"model", "cprsim:rod_class", "", T::kGroup, "", '*', S::kSupported,
       "Properties that rods take over with class=\"...\"."},
      {"model", "cprsim:rod", "", T::kGroup, "", '*', S::kSupported, "A slender elastic rod."},
      {"cprsim:rod", "base", "", T::kGroup, "", '1', S::kSupported,
       "How s = 0 is held; z points into the rod."},
      {"cprsim:rod", "tip", "", T::kGroup, "", '?', S::kSupported,
       "How s = length is held; z points out of the rod. Absent: free."},
      {"base tip", "axis", "rod_axis", T::kGroup, "", '?', S::kSupported,
       "Axis of a revolute end."},
      {"rod_axis", "xyz", "", T::kVec3, "", '1', S::kSupported,
       "Its direction in the end's frame."},
      {"cprsim:rod", "length", "", T::kPositive, "m", '1', S::kSupported, "Length without load."},
      {kRod, "layer", "", T::kGroup, "", '*', S::kSupported,
       "A ring of another material around the rod and the layers before, bonded to them."},
      {kSolid, "cross_section", "", T::kGroup, "", '*', S::kSupported,
       "One shape, or several along the rod, each with its s."},
      {"cross_section", "circle", "", T::kGroup, "", '?', S::kSupported, "A full circle."},
      {"circle", "radius", "", T::kPositive, "m", '1', S::kSupported, "Radius."},
      {"cross_section", "annulus", "", T::kGroup, "", '?', S::kSupported, "A tube."},
      {"annulus", "outer_radius", "", T::kPositive, "m", '1', S::kSupported, "Outer radius."},
      {"annulus", "inner_radius", "", T::kPositive, "m", '1', S::kSupported, "Inner radius."},
      {"cross_section", "rectangle", "", T::kGroup, "", '?', S::kSupported, "A strip."},
      {"rectangle", "width", "", T::kPositive, "m", '1', S::kSupported,
       "Along the section's x axis."},
      {"rectangle", "height", "", T::kPositive, "m", '1', S::kSupported,
       "Along the section's y axis."},
      {"cross_section", "ellipse", "", T::kGroup, "", '?', S::kSupported, "An ellipse."},
      {"ellipse", "semi_axes", "", T::kVec2, "m", '1', S::kSupported, "Along x and y."},
      {kSolid, "material", "rod_material", T::kGroup, "", '?', S::kSupported,
       "Isotropic material."},
      {"rod_material", "density", "", T::kPositive, "kg/m3", '?', S::kSupported, "Density."},
      {"rod_material", "youngs_modulus", "", T::kPositive, "Pa", '?', S::kSupported,
       "Young's modulus."},
      {"rod_material", "shear_modulus", "", T::kPositive, "Pa", '?', S::kSupported,
       "Shear modulus, or"},
      {"rod_material", "poisson_ratio", "", T::kNumber, "1", '?', S::kSupported,
       "Poisson's ratio."},
      {"rod_material", "thermal_expansion", "", T::kNumber, "1/K", '?', S::kSupported,
       "Relative growth of a length per kelvin; for the effect thermal."},
      {kRod, "stiffness", "rod_stiffness", T::kGroup, "", '?', S::kSupported,
       "Measured stiffness, instead of that of section and material."},
      {"rod_stiffness", "bending_x", "", T::kPositive, "N m2", '?', S::kSupported, "About x."},
      {"rod_stiffness", "bending_y", "", T::kPositive, "N m2", '?', S::kSupported, "About y."},
      {"rod_stiffness", "torsion", "", T::kPositive, "N m2", '?', S::kSupported,
       "About the tangent."},
      {"rod_stiffness", "axial", "", T::kPositive, "N", '?', S::kSupported, "Along the tangent."},
      {"rod_stiffness", "shear_x", "", T::kPositive, "N", '?', S::kSupported, "Along x."},
      {"rod_stiffness", "shear_y", "", T::kPositive, "N", '?', S::kSupported, "Along y."},
      {kRod, "damping", "rod_damping", T::kGroup, "", '?', S::kSupported, "Kelvin-Voigt damping."},
      {"rod_damping", "bending", "", T::kNonNegative, "N m2 s", '?', S::kSupported, "Of bending."},
      {"rod_damping", "torsion", "", T::kNonNegative, "N m2 s", '?', S::kSupported, "Of torsion."},
      {"rod_damping", "axial", "", T::kNonNegative, "N s", '?', S::kSupported, "Of extension."},
      {"rod_damping", "shear", "", T::kNonNegative, "N s", '?', S::kSupported, "Of shear."},
      {kRod, "drag", "rod_drag", T::kGroup, "", '?', S::kSupported,
       "Of the fluid around it: drag grows with the square of the speed."},
      {"rod_drag", "normal", "", T::kNonNegative, "kg/m2", '?', S::kSupported,
       "Force per length over squared speed across the rod: half of drag coefficient times fluid "
       "density times diameter."},
      {"rod_drag", "tangential", "", T::kNonNegative, "kg/m2", '?', S::kSupported,
       "The same along the rod: half of friction coefficient times density times circumference."},
      {"rod_drag", "fluid_density", "", T::kPositive, "kg/m3", '?', S::kSupported,
       "Gives the rod buoyancy; without it there is none."},
      {"rod_drag", "added_mass", "", T::kNonNegative, "1", '?', S::kSupported,
       "Mass of fluid that moves along with the rod across its axis, over the fluid displaced: 1 "
       "for a circle. Needs fluid_density."},
      {kRod, "rest", "rod_rest", T::kGroup, "", '?', S::kSupported,
       "Shape without load; straight if absent."},
      {"rod_rest", "curvature", "", T::kVec3, "1/m", '?', S::kSupported,
       "Bending about x, about y, twist: the same all along the rod, section axes."},
      {"rod_rest", "helix", "rest_helix", T::kGroup, "", '?', S::kSupported,
       "Curvature about y and twist of a helix; it bends towards x."},
      {"rest_helix", "radius", "", T::kPositive, "m", '1', S::kSupported, "Of the helix."},
      {"rest_helix", "pitch", "", T::kNumber, "m", '1', S::kSupported,
       "Per turn; negative: left-handed."},
      {"rod_rest", "file", "", T::kText, "", '?', S::kSupported,
       "Table beside the scene, lines s,kx,ky,kz: s from 0 to 1, curvature as above; a natural "
       "cubic spline between."},
      {kRod, "magnetization", "", T::kVec3, "A m", '*', S::kSupported,
       "Magnetic moment per length, section axes; several add up. For the effect magnetic."},
      {kRod, "temperature", "rod_temperature", T::kGroup, "", '?', S::kSupported,
       "How much warmer it is than when it was without stress, times a function of time. For the "
       "effect thermal."},
      {"rod_temperature", "rise", "", T::kNumber, "K", '?', S::kSupported, "Of the centreline."},
      {"rod_temperature", "gradient", "", T::kVec2, "K/m", '?', S::kSupported,
       "Along the section's x and y axes: the rod bends away from its warm side."},
      {kRod, "disks", "rod_disks", T::kGroup, "", '*', S::kSupported,
       "Rigid disks across the rod: spacers, weights. Give count or s (docs/scene-format.md)."},
      {"rod_disks", "radius", "", T::kPositive, "m", '?', S::kSupported,
       "Of each; a point mass if absent. Drawn, and felt with the effect rotary_inertia."},
      {"rod_disks", "mass", "", T::kNonNegative, "kg", '1', S::kSupported, "Of each."},
      {kRod, "gravity", "", T::kBool, "", '?', S::kSupported, "Whether gravity acts on it."},
      {kRod, "visual", "rod_visual", T::kGroup, "", '?', S::kSupported, "Its look."},
      {kRod, "without", "", T::kText, "", '*', S::kSupported,
       "Effects that this rod does not have."},
      {"model", "cprsim:tie", "", T::kGroup, "", '*', S::kSupported,
       "Ties two rods together at points: bundles, sleeves."},
      {"cprsim:tie", "s", "", T::kNumbers, "1", '1', S::kSupported,
       "Where along the first rod: fractions of its length, above 0, ascending."},
      {"cprsim:tie", "other_s", "", T::kNumbers, "1", '?', S::kSupported,
       "Where along the other; the same s if absent."},
      {"cprsim:tie", "offset", "", T::kVec3, "m", '?', S::kSupported,
       "Of the other's centreline from the first's, section axes of the first; as the unloaded "
       "rods lie if absent."},
      {"model", "cprsim:tendon", "", T::kGroup, "", '*', S::kSupported,
       "A cable along a rod that a motor at the base pulls: docs/tendons.md."},
      {"cprsim:tendon", "parallel", "", T::kEmpty, "", '?', S::kSupported,
       "Runs beside the centreline."},
      {"cprsim:tendon", "helical", "", T::kEmpty, "", '?', S::kSupported,
       "Winds around the centreline."},
      {"cprsim:tendon", "points", "tendon_points", T::kText, "", '?', S::kSupported,
       "s x y, s x y, ...: fraction of the length and place in the section (m), straight in "
       "between."},
      {"cprsim:tendon", "termination", "", T::kEmpty, "", '?', S::kSupported,
       "Where it is fastened; the rod's tip if absent."},
      {"cprsim:tendon", "friction", "tendon_mu", T::kEmpty, "", '?', S::kSupported,
       "Against its channel, with the effect tendon_friction."},
  };
}

std::vector<ElementRule> run_elements() {
  constexpr auto kEffects = "cprsim:effects";
  return {
      {"world", "cprsim:simulation", "", T::kGroup, "", '?', S::kSupported,
       "What is to be found out."},
      {"cprsim:simulation", "duration", "", T::kPositive, "s", '?', S::kSupported,
       "Simulated time."},
      {"cprsim:simulation", "planar", "", T::kEmpty, "", '?', S::kSupported,
       "Everything moves in the plane across its normal: the same motion as without, several times "
       "faster."},
      {"cprsim:simulation", "initial", "", T::kGroup, "", '?', S::kSupported,
       "How the run begins."},
      {"initial", "velocity", "initial_velocity", T::kGroup, "", '*', S::kSupported,
       "Of a body at t = 0, world axes."},
      {"initial_velocity", "linear", "", T::kVec3, "m/s", '?', S::kSupported,
       "Of the link's origin."},
      {"initial_velocity", "angular", "", T::kVec3, "rad/s", '?', S::kSupported, "Of the link."},
      {"cprsim:simulation", "seed", "", T::kInteger, "", '?', S::kSupported, "For random numbers."},
      {"world", "cprsim:effects", "", T::kGroup, "", '?', S::kSupported,
       "Effects beyond bending and torsion, which are always on."},
      {kEffects, "gravity", "effect", T::kEmpty, "", '?', S::kSupported, "Weight."},
      {kEffects, "extension", "effect", T::kEmpty, "", '?', S::kSupported, "Rods stretch."},
      {kEffects, "shear", "effect", T::kEmpty, "", '?', S::kSupported, "Rods shear."},
      {kEffects, "rotary_inertia", "effect", T::kEmpty, "", '?', S::kSupported,
       "Of cross-sections."},
      {kEffects, "damping", "effect", T::kEmpty, "", '?', S::kSupported,
       "Kelvin-Voigt damping of rods."},
      {kEffects, "contact", "effect", T::kEmpty, "", '?', S::kSupported,
       "Between rigid bodies, of rods with what stands still or is held, and of rods."},
      {kEffects, "friction", "effect", T::kEmpty, "", '?', S::kSupported, "In contacts."},
      {kEffects, "drag", "effect", T::kEmpty, "", '?', S::kSupported,
       "Of rods in a fluid, buoyancy and added mass."},
      {kEffects, "self_contact", "effect", T::kEmpty, "", '?', S::kSupported,
       "Of a rod with itself."},
      {kEffects, "magnetic", "effect", T::kEmpty, "", '?', S::kSupported,
       "Torque and force of <cprsim:magnetic_field> on rods that have a <magnetization>."},
      {kEffects, "thermal", "effect", T::kEmpty, "", '?', S::kSupported,
       "Rods that have a <temperature> grow longer and bend."},
      {kEffects, "tendon_friction", "effect", T::kEmpty, "", '?', S::kSupported,
       "Of tendons against their channels: docs/tendons.md."},
      {"physics", "cprsim:solver", "", T::kGroup, "", '?', S::kSupported,
       "How the rods are solved."},
      {"cprsim:solver", "accuracy", "", T::kPositive, "m", '?', S::kSupported,
       "Error asked for: of links and rods, or of a channel in its own unit."},
      {"cprsim:solver", "space", "", T::kEmpty, "", '?', S::kSupported, "Along the rods."},
      {"cprsim:solver", "time", "", T::kEmpty, "", '?', S::kSupported, "In time."},
      {"cprsim:solver", "nonlinear", "", T::kEmpty, "", '?', S::kSupported, "Nonlinear equations."},
      {"cprsim:solver", "on_failure", "", T::kEmpty, "", '?', S::kSupported, "When a step fails."},
  };
}

std::vector<ElementRule> action_elements() {
  return {
      {"world", "cprsim:profile", "", T::kGroup, "", '*', S::kSupported,
       "A function of time: sum of shapes."},
      {kTimed, "constant", "", T::kEmpty, "", '*', S::kSupported, "One value."},
      {kTimed, "step", "", T::kEmpty, "", '*', S::kSupported, "A jump."},
      {kTimed, "ramp", "", T::kEmpty, "", '*', S::kSupported, "Linear from start to end."},
      {kTimed, "smoothstep", "", T::kEmpty, "", '*', S::kSupported, "Quintic from start to end."},
      {kTimed, "sine", "", T::kEmpty, "", '*', S::kSupported,
       "amplitude sin(2 pi frequency (t - start) + phase)."},
      {kTimed, "keyframes", "", T::kKeyframes, "", '*', S::kSupported,
       "time value, time value, ..."},
      {kTimed, "chirp", "", T::kEmpty, "", '*', S::kSupported,
       "A sine whose frequency grows linearly from f0 to f1."},
      {kTimed, "trapezoid", "", T::kEmpty, "", '*', S::kSupported,
       "From start to end, with constant acceleration, speed, deceleration."},
      {kTimed, "csv", "csv_profile", T::kEmpty, "", '*', S::kSupported,
       "Columns of a file: the cubic spline through its samples."},
      {kTimed, "expression", "", T::kText, "", '*', S::kSupported,
       "A smooth formula of t, as in 0.1 * sin(2 * pi * t)^2."},
      {"world model", "cprsim:joint", "", T::kGroup, "", '*', S::kSupported,
       "A joint that SDFormat does not have: cylindrical, planar."},
      {"cprsim:joint", "axis3", "", T::kGroup, "", '?', S::kSupported,
       "Limit and dynamics of a planar joint's turn."},
      {"world model", "cprsim:drive", "", T::kGroup, "", '*', S::kSupported,
       "Prescribes a joint, a rod's length or a tendon."},
      {"world model", "cprsim:load", "", T::kGroup, "", '*', S::kSupported, "Forces and torques."},
      {"cprsim:load", "force", "", T::kVec3, "N", '?', S::kSupported, "Force."},
      {"cprsim:load", "torque", "", T::kVec3, "N m", '?', S::kSupported, "Torque."},
      {"world", "cprsim:magnetic_field", "", T::kGroup, "", '*', S::kSupported,
       "Around rods, world axes, times a function of time; several add up."},
      {"cprsim:magnetic_field", "uniform", "", T::kVec3, "T", '?', S::kSupported,
       "The same everywhere, or"},
      {"cprsim:magnetic_field", "dipole", "", T::kGroup, "", '?', S::kSupported,
       "of a small magnet or coil."},
      {"dipole", "position", "", T::kVec3, "m", '1', S::kSupported, "Where it is."},
      {"dipole", "moment", "", T::kVec3, "A m2", '1', S::kSupported, "Its magnetic moment."},
      {"world model", "cprsim:target", "", T::kGroup, "", '*', S::kSupported,
       "A pose to which `cprsim solve` brings a frame; runs do not look at it."},
  };
}

std::vector<ElementRule> output_elements() {
  return {
      {"world", "cprsim:camera", "", T::kGroup, "", '*', S::kSupported, "A view."},
      {"cprsim:camera", "eye", "", T::kVec3, "m", '1', S::kSupported, "Where it stands."},
      {"cprsim:camera", "look_at", "", T::kVec3, "m", '1', S::kSupported, "What it looks at."},
      {"cprsim:camera", "up", "", T::kVec3, "", '?', S::kSupported, "What is up in the picture."},
      {"cprsim:camera gui_camera", "horizontal_fov", "", T::kPositive, "rad", '?', S::kSupported,
       "Opening angle."},
      {"cprsim:camera", "image", "camera_image", T::kGroup, "", '?', S::kSupported,
       "Size of the picture."},
      {"camera_image", "width", "", T::kCount, "px", '1', S::kSupported, "Width."},
      {"camera_image", "height", "", T::kCount, "px", '1', S::kSupported, "Height."},
      {"cprsim:camera", "orbit", "", T::kEmpty, "", '?', S::kSupported,
       "Circles around what it looks at."},
      {"world", "cprsim:video", "", T::kGroup, "", '*', S::kSupported, "A film."},
      {"cprsim:video", "trace", "", T::kEmpty, "", '*', S::kSupported,
       "Draws the path of a point."},
      {"cprsim:video", "color_by", "", T::kEmpty, "", '?', S::kSupported, "Colours the rods."},
      {"cprsim:video", "contact_forces", "", T::kEmpty, "", '?', S::kSupported,
       "Draws the forces of contacts as arrows, from where they act."},
      {"cprsim:video", "overlay", "", T::kText, "", '?', S::kSupported, "A caption."},
      {"world", "cprsim:record", "", T::kGroup, "", '*', S::kSupported,
       "Writes channels to files."},
      {"cprsim:record", "channel", "", T::kText, "", '+', S::kSupported,
       "Channels, with * for any; contact(a,b).X is of two that touch."},
      {"cprsim:record", "csv", "", T::kEmpty, "", '?', S::kSupported, "Comma-separated values."},
      {"cprsim:record", "vtk", "", T::kEmpty, "", '?', S::kSupported, "Files for ParaView."},
      {"cprsim:record", "hdf5", "", T::kEmpty, "", '?', S::kSupported,
       "Channels and whole rods as arrays, for MATLAB, Python, Julia."},
      {"cprsim:record", "npz", "", T::kEmpty, "", '?', S::kSupported,
       "The same arrays for NumPy alone."},
      {"cprsim:record", "gltf", "", T::kEmpty, "", '?', S::kSupported,
       "The robot as an animated model (GLB), for Blender and browsers."},
      {"world", "cprsim:expect", "", T::kGroup, "", '*', S::kSupported, "What must come true."},
      {"cprsim:expect", "value", "", T::kEmpty, "", '*', S::kSupported,
       "A channel at one instant."},
      {"cprsim:expect", "bound", "", T::kEmpty, "", '*', S::kSupported,
       "A channel over an interval."},
      {"cprsim:expect", "drift", "", T::kEmpty, "", '*', S::kSupported,
       "Largest change since t = 0."},
      {"cprsim:expect", "converged", "", T::kEmpty, "", '?', S::kSupported,
       "Every step converged."},
      {"cprsim:expect", "fails", "", T::kEmpty, "", '?', S::kSupported,
       "The scene must be rejected."},
      {"cprsim:expect", "match", "", T::kEmpty, "", '*', S::kSupported,
       "Agreement with a trajectory in a file."},
      {"cprsim:expect", "event", "", T::kEmpty, "", '*', S::kSupported, "Something happens."},
      {"world", "cprsim:sweep", "", T::kGroup, "", '*', S::kSupported, "A study over values."},
      {"cprsim:sweep", "vary", "", T::kText, "", '+', S::kSupported, "What is varied."},
      {"cprsim:sweep", "reference", "", T::kEmpty, "", '?', S::kSupported,
       "The value taken as exact."},
      {"cprsim:sweep", "measure", "", T::kEmpty, "", '+', S::kSupported, "What is compared."},
  };
}

}  // namespace

std::vector<ElementRule> cprsim_elements() {
  std::vector<ElementRule> all = rod_elements();
  for (const PlaceLaw& law : kPlaceLaws) {
    all.push_back({"cprsim:load", law.word, "", T::kGroup, "", '?', S::kSupported, law.doc});
    for (const LawValue& value : law.values)
      if (value.word)
        all.push_back({law.word, value.word, "",
                       value.kind == LawValue::kPositive ? T::kPositive : T::kVec3, value.unit, '1',
                       S::kSupported, value.doc});
  }
  for (const auto& part : {run_elements(), action_elements(), output_elements()})
    all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace cprsim
