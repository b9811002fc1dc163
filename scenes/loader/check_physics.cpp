// SPDX-License-Identifier: BSD-3-Clause
// What only the whole scene can tell: effects and their data, masses, lengths, limits,
// plausibility.
#include <algorithm>
#include <cmath>
#include <set>

#include "engine/model/flight.h"
#include "engine/model/start_pose.h"
#include "scenes/loader/reading.h"
#include "scenes/loader/values.h"
#include "scenes/loader/weigh.h"

namespace cprsim {

namespace {

const Node& node_of_body(const Reading& r, std::size_t body) {
  return *r.frames.vertices()[at(r.frames.link_of(static_cast<int>(body)))].node;
}

const Node& node_of_rod(const Reading& r, std::size_t rod) {
  return *r.frames.rods()[rod].node;
}

bool given_anywhere(const Node& node, std::string_view name) {
  return std::any_of(node.children.begin(), node.children.end(),
                     [&](const auto& child) { return child->name == name; });
}

void check_masses(Reading& r) {
  const std::vector<bool> fixed = fixed_bodies(r.scene);
  // those that join rods have no mass
  for (std::size_t b = 0; b < at(r.frames.body_count()); ++b) {
    if (fixed[b]) continue;
    const Node& link = node_of_body(r, b);
    const Node* inertial = link.child("inertial");
    if (!inertial) {
      if (!given_anywhere(link, "inertial"))
        r.report.missing("E501", link, "movable " + describe(link) + " has no <inertial>")
            .suggestion = "give mass and inertia, or make its model <static>";
      continue;
    }
    if (computes_inertia(*inertial)) continue;
    if (!given_anywhere(*inertial, "mass"))
      r.report.missing("E501", *inertial,
                       "<inertial> of movable " + describe(link) + " has no <mass>");
    const Node* inertia = inertial->child("inertia");
    if (!inertia && !given_anywhere(*inertial, "inertia"))
      r.report.missing("E501", *inertial,
                       "<inertial> of movable " + describe(link) + " has no <inertia>");
    if (!inertia) continue;
    for (const char* entry : {"ixx", "iyy", "izz"})
      if (!given_anywhere(*inertia, entry))
        r.report.missing("E501", *inertia,
                         "<inertia> of movable " + describe(link) + " has no <" + entry + ">");
  }
}

bool switched_off(const RodSpec& rod, Effect effect) {
  return std::find(rod.without.begin(), rod.without.end(), effect_name(effect)) !=
         rod.without.end();
}

void check_effect_data(Reading& r, const Node& world) {
  const Scene& scene = r.scene;
  if (!scene.rods.empty() && !given_anywhere(world, "cprsim:effects"))
    r.report.missing("E504", world, "a world with rods needs <cprsim:effects>, even if empty")
        .suggestion = "<cprsim:effects><gravity/></cprsim:effects>";
  const bool damping = scene.effects.has(Effect::kDamping), drag = scene.effects.has(Effect::kDrag);
  for (std::size_t k = 0; k < scene.rods.size(); ++k) {
    const RodSpec& rod = scene.rods[k];
    const Node& node = node_of_rod(r, k);
    if (damping && !rod.damping && !switched_off(rod, Effect::kDamping) &&
        !given_anywhere(node, "damping"))
      r.report.missing("E503", node, "damping is listed, rod '" + rod.name + "' has no <damping>");
    if (!damping && rod.damping)
      r.report.note("W511", node, "rod '" + rod.name + "' has <damping>, damping is not listed");
    if (drag && !rod.drag && !switched_off(rod, Effect::kDrag) && !given_anywhere(node, "drag"))
      r.report.missing("E503", node, "drag is listed, rod '" + rod.name + "' has no <drag>");
    if (!drag && rod.drag)
      r.report.note("W511", node, "rod '" + rod.name + "' has <drag>, drag is not listed");
    // a material that could not be read has its own error
    const bool massless = !rod.material && !r.report.failed();
    const bool heavy =
        scene.effects.has(Effect::kGravity) && rod.gravity && !switched_off(rod, Effect::kGravity);
    if (massless && (heavy || scene.simulation.mode == Mode::kDynamic))
      r.report.missing("E503", node, "rod '" + rod.name + "' has no density: give a <material>");
  }
  const auto& asked = scene.effects.asked_at;
  if (scene.effects.has(Effect::kFriction) && !scene.effects.has(Effect::kContact) &&
      !scene.effects.has(Effect::kSelfContact))
    r.report.at(Severity::kWarning, "W503", asked[static_cast<std::size_t>(Effect::kFriction)], 9,
                "friction is listed, contact is not: there is nothing to rub");
  if (damping && scene.rods.empty())
    r.report.at(Severity::kWarning, "W503", asked[static_cast<std::size_t>(Effect::kDamping)], 8,
                "damping is listed and there is no rod; joints have their own <dynamics>");
  if (drag && scene.rods.empty())
    r.report.at(Severity::kWarning, "W503", asked[static_cast<std::size_t>(Effect::kDrag)], 5,
                "drag is listed and there is no rod; links do not feel it");
  if (const Node* wind = world.child("wind"); wind && !drag && !scene.wind.isZero())
    r.report.note("W511", *wind, "<wind> is given, drag is not among the effects");
}

double thickness(const SectionSpec& section) {
  if (section.shape == SectionShape::kRectangle) return section.size.maxCoeff();
  return 2 * section.size.maxCoeff();
}

void check_plausibility(Reading& r) {
  for (std::size_t k = 0; k < r.scene.rods.size(); ++k) {
    const RodSpec& rod = r.scene.rods[k];
    const Node& node = node_of_rod(r, k);
    if (rod.material) {
      const double E = rod.material->youngs_modulus, rho = rod.material->density;
      if (E > 0 && (E < 1e3 || E > 2e12))
        r.report.warn("W501", node,
                      "rod '" + rod.name + "': a Young's modulus of " + format_number(E) +
                          " Pa is unusual; is it in Pa?");
      if (rho > 30000 || (rho > 0 && rho < 1))
        r.report.warn("W501", node,
                      "rod '" + rod.name + "': a density of " + format_number(rho) +
                          " kg/m3 is unusual; is it in kg/m3?");
    }
    const double d = thickness(rod.section);
    if (d > 0 && rod.length > 0 && rod.length < 5 * d)
      r.report.warn("W502", node,
                    "rod '" + rod.name + "' is only " + format_number(rod.length / d) +
                        " times as long as thick; rod theory needs slender rods");
  }
}

// a clamped or pinned rod between two places that never move must be able to reach
void check_reach(Reading& r) {
  const std::vector<bool> fixed = fixed_bodies(r.scene);
  const auto still = [&](const RodEndSpec& end) {
    return end.at.body == kWorld || fixed[at(end.at.body)];
  };
  const auto where = [&](const RodEndSpec& end) { return start_pose(r.scene, end.at).p; };
  for (std::size_t k = 0; k < r.scene.rods.size(); ++k) {
    const RodSpec& rod = r.scene.rods[k];
    const bool driven =
        std::any_of(r.scene.drives.begin(), r.scene.drives.end(),
                    [&](const DriveSpec& d) { return d.rod == static_cast<int>(k); });
    const bool both = rod.tip.joint != EndJoint::kFree && still(rod.base) && still(rod.tip);
    if (!both || driven || rod.length <= 0 || r.scene.effects.has(Effect::kExtension)) continue;
    const double distance = (where(rod.tip) - where(rod.base)).norm();
    if (distance > rod.length * (1 + 1e-9))
      r.report.missing("E510", node_of_rod(r, k),
                       "rod '" + rod.name + "', " + format_number(rod.length) +
                           " m long, cannot reach over " + format_number(distance) +
                           " m: both ends are fixed and extension is not listed");
  }
}

// some 10 kB a cell: 2 GB
constexpr std::size_t kMostCells = 200'000;

void check_size(Reading& r) {
  const auto points = static_cast<std::size_t>(r.scene.solver.points.value_or(1));
  const std::size_t rods = r.scene.rods.size();
  if (points * rods > kMostCells)
    r.report.error("E509", node_of_rod(r, 0),
                   std::to_string(rods) + " rods of " + std::to_string(points) +
                       " points are more than " + std::to_string(kMostCells) + " points");
}

struct Extremes {
  double least, most, t_least, t_most;

  /// A profile that ends at a limit may be beyond it by this much.
  double round_off() const { return 1e-12 * std::max(std::abs(least), std::abs(most)); }
};

/// Of the profile's value, or of its rate.
Extremes extremes_of(const Profile& profile, double end, bool of_rate) {
  constexpr int kSamples = 2000;
  std::vector<double> times = profile.breakpoints(end);
  times.push_back(0);
  for (int k = 1; k <= kSamples && end > 0; ++k)
    times.push_back(end * k / kSamples);
  Extremes e{HUGE_VAL, -HUGE_VAL, 0, 0};
  for (const double t : times)
    for (const bool before : {false, true}) {
      const ProfileValue here = profile.evaluate(t, before);
      const double value = of_rate ? here.rate : here.value;
      if (value < e.least) e.least = value, e.t_least = t;
      if (value > e.most) e.most = value, e.t_most = t;
    }
  return e;
}

// A formula may have no value at some instant.
void check_finite(Reading& r, const Profile& profile) {
  const double end = r.scene.simulation.duration;
  for (const ProfileTerm& term : profile.terms) {
    if (term.shape != ShapeOfTime::kExpression) continue;
    constexpr int kSamples = 2000;
    for (int k = 0; k <= kSamples; ++k) {
      const double t = end * k / kSamples;
      const Jet x = term.expression.evaluate(t);
      if (std::isfinite(x.value) && std::isfinite(x.rate) && std::isfinite(x.acceleration))
        continue;
      r.report.at(Severity::kError, "E306", profile.place, 1,
                  "the formula, its rate or its acceleration is not finite at t = " +
                      format_number(t) + " s");
      break;
    }
  }
}

std::string axis_name(const JointSpec& joint, int axis) {
  const std::string name = "joint '" + joint.name + "'";
  return freedom_count(joint.kind) > 1 ? "axis " + std::to_string(axis + 1) + " of " + name : name;
}

void check_driven_axis(Reading& r, const DriveSpec& drive) {
  const JointSpec& joint = r.scene.joints[at(drive.joint)];
  if (drive.freedom >= freedom_count(joint.kind)) return;
  const AxisSpec& axis = axis_of(joint, drive.freedom);
  const std::string name = axis_name(joint, drive.freedom);
  const double end = r.scene.simulation.duration;
  const auto check = [&](const Extremes& e, double lower, double upper, const char* what) {
    const bool low = e.least<lower - e.round_off(), high = e.most> upper + e.round_off();
    if (low || high)
      r.report.at(Severity::kError, "E508", drive.place, 13,
                  "the drive takes " + std::string(what) + name + " to " +
                      format_number(low ? e.least : e.most) +
                      " at t = " + format_number(low ? e.t_least : e.t_most) +
                      " s, beyond its limit " + format_number(low ? lower : upper));
  };
  const auto warn = [&](const std::string& message) {
    r.report.at(Severity::kWarning, "W505", joint.place, 6, message);
  };
  const double speed = axis.velocity_limit;
  switch (drive.quantity) {
    case DriveQuantity::kPosition:
      check(extremes_of(drive.profile, end, false), axis.lower, axis.upper, "");
      check(extremes_of(drive.profile, end, true), -speed, speed, "the speed of ");
      break;
    case DriveQuantity::kVelocity:
      check(extremes_of(drive.profile, end, false), -speed, speed, "the speed of ");
      if (axis.limited()) warn("the velocity drive of " + name + " pushes through its limits");
      break;
    default:
      return;
  }
  if (std::isfinite(axis.effort_limit))
    warn("the drive of " + name +
         " prescribes a motion and takes the effort it needs: nothing "
         "enforces the effort limit");
}

void check_drives(Reading& r) {
  const Scene& scene = r.scene;
  std::set<std::pair<int, int>> moved;
  for (const DriveSpec& drive : scene.drives) {
    if (drive.profile.terms.empty()) continue;
    check_finite(r, drive.profile);
    if (drive.rod >= 0) {
      const Extremes e = extremes_of(drive.profile, scene.simulation.duration, false);
      if (e.least <= 0)
        r.report.at(Severity::kError, "E508", drive.place, 13,
                    "the length of '" + scene.rods[at(drive.rod)].name + "' becomes " +
                        format_number(e.least) + " m at t = " + format_number(e.t_least) + " s");
    } else if (drive.quantity == DriveQuantity::kTension) {
      const Extremes e = extremes_of(drive.profile, scene.simulation.duration, false);
      if (e.least < -e.round_off())
        r.report.at(Severity::kError, "E508", drive.place, 13,
                    "a tendon only pulls: the tension of '" + scene.tendons[at(drive.tendon)].name +
                        "' becomes " + format_number(e.least) +
                        " N at t = " + format_number(e.t_least) + " s");
    } else if (drive.joint >= 0) {
      check_driven_axis(r, drive);
      if (drive.quantity != DriveQuantity::kEffort) moved.insert({drive.joint, drive.freedom});
    }
  }
  for (std::size_t j = 0; j < scene.joints.size(); ++j) {
    const JointSpec& joint = scene.joints[j];
    for (int i = 0; i < freedom_count(joint.kind); ++i) {
      const AxisSpec& axis = axis_of(joint, i);
      if (std::isfinite(axis.velocity_limit) && !moved.count({static_cast<int>(j), i}))
        r.report.at(
            Severity::kWarning, "W505", joint.place, 6,
            "nothing enforces the velocity limit of " + axis_name(joint, i) + " in this version");
      if (axis.friction > 0 && scene.simulation.mode == Mode::kStatic)
        r.report.at(Severity::kNote, "W592", joint.place, 6,
                    "no friction in " + axis_name(joint, i) +
                        ": in statics its sign and size are open; the equilibrium is that of "
                        "the joint without it");
    }
  }
}

// A resolution that no rod's method knows would be dropped silently; with auto the resolution given
// decides the method.
void check_space(Reading& r) {
  const SolverSpec& solver = r.scene.solver;
  std::set<Method> used;
  for (const RodSpec& rod : r.scene.rods)
    used.insert(rod.method.value_or(solver.method));
  if (used.empty() || used.count(Method::kAuto)) return;
  const auto belongs = [&](bool given, const char* key, std::set<Method> owners) {
    const bool read = std::any_of(owners.begin(), owners.end(),
                                  [&](Method method) { return used.count(method) > 0; });
    if (given && !read)
      r.report.at(Severity::kNote, "W508", solver.space_place, 5,
                  std::string(key) + " of <space> belongs to another method than the rods'");
  };
  belongs(solver.points.has_value(), "points", {Method::kShooting});
  belongs(solver.integrator.has_value(), "integrator", {Method::kShooting});
  belongs(solver.order.has_value(), "order", {Method::kStrain});
  belongs(solver.degree.has_value(), "degree", {Method::kCollocation});
  const bool splines = solver.basis == Basis::kBspline || solver.basis == Basis::kNurbs;
  belongs(solver.basis.has_value(), "basis", {splines ? Method::kCollocation : Method::kStrain});
  belongs(solver.elements.has_value(), "elements", {Method::kStrain, Method::kCollocation});
}

// Multistep formulas look back over many steps: nothing may come and go, stick and slip.
void check_ida(Reading& r) {
  const Scene& scene = r.scene;
  if (scene.solver.scheme != SchemeKind::kIda || scene.simulation.mode != Mode::kDynamic) return;
  std::string why;
  if (!scene.rods.empty() &&
      (scene.effects.has(Effect::kContact) || scene.effects.has(Effect::kSelfContact)))
    why = "contact";
  const std::vector<char> flying = flying_bodies(scene);
  if (std::find(flying.begin(), flying.end(), 1) != flying.end()) why = "bodies in free flight";
  for (const JointSpec& joint : scene.joints)
    for (int i = 0; i < freedom_count(joint.kind); ++i)
      if (axis_of(joint, i).friction > 0) why = "dry friction of joint '" + joint.name + "'";
  if (!scene.ties.empty()) why = "tied rods";
  if (why.empty()) return;
  r.report
      .at(Severity::kError, "E520", scene.solver.place, 14,
          "ida integrates smooth motion only: the scene has " + why)
      .suggestion =
      "available: backward_euler, bdf2, bdf_alpha, generalized_alpha, tr_bdf2, "
      "esdirk32, esdirk43";
}

}  // namespace

void check_physics(Reading& r) {
  const Node& world = *r.frames.scopes()[0].node;
  check_masses(r);
  check_effect_data(r, world);
  check_plausibility(r);
  check_size(r);
  check_reach(r);
  check_drives(r);
  check_space(r);
  check_ida(r);
}

}  // namespace cprsim
