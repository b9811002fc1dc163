// SPDX-License-Identifier: BSD-3-Clause
#include "engine/run/ledger.h"

#include <algorithm>
#include <cmath>

#include "engine/math/so3.h"

namespace cprsim {

namespace {

/// Speed that a drive of position or velocity prescribes.
double prescribed_rate(const JointDrive& drive, double t, bool before) {
  const ProfileValue value = drive.spec->profile.evaluate(t, before);
  return drive.spec->quantity == DriveQuantity::kVelocity ? value.value : value.rate;
}

}  // namespace

/// What such a drive exerts: lambda carries springs, dampers and the like too, which are not its.
double EnergyLedger::exerted(const JointDrive& drive, double rate) const {
  const Joint& joint = robot_.joints[static_cast<std::size_t>(drive.joint)];
  const Joint::Freedom& freedom = joint.freedoms[static_cast<std::size_t>(drive.freedom)];
  const auto i = static_cast<Eigen::Index>(drive.freedom);
  const double along =
      joint.observe(robot_.body_pose(joint.parent), robot_.body_pose(joint.child)).effort[i];
  return along - freedom.law.total(*freedom.spec, joint.q[i], rate).value;
}

/// Where a prescribed speed jumps, what carries masses over is an impulse: the excess of the effort
/// over what it was. While it acts the speed is the mean of both.
void EnergyLedger::note_jumps(double t) {
  jumps_.clear();
  if (robot_.scene->simulation.mode != Mode::kDynamic) return;
  for (const JointDrive& drive : robot_.joint_drives) {
    Jump jump;
    if (drive.spec->quantity != DriveQuantity::kEffort) {
      // a robot starts at rest
      const double from = t > 0 ? prescribed_rate(drive, t, true) : 0;
      const double to = prescribed_rate(drive, t, false);
      // not from one piece of a straight line to the next
      if (std::abs(to - from) > 1e-9 * (std::abs(to) + std::abs(from)))
        jump = {0.5 * (to - from), exerted(drive, from)};
    }
    jumps_.push_back(jump);
  }
}

bool EnergyLedger::speeds_jumped() const {
  return std::any_of(jumps_.begin(), jumps_.end(), [](const Jump& jump) { return jump.half != 0; });
}

// What motors of given displacements put in, by the tensions that turn out.
double EnergyLedger::pulling_power(const RobotRod& rod, double t, bool before) const {
  double power = 0;
  std::vector<TendonSample> now;
  for (std::size_t k = 0; k < rod.tendons.size(); ++k) {
    if (!displaces(rod.tendons[k])) continue;
    if (now.empty()) now = rod.model->tendons();
    power += now[k].tension * rod.tendons[k].drive->profile.evaluate(t, before).rate;
  }
  return power;
}

double EnergyLedger::drive_power(double t, bool before) const {
  double power = 0;
  for (const RobotRod& rod : robot_.rods) {
    power += pulling_power(rod, t, before);
    if (rod.length_drive)
      power += rod.model->energy().feed_power * rod.length_drive->evaluate(t, before).rate;
    if (rod.section.fluid.resists() || !rod.line_loads.empty())
      power += rod.model->energy().fluid_power;
  }
  for (std::size_t k = 0; k < robot_.joint_drives.size(); ++k) {
    const JointDrive& drive = robot_.joint_drives[k];
    if (drive.spec->quantity == DriveQuantity::kEffort) {
      power += joint_effort(drive, t, before) *
               robot_.joints[static_cast<std::size_t>(drive.joint)].track.v[drive.freedom];
      continue;
    }
    const double rate = prescribed_rate(drive, t, before), effort = exerted(drive, rate);
    power += effort * rate;
    if (!jumps_.empty()) power -= (effort - jumps_[k].effort) * jumps_[k].half;
  }
  return power;
}

namespace {

/// What the springs of contact hold, J.
double contact_energy(const RobotRod& rod) {
  TouchingRod* side = rod.model->touching();
  if (!side || !side->may_touch()) return 0;
  const std::vector<RodContact>& contacts = side->contacts();
  const std::vector<ContactRows>& rows = side->contact_state();
  double energy = 0;
  for (std::size_t i = 0; i < std::min(contacts.size(), rows.size()); ++i) {
    if (!contacts[i].found() || contacts[i].give == 0) continue;
    const double depth = std::max(0.0, rod.section.half_width - rows[i].at.d);
    energy += 0.5 * depth * depth / contacts[i].give;
  }
  return energy;
}

}  // namespace

void EnergyLedger::sum_up() {
  EnergySample& e = sample_;
  e.kinetic = e.elastic = e.gravity = e.magnetic = 0;
  for (const RigidBody& body : robot_.bodies) {
    e.kinetic += body.kinetic_energy();
    e.gravity -= body.gravity_mass * robot_.gravity.dot(body.p + body.R * body.gravity_arm);
  }
  for (const Joint& joint : robot_.joints)
    e.elastic += joint.stored_energy() + joint.friction_energy();
  for (const RobotRod& rod : robot_.rods) {
    const RodEnergy own = rod.model->energy();
    e.kinetic += own.kinetic;
    e.elastic += own.elastic + contact_energy(rod);
    e.gravity += own.gravity;
    e.magnetic += own.magnetic;
  }
  if (free_bodies_) {
    const double kinetic = free_bodies_->kinetic_energy(), gravity = free_bodies_->gravity_energy();
    e.kinetic += kinetic;
    e.gravity += gravity;
    // only contact and drag change the energy of bodies in flight: what is gone counts as
    // dissipated
    if (free_energy_known_) e.dissipated += free_energy_ - (kinetic + gravity);
    free_energy_ = kinetic + gravity;
    free_energy_known_ = true;
  }
  e.total = e.kinetic + e.elastic + e.gravity + e.magnetic;
  e.balance = e.total - start_ - e.work + e.dissipated;
}

double EnergyLedger::damping_power() const {
  double power = 0;
  for (const RobotRod& rod : robot_.rods)
    power += rod.model->energy().damping_power;
  for (const Joint& joint : robot_.joints)
    power += joint.loss();
  for (std::size_t k = 0;
       k < std::min(robot_.body_contacts.size(), robot_.body_contact_rows.size()); ++k)
    power += contact_loss(robot_.body_contacts[k].law, robot_.body_contact_rows[k]);
  return power;
}

void EnergyLedger::open() {
  sample_ = {};
  start_ = 0;
  sum_up();
  start_ = sample_.total;
  sample_.balance = 0;
}

void EnergyLedger::begin_step(double t) {
  note_jumps(t);
  collect(t, false);
  points_before_ = points_;
  begun_ = t;
  friction_before_.clear();
  q_before_.clear();
  for (const Joint& joint : robot_.joints) {
    friction_before_.push_back(joint.friction_effort());
    q_before_.push_back(joint.q);
  }
  friction_energy_before_ = friction_energy();
  tendons_before_ = tendons_now(t, false);
  note_course(t);
}

std::vector<EnergyLedger::OnCourse> EnergyLedger::course_now(double t, bool before) const {
  std::vector<OnCourse> now;
  const Scene& scene = *robot_.scene;
  for (const RobotRod& rod : robot_.rods) {
    if (!rod.magnetic && !rod.heated) continue;
    OnCourse& at = now.emplace_back();
    if (rod.heated) {
      const ThermalEffort effort = rod.model->thermal_effort();
      at.strain = thermal_strain_at(*rod.spec, t, before).coordinates();
      // what the last solve has seen may be of another instant
      const Vec4 since = at.strain - rod.forcing.heat.coordinates();
      at.effort = effort.first + effort.second.cwiseProduct(since);
    }
    for (const MagneticFieldSpec& field : scene.magnetic_fields) {
      if (!rod.magnetic) break;
      MagneticFieldSpec whole = field;
      whole.has_profile = false;
      at.strengths.push_back(field.has_profile ? field.profile.evaluate(t, before).value : 1);
      at.energies.push_back(rod.model->magnetic_energy(sources_at(whole, t, before)));
    }
  }
  return now;
}

/// Where a field or a temperature jumps, the energy that rods have in it jumps at rest.
void EnergyLedger::note_course(double t) {
  course_before_ = course_now(t, false);
  jump_work_ = 0;
  const std::vector<OnCourse> last = course_now(t, true);
  for (std::size_t i = 0; i < last.size(); ++i) {
    const OnCourse& now = course_before_[i];
    jump_work_ += 0.5 * (last[i].effort + now.effort).dot(now.strain - last[i].strain);
    for (std::size_t k = 0; k < now.strengths.size(); ++k)
      jump_work_ += now.energies[k] * (now.strengths[k] - last[i].strengths[k]);
  }
}

double EnergyLedger::course_work(double t) const {
  const std::vector<OnCourse> now = course_now(t, true);
  double work = jump_work_;
  for (std::size_t i = 0; i < now.size(); ++i) {
    const OnCourse &a = course_before_[i], &b = now[i];
    work += 0.5 * (a.effort + b.effort).dot(b.strain - a.strain);
    for (std::size_t k = 0; k < b.strengths.size(); ++k)
      work += 0.5 * (a.energies[k] + b.energies[k]) * (b.strengths[k] - a.strengths[k]);
  }
  return work;
}

// A tension is what its drive says from t on, not what the last solve has seen.
std::vector<std::vector<TendonSample>> EnergyLedger::tendons_now(double t, bool before) const {
  std::vector<std::vector<TendonSample>> now;
  for (const RobotRod& rod : robot_.rods) {
    if (rod.tendons.empty()) continue;
    now.push_back(rod.model->tendons());
    for (std::size_t k = 0; k < rod.tendons.size(); ++k)
      if (const TendonPull pull = pull_at(rod.tendons[k], t, before); !pull.displaces)
        now.back()[k].tension = pull.value;
  }
  return now;
}

namespace {

/// A function of time over a step of length 1: its values and its slopes where it begins and ends.
struct Course {
  double from, to, slope_from, slope_to;

  double value(double x) const {
    const double y = 1 - x;
    return y * y * ((1 + 2 * x) * from + x * slope_from) +
           x * x * ((1 + 2 * y) * to - y * slope_to);
  }

  double slope(double x) const {
    return 6 * x * (1 - x) * (to - from) + (1 - x) * (1 - 3 * x) * slope_from +
           x * (3 * x - 2) * slope_to;
  }
};

/// Of a tension over a displacement, both cubic in time.
double work_of(const Course& tension, const Course& displacement) {
  constexpr double kAside = 0.3872983346207417;  // sqrt(3 / 20): Gauss, exact to the fifth degree
  double work = 8. / 18 * tension.value(0.5) * displacement.slope(0.5);
  for (const double x : {0.5 - kAside, 0.5 + kAside})
    work += 5. / 18 * tension.value(x) * displacement.slope(x);
  return work;
}

}  // namespace

// Trapezoidal in the displacement where nothing has a rate; otherwise by the rates at both ends, of
// higher order than the schemes, or, where a tension is found, by the schemes' own quadrature of
// its power.
EnergyLedger::TendonWork EnergyLedger::tendon_work(double t) const {
  const std::vector<std::vector<TendonSample>> now = tendons_now(t, true);
  const bool moves = robot_.scene->simulation.mode == Mode::kDynamic;
  TendonWork work;
  std::size_t i = 0;
  for (const RobotRod& rod : robot_.rods) {
    if (rod.tendons.empty()) continue;
    for (std::size_t k = 0; k < rod.tendons.size(); ++k) {
      const TendonSample &a = tendons_before_[i][k], &b = now[i][k];
      const double mean = 0.5 * (a.tension + b.tension);
      double motor = mean * (b.displacement - a.displacement);
      const DriveSpec* drive = rod.tendons[k].drive;
      if (moves && drive && drive->quantity == DriveQuantity::kTension) {
        const double h = t - begun_;
        motor = work_of({a.tension, b.tension, h * drive->profile.evaluate(begun_).rate,
                         h * drive->profile.evaluate(t, true).rate},
                        {a.displacement, b.displacement, h * a.rate, h * b.rate});
      }
      if (displaces(rod.tendons[k])) {
        // beside its power, what it puts in where it jumps
        const Profile& profile = drive->profile;
        work.motors +=
            mean * (profile.evaluate(begun_, false).value - profile.evaluate(begun_, true).value);
      } else {
        work.motors += motor;
      }
      if (b.along.empty()) continue;
      // what of it reaches the rod, section by section
      work.friction += motor;
      for (std::size_t j = 0; j < b.along.size(); ++j)
        work.friction -= 0.5 * (a.tension * a.along[j].x() + b.tension * b.along[j].x()) *
                         (b.along[j].y() - a.along[j].y());
    }
    ++i;
  }
  return work;
}

double EnergyLedger::joint_effort(const JointDrive& drive, double t, bool before) const {
  const double limit = robot_.joints[static_cast<std::size_t>(drive.joint)]
                           .freedoms[static_cast<std::size_t>(drive.freedom)]
                           .spec->effort_limit;
  return std::clamp(drive.spec->profile.evaluate(t, before).value, -limit, limit);
}

double EnergyLedger::effort_work(double t) const {
  double work = 0;
  for (const JointDrive& drive : robot_.joint_drives) {
    if (drive.spec->quantity != DriveQuantity::kEffort) continue;
    const auto j = static_cast<std::size_t>(drive.joint);
    work += 0.5 * (joint_effort(drive, begun_, false) + joint_effort(drive, t, true)) *
            (robot_.joints[j].q[drive.freedom] - q_before_[j][drive.freedom]);
  }
  return work;
}

double EnergyLedger::friction_energy() const {
  double energy = 0;
  for (const Joint& joint : robot_.joints)
    energy += joint.friction_energy();
  return energy;
}

void EnergyLedger::close_step(double t, double damping_loss, double drive_work, bool cushioned) {
  const double before = sample_.balance;
  collect(t, true);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Point &a = points_before_[i], &b = points_[i];
    sample_.work += 0.5 * (a.force + b.force).dot(b.position - a.position);
    if (!a.moment.isZero() || !b.moment.isZero())
      sample_.work += 0.5 * (a.moment + b.moment).dot(log_so3(b.rotation * a.rotation.transpose()));
  }
  const TendonWork tendons = tendon_work(t);
  sample_.work += drive_work + tendons.motors + course_work(t);
  sample_.dissipated += damping_loss + tendons.friction;
  // what friction takes, less what its elastic range still holds
  for (std::size_t j = 0; j < robot_.joints.size(); ++j) {
    const Joint& joint = robot_.joints[j];
    sample_.dissipated -=
        0.5 * (friction_before_[j] + joint.friction_effort()).dot(joint.q - q_before_[j]);
  }
  sample_.dissipated -= friction_energy() - friction_energy_before_;
  sum_up();
  if (!cushioned || sample_.balance >= before) return;
  sample_.dissipated += before - sample_.balance;
  sample_.balance = before;
}

void EnergyLedger::visit(Archive& archive) {
  cprsim::visit(sample_, archive);
  archive(start_);
}

}  // namespace cprsim
