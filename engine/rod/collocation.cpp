// SPDX-License-Identifier: BSD-3-Clause
// Setting up, coefficients of a solve, and the residual.
#include "engine/rod/collocation.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "engine/math/so3.h"
#include "engine/rod/arc_grid.h"
#include "engine/rod/shooting.h"

namespace cprsim {
namespace {

/// Where a rod is observed and its field given, at least so many and a knot: enough for drawings
/// and modes, whose cost grows with the third power of the number.
constexpr int kLeastNodes = 8;

/// The rows of a point, in place.
using PointRows = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 13, 1>;

}  // namespace

CollocationRod::CollocationRod(std::string name, const EndCondition& base, const EndCondition& tip,
                               const std::optional<Mat3>& plane, const Pose& X_WBase,
                               const SectionProperties& section, double length,
                               const CollocationOptions& options)
    : name_(std::move(name)), base_(base), tip_(tip), section_(section), options_(options) {
  assert(options.degree >= kLeastDegree && options.degree <= kMaxDegree);
  extensible_ = options.extension || options.shear;
  choose_space(plane, X_WBase.R);
  place_sites(arc_grid(options.elements, options.stations, options.along.get()));
  if (options_.along) list_sections();
  if (options.drag || options.line_loads) fluid_ = Immersion(points_.size());
  if (options.line_loads) place_lines();
  const auto n = static_cast<Eigen::Index>(points_.size());
  const Eigen::Index strains = options.damping ? n * (extensible_ ? 2 : 1) : 0;
  track_.resize(position_coordinates() + 3 * strains);
  if (options_.rotary_inertia) rotation_track_.resize(3 * n);
  reference_rotations_.assign(points_.size(), Mat3::Identity());
  forcing_.length = length;
  if (!options_.tendons.empty()) place_tendons();
  if (options_.touches || options_.tied) touch_.reset(new NodalContacts(*this));
  if (!options_.disks.empty()) place_disks();
  set_unloaded(X_WBase);
}

// In a plane: growth of |q|, then MotionSpace's state; the rows that answer for them, of which the
// curvature law's is about the section's axis along the normal.
void CollocationRod::choose_space(const std::optional<Mat3>& plane, const Mat3& R_WBase) {
  space_ = plane ? MotionSpace::in_plane(*plane) : MotionSpace::all();
  const Eigen::Index d = space_.freedoms();
  for (VecX* gap : {&tip_gap_, &base_gap_, &tip_gap_start_, &base_gap_start_})
    gap->setZero(d);
  increments_ = MatX::Zero(13, 2 * d + 1);
  increments_(kQ, 0) = 1;
  increments_.bottomRightCorner(12, 2 * d) = space_.state;
  rows_ = increments_.transpose();
  if (!plane) return;
  const Vec3 normal = R_WBase.transpose() * plane->col(2);
  normal.cwiseAbs().maxCoeff(&planar_axis_);
  rows_.block<1, 3>(1, kQ + 1) = normal.transpose();
}

// Pieces from load to load, their points, and where they are observed.
void CollocationRod::place_sites(const std::vector<double>& grid) {
  elements_ = static_cast<int>(grid.size()) - 1;
  const std::vector<std::size_t> load_nodes = nodes_at(grid, options_.stations);
  std::vector<std::size_t> ends{0, grid.size() - 1};
  ends.insert(ends.end(), load_nodes.begin(), load_nodes.end());
  if (options_.along)
    for (std::size_t node : nodes_at(grid, options_.along->breaks()))
      ends.push_back(node);
  for (std::size_t node = 0; options_.touches && node < grid.size(); ++node)
    ends.push_back(node);
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  for (std::size_t node : load_nodes)
    station_of_.push_back(
        static_cast<std::size_t>(std::find(ends.begin(), ends.end(), node) - ends.begin()));
  int controls = 0;
  const int parts = options_.touches ? 1 : (kLeastNodes + elements_ - 1) / elements_;
  for (std::size_t g = 0; g + 1 < ends.size(); ++g) {
    const std::vector<double> breaks(grid.begin() + static_cast<std::ptrdiff_t>(ends[g]),
                                     grid.begin() + static_cast<std::ptrdiff_t>(ends[g + 1]) + 1);
    pieces_.push_back(
        {BsplineSpace(options_.degree, breaks), controls, static_cast<int>(sites_.size()), 0});
    if (!options_.weights.empty()) weigh(pieces_[g].space);
    const BsplineSpace derivatives = pieces_[g].space.derivatives();
    const VecX weights = derivatives.greville_weights();
    for (double s : derivatives.greville())
      sites_.push_back(site(g, s));
    weights_.insert(weights_.end(), weights.begin(), weights.end());
    pieces_[g].points = static_cast<int>(weights.size());
    controls += pieces_[g].space.size();
    // a node at a load belongs to what lies beyond it
    for (std::size_t e = 0; e + 1 < breaks.size(); ++e)
      for (int k = 0; k < parts; ++k)
        nodes_.push_back(site(g, breaks[e] + (breaks[e + 1] - breaks[e]) * k / parts));
  }
  nodes_.push_back(site(pieces_.size() - 1, 1));
  if (options_.touches || options_.tied)
    for (std::size_t node : ends)
      touch_grid_.push_back(grid[node]);
  control_.assign(static_cast<std::size_t>(controls), Vec13::Zero());
  points_.assign(sites_.size(), CollocationPoint{});
  find_band();
}

CollocationRod::Site CollocationRod::site(std::size_t piece, double s) const {
  Site at{s, pieces_[piece].space.basis(s)};
  at.basis.first += pieces_[piece].first_control;
  return at;
}

Vec13 CollocationRod::value(const Site& at) const {
  Vec13 y = Vec13::Zero();
  for (int j = 0; j <= options_.degree; ++j)
    y += at.basis.value[j] * control_[static_cast<std::size_t>(at.basis.first + j)];
  return y;
}

/// By arc length.
Vec13 CollocationRod::derivative(const Site& at) const {
  Vec13 y_s = Vec13::Zero();
  for (int j = 0; j <= options_.degree; ++j)
    y_s += at.basis.slope[j] * control_[static_cast<std::size_t>(at.basis.first + j)];
  return y_s / forcing_.length;
}

NodeState CollocationRod::state_of(const Vec13& y) const {
  NodeState state{};
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(state.R) =
      rotation_of(Vec4(y.head<4>()));
  Eigen::Map<Vec3>(state.p) = y.segment<3>(kP);
  Eigen::Map<Vec3>(state.n) = y.segment<3>(kN);
  Eigen::Map<Vec3>(state.m) = y.segment<3>(kM);
  return state;
}

/// Force and moment of all loads and disks at a station; n, m fall by them.
Vec6 CollocationRod::load_at(std::size_t station, const Mat3& R) const {
  Vec6 sum = Vec6::Zero();
  for (std::size_t i = 0; i < station_of_.size(); ++i) {
    if (station_of_[i] != station) continue;
    const PointLoad& load = forcing_.loads[i];
    sum.head<3>() += load.follower ? Vec3(R * load.force) : load.force;
    sum.tail<3>() += load.follower ? Vec3(R * load.torque) : load.torque;
  }
  if (touch_) sum += touch_->load_at(station, R);
  if (disks_) sum -= disks_->jump_at(station);
  return sum;
}

/// Its derivative by the section's motion (phi, dp): d(R F) = phi × R F.
Mat6 CollocationRod::load_by_motion(std::size_t station, const Mat3& R) const {
  Mat6 by_motion = Mat6::Zero();
  for (std::size_t i = 0; i < station_of_.size(); ++i) {
    const PointLoad& load = forcing_.loads[i];
    if (station_of_[i] != station || !load.follower) continue;
    by_motion.block<3, 3>(0, 0) -= hat(R * load.force);
    by_motion.block<3, 3>(3, 0) -= hat(R * load.torque);
  }
  if (touch_) by_motion.block<3, 3>(3, 0) += touch_->moment_by_turn(station, R);
  if (disks_) by_motion -= disks_->by_motion(station);
  return by_motion;
}

/// Before a load at the base.
NodeState CollocationRod::base_state() const {
  NodeState state = state_of(control_.front());
  const Vec6 load = load_at(0, Mat3(rotation_of(state)));
  Eigen::Map<Vec3>(state.n) += load.head<3>();
  Eigen::Map<Vec3>(state.m) += load.tail<3>();
  return state;
}

/// Beyond a load at the tip.
NodeState CollocationRod::tip_state() const {
  NodeState state = state_of(control_.back());
  const Vec6 load = load_at(pieces_.size(), Mat3(rotation_of(state)));
  Eigen::Map<Vec3>(state.n) -= load.head<3>();
  Eigen::Map<Vec3>(state.m) -= load.tail<3>();
  return state;
}

Vec3 CollocationRod::compliance_bt(const SectionProperties& section) const {
  Vec3 K = section.K_bt;
  if (options_.damping) K += rates_.c_v * section.B_bt;
  return K.cwiseInverse();
}

// Rigid modes are zeros: shear and extension each only if the scene lists them.
Vec3 CollocationRod::compliance_se(const SectionProperties& section) const {
  Vec3 C = Vec3::Zero();
  const Vec3 B = options_.damping ? section.B_se : Vec3(Vec3::Zero());
  if (options_.shear)
    C.head<2>() = (section.K_se.head<2>() + rates_.c_v * B.head<2>()).cwiseInverse();
  if (options_.extension) C.z() = 1 / (section.K_se.z() + rates_.c_v * B.z());
  C.z() += forcing_.axial_softness * forcing_.length * forcing_.length /
           section_.K_bt.head<2>().maxCoeff();
  return C;
}

void CollocationRod::set_coefficients(const SectionProperties& section, PointModel& model) const {
  model.C_bt = compliance_bt(section);
  model.C_se = compliance_se(section);
  model.k = section.rhoA * rates_.c_v * rates_.c_w + forcing_.relaxation;
  model.rotary = options_.rotary_inertia && rates_.dynamic();
  Eigen::Map<Vec3>(model.rhoJ) = section.rhoJ;
  model.c_v = rates_.c_v;
  model.c_w = rates_.c_w;
  model.body_rates = rates_.body_rates;
  model.field = fluid_.field();
}

void CollocationRod::place_lines() {
  std::vector<double> inside;
  for (const Piece& piece : pieces_) {
    const auto first = static_cast<std::size_t>(piece.first_point),
               last = first + static_cast<std::size_t>(piece.points) - 1;
    for (std::size_t j = first; j <= last; ++j)
      inside.push_back(j == first || j == last ? 0.5 * (sites_[first].s + sites_[last].s)
                                               : sites_[j].s);
  }
  fluid_.place(std::move(inside), options_.magnets);
}

void CollocationRod::list_sections() {
  for (const Piece& piece : pieces_) {
    const auto first = static_cast<std::size_t>(piece.first_point);
    const std::size_t last = first + static_cast<std::size_t>(piece.points) - 1;
    const double middle = 0.5 * (sites_[first].s + sites_[last].s);
    for (std::size_t j = first; j <= last; ++j) {
      // a piece ends where sections are not smooth: only its ends need to know their side
      const double inside = j == first || j == last ? middle : sites_[j].s;
      sections_.push_back(options_.along->at(sites_[j].s, inside));
    }
  }
  models_.resize(sections_.size());
}

void CollocationRod::prepare(const StageRates& rates, const RodForcing& forcing) {
  rates_ = rates;
  forcing_ = forcing;
  if (tendons_) tendons_->set(forcing.tendons, forcing.length);
  assert(forcing_.loads.size() == station_of_.size());
  fluid_.prepare(section_, sections_, rates, forcing_, track_);
  set_coefficients(section_, model_);
  for (std::size_t j = 0; j < models_.size(); ++j)
    set_coefficients(sections_[j], models_[j]);
  if (disks_) disks_->prepare(rates, forcing, track_);
  choose_units();
  update_point_inputs();
}

void CollocationRod::choose_units() {
  const double L = forcing_.length, EI = section_.K_bt.head<2>().maxCoeff();
  scale_ = {L, EI / (L * L), EI / L};
  double N = 0;
  for (const CollocationPoint& point : points_)
    N = std::max(N, point.n().norm());
  for (const PointLoad& load : forcing_.loads)
    N = std::max(N, load.force.norm());
  if (disks_) N = std::max(N, disks_->weight());
  // positions carry round-off eps L, which inertia turns into forces eps k L²; control points of
  // forces carry eps N, and slopes of splines are up to degree / h
  constexpr double kEps = std::numeric_limits<double>::epsilon();
  const double k = model_.k + fluid_.stiffness();
  const double of_disks = disks_ ? disks_->stiffness() / L : 0;
  const double by_inertia = 50 * kEps * (k + of_disks) * L * L,
               by_slopes = 4 * kEps * N * options_.degree * std::sqrt(elements_);
  noise_ = std::max(1.0, std::max(by_inertia, by_slopes) / (scale_.force * forcing_.tolerance));
  Vec3 K_se = Vec3::Zero();
  for (int i = 0; i < 3; ++i)
    if (model_.C_se[i] > 0) K_se[i] = 1 / model_.C_se[i];
  growth_ = cprsim::growth_exponent(section_, model_.C_bt.cwiseInverse(), K_se, L, k, N);
  for (std::size_t j = 0; j < models_.size(); ++j)
    growth_ =
        std::max(growth_, cprsim::growth_exponent(sections_[j], models_[j].C_bt.cwiseInverse(),
                                                  K_se, L, models_[j].k, N));
  if (disks_) growth_ = std::max(growth_, disks_->growth_exponent(EI, L, model_.k));
  const double layer = L / std::max(1.0, growth_);
  unit_ = {layer, EI / (layer * layer), EI / layer};
}

// m = K (u - u_rest) + B u_t with u_t = c_v u + x_h: u = C (K u_rest - B x_h) + C m; likewise v.
void CollocationRod::update_point_inputs() {
  const Vec3 z = Vec3::UnitZ();
  const auto n = static_cast<Eigen::Index>(points_.size());
  for (std::size_t j = 0; j < points_.size(); ++j) {
    CollocationPoint& point = points_[j];
    const SectionProperties& own = section(j);
    const PointModel& at = model(j);
    const auto i = 3 * static_cast<Eigen::Index>(j), strain = strain_track() + i;
    point.b = -own.weighing_mass() * forcing_.gravity;
    point.u0 = at.C_bt.cwiseProduct(own.K_bt.cwiseProduct(own.u_rest + forcing_.heat.curvature));
    point.v0 = z;
    if (forcing_.heat.stretch != 0) {
      // C K of the stretch that heat adds
      const double B = options_.damping ? own.B_se.z() : 0;
      point.v0.z() += (1 - rates_.c_v * at.C_se.z() * B) * forcing_.heat.stretch;
    }
    if (forcing_.relaxation > 0) point.b -= forcing_.relaxation * marked_[j];
    if (!rates_.dynamic()) continue;
    point.b += own.rhoA * (rates_.c_w * track_.x_h.segment<3>(i) + track_.v_h.segment<3>(i));
    if (options_.damping) {
      point.u0 -= at.C_bt.cwiseProduct(own.B_bt.cwiseProduct(track_.x_h.segment<3>(strain)));
      if (extensible_)
        point.v0 -= at.C_se.cwiseProduct(
            own.B_se.cwiseProduct(rates_.c_v * z + track_.x_h.segment<3>(strain + 3 * n)));
    }
    if (!model_.rotary) continue;
    Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(point.spin.R_start) =
        reference_rotations_[j];
    Eigen::Map<Vec3>(point.spin.theta_h) = rotation_track_.x_h.segment<3>(i);
    Eigen::Map<Vec3>(point.spin.omega_h) = rotation_track_.v_h.segment<3>(i);
  }
}

/// Before the piece: what it starts with minus what the one before ends with, its load passed.
Vec13 CollocationRod::join_rows(std::size_t piece) const {
  const auto at = static_cast<std::size_t>(pieces_[piece].first_control);
  Vec13 r = control_[at] - control_[at - 1];
  r.tail<6>() += load_at(piece, rotation_of(Vec4(control_[at - 1].head<4>())));
  return r;
}

/// What makes rows dimensionless. The squares of a point's rows add up to their mean square along
/// the rod, whatever the number of points; those of a join are differences of fields.
Vec13 CollocationRod::point_scale(std::size_t point) const {
  const double share = std::sqrt(weights_[point]), L = scale_.length;
  Vec13 d;
  d << share * L, Vec3::Constant(share * L / noise_), Vec3::Constant(share / noise_),
      Vec3::Constant(share * L / (scale_.force * noise_)),
      Vec3::Constant(share * L / (scale_.moment * noise_));
  return d;
}

Vec13 CollocationRod::join_scale() const {
  Vec13 d;
  d << Vec4::Ones(), Vec3::Constant(1 / scale_.length), Vec3::Constant(1 / (scale_.force * noise_)),
      Vec3::Constant(1 / (scale_.moment * noise_));
  return d;
}

RodResidual CollocationRod::evaluate(const Port& base, const Port& tip) {
  RodScale loose = scale_;
  loose.force *= noise_;
  loose.moment *= noise_;
  RodResidual r;
  int row = 0;
  const auto add = [&](const auto& values) {
    for (const double value : values) {
      const double size =
          std::isfinite(value) ? std::abs(value) : std::numeric_limits<double>::infinity();
      r.sum_squares += value * value;
      r.finite = r.finite && std::isfinite(value);
      if (size > r.largest) {
        r.largest = size;
        r.worst_row = row;
      }
      ++row;
    }
  };
  if (disks_) meet_disks();
  add(VecX(base_.value(base_state(), base, loose) - base_gap_));
  add(Eigen::Matrix<double, 1, 1>(control_.front().head<4>().squaredNorm() - 1));
  residual_.clear();
  for (std::size_t g = 0; g < pieces_.size(); ++g) {
    if (g > 0) {
      residual_.push_back(join_rows(g));
      add(PointRows(rows_ * join_scale().cwiseProduct(residual_.back())));
    }
    for (int i = 0; i < pieces_[g].points; ++i) {
      const auto j = static_cast<std::size_t>(pieces_[g].first_point + i);
      points_[j].y = value(sites_[j]);
      points_[j].y_s = derivative(sites_[j]);
      residual_.push_back(evaluate_point(model(j), points_[j], fluid_at(j), tendons_at(j)));
      add(PointRows(rows_ * point_scale(j).cwiseProduct(residual_.back())));
    }
  }
  add(VecX(tip_.value(tip_state(), tip, loose) - tip_gap_));
  if (touch_) {
    update_touch_nodes();
    touch_->begin_rows();
  }
  if (finds_tensions()) add(tendon_gaps());
  section_evaluations_ += static_cast<long>(points_.size());
  return r;
}

}  // namespace cprsim
