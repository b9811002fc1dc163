// SPDX-License-Identifier: BSD-3-Clause
#include "engine/time/scheme.h"

#include <algorithm>

namespace cprsim {
namespace {

struct AlphaCoefficients {
  double alpha_m, alpha_f, beta, gamma;
};

// Chung & Hulbert 1993
AlphaCoefficients generalized_alpha(double rho_inf) {
  const double am = (2 * rho_inf - 1) / (rho_inf + 1), af = rho_inf / (rho_inf + 1);
  const double gamma = 0.5 + af - am;
  return {am, af, 0.25 * (gamma + 0.5) * (gamma + 0.5), gamma};
}

// Rounds of (2): each takes about a digit off an undamped oscillation, more off anything else.
constexpr int kMostRounds = 60;

const DirkTable* table_of(SchemeKind kind) {
  switch (kind) {
    case SchemeKind::kTrBdf2:
      return &tr_bdf2();
    case SchemeKind::kEsdirk32:
      return &esdirk32();
    case SchemeKind::kEsdirk43:
      return &esdirk43();
    default:
      return nullptr;
  }
}

}  // namespace

void Track::resize(Eigen::Index n) {
  for (VecX* q : {&x, &x_t, &v, &a, &x_h, &v_h, &x0, &x_t0, &v0, &a0, &x1, &v1, &A0, &A})
    q->setZero(n);
  k_x.assign(6, VecX::Zero(n));
  k_v.assign(6, VecX::Zero(n));
}

void Track::set_start(const VecX& x_start, const VecX& v_start) {
  x0 = x = x1 = x_start;
  v0 = v = x_t0 = x_t = v1 = v_start;
  a0.setZero();
  a.setZero();
  A0.setZero();
}

void Track::visit(Archive& archive) {
  for (VecX* q : {&x, &x_t, &v, &a, &x_h, &v_h, &x0, &x_t0, &v0, &a0, &x1, &v1, &A0, &A})
    archive(*q);
}

void Stepper::visit(Archive& archive) {
  archive(fresh_);
  archive(cushioned_);
  archive(h_);
  archive(h_last_);
}

int Stepper::begin_step(double h, const std::vector<Track*>& tracks) {
  h_ = h;
  if (rounds()) {
    table_ = nullptr;
    for (Track* t : tracks)
      for (std::size_t j = 0; j < 3; ++j) {
        t->k_x[j] = t->x_t0;
        t->k_v[j] = fresh_ ? VecX::Zero(t->a0.size()) : t->a0;
      }
    return 3 * kMostRounds;
  }
  table_ = fresh_ && kind() != SchemeKind::kBackwardEuler ? &sdirk3() : table_of(kind());
  if (!table_) return 1;
  if (!table_->explicit_first) return table_->stages;
  for (Track* t : tracks) {
    t->k_x[0] = t->x_t0;
    t->k_v[0] = t->a0;
  }
  return table_->stages - 1;
}

double Stepper::stage_time(int i) const {
  if (rounds()) return radau5().c[i % 3];
  return table_ ? table_->c[i + (table_->explicit_first ? 1 : 0)] : 1.0;
}

Stepper::Multistep Stepper::multistep_coefficients() const {
  if (kind() == SchemeKind::kBackwardEuler) return {1 / h_, -1 / h_, 0, 0};
  const double alpha = kind() == SchemeKind::kBdf2 ? 0 : choice_.alpha;
  // derivative at alpha h of the parabola through (0, x_n), (-h, x_n-1), (-h - h_last, x_n-2)
  const double t = alpha * h_, t1 = -h_, t2 = -h_ - h_last_, s = 1 / (1 + alpha);
  return {s * (2 * t - t1 - t2) / (t1 * t2), s * (2 * t - t2) / (t1 * (t1 - t2)),
          s * (2 * t - t1) / (t2 * (t2 - t1)), alpha * s};
}

void Stepper::begin_dirk_stage(int i, Track& t) const {
  const bool rotation = t.kind == Track::Kind::kRotation;
  if (rotation) {
    t.x_h.setZero();
  } else {
    t.x_h = t.x0;
  }
  t.v_h = t.v0;
  for (int j = 0; j < i; ++j) {
    if (table_->a[i][j] == 0) continue;
    t.x_h += (h_ * table_->a[i][j]) * t.k_x[static_cast<std::size_t>(j)];
    t.v_h += (h_ * table_->a[i][j]) * t.k_v[static_cast<std::size_t>(j)];
  }
  t.x_h *= -rates_.c_v;
  t.v_h *= -rates_.c_w;
}

// (2). k_x, k_v hold the newest of each stage, behind them those of the round before.
void Stepper::begin_radau_stage(int i, Track& t) const {
  const RadauTable& radau = radau5();
  if (i == 0)
    for (std::size_t j = 0; j < 3; ++j) {
      t.k_x[3 + j] = t.k_x[j];
      t.k_v[3 + j] = t.k_v[j];
    }
  t.x_h = t.kind == Track::Kind::kRotation ? VecX::Zero(t.x0.size()) : t.x0;
  t.v_h = t.v0;
  const auto add = [&](double weight, std::size_t j) {
    t.x_h += (h_ * weight) * t.k_x[j];
    t.v_h += (h_ * weight) * t.k_v[j];
  };
  for (int j = 0; j < 3; ++j) {
    const double lower = j <= i ? radau.lower[i][j] : 0;
    add(radau.a[i][j] - lower, static_cast<std::size_t>(3 + j));
    if (j < i) add(lower, static_cast<std::size_t>(j));
  }
  t.x_h *= -rates_.c_v;
  t.v_h *= -rates_.c_w;
}

StageRates Stepper::begin_stage(int i, const std::vector<Track*>& tracks) {
  if (table_) {
    const double c0 = 1 / (h_ * table_->diagonal);
    rates_ = {c0, c0, true};
    for (Track* t : tracks)
      begin_dirk_stage(i + (table_->explicit_first ? 1 : 0), *t);
    return rates_;
  }
  if (rounds()) {
    const double c = 1 / (h_ * radau5().lower[i % 3][i % 3]);
    rates_ = {c, c, true};
    for (Track* t : tracks)
      begin_radau_stage(i % 3, *t);
    return rates_;
  }
  if (kind() == SchemeKind::kGeneralizedAlpha) {
    const AlphaCoefficients g = generalized_alpha(choice_.rho_inf);
    rates_ = {g.gamma / (g.beta * h_), (1 - g.alpha_m) / ((1 - g.alpha_f) * h_ * g.gamma), false};
    for (Track* t : tracks) {
      const VecX predicted = h_ * t->v0 + (h_ * h_ * (0.5 - g.beta)) * t->A0;
      t->x_h = t->v0 + (h_ * (1 - g.gamma)) * t->A0 - rates_.c_v * predicted;
      if (t->kind == Track::Kind::kLinear) t->x_h -= rates_.c_v * t->x0;
      t->v_h = (g.alpha_m * t->A0 - g.alpha_f * t->a0) / (1 - g.alpha_f) -
               rates_.c_w * (t->v0 + (h_ * (1 - g.gamma)) * t->A0);
    }
    return rates_;
  }
  const Multistep m = multistep_coefficients();
  rates_ = {m.c0, m.c0, true};
  for (Track* t : tracks) {
    t->x_h = m.d1 * t->x_t0;
    if (m.c2 != 0) t->x_h += m.c2 * t->x1;
    if (t->kind == Track::Kind::kLinear) t->x_h += m.c1 * t->x0;
    t->v_h = m.c1 * t->v0 + m.d1 * t->a0;
    if (m.c2 != 0) t->v_h += m.c2 * t->v1;
  }
  return rates_;
}

void Stepper::finish_stage(int i, const std::vector<Track*>& tracks) {
  for (Track* t : tracks) {
    t->x_t = rates_.c_v * t->x + t->x_h;
    if (t->kind == Track::Kind::kLinear || !rates_.body_rates) t->v = t->x_t;
    t->a = rates_.c_w * t->v + t->v_h;
    if (table_ || rounds()) {
      const auto k =
          static_cast<std::size_t>(table_ ? i + (table_->explicit_first ? 1 : 0) : i % 3);
      t->k_x[k] = t->x_t;
      t->k_v[k] = t->a;
    }
  }
}

double Stepper::change(const Track& track, Eigen::Index coordinates) const {
  double most = 0;
  for (std::size_t j = 0; j < 3; ++j) {
    const auto of = [&](const std::vector<VecX>& k) {
      return (k[j] - k[3 + j]).head(coordinates).lpNorm<Eigen::Infinity>();
    };
    most = std::max({most, h_ * of(track.k_x), h_ * h_ * of(track.k_v)});
  }
  return most;
}

VecX Stepper::position_error(const Track& track) const {
  VecX e = VecX::Zero(track.x.size());
  if (table_)
    for (int j = 0; j < table_->stages; ++j)
      e += (h_ * table_->b_error[j]) * track.k_x[static_cast<std::size_t>(j)];
  return e;
}

VecX Stepper::velocity_error(const Track& track) const {
  VecX e = VecX::Zero(track.x.size());
  if (table_)
    for (int j = 0; j < table_->stages; ++j)
      e += (h_ * table_->b_error[j]) * track.k_v[static_cast<std::size_t>(j)];
  return e;
}

double Stepper::integrate(const std::vector<double>& values) const {
  if (rounds())
    return radau5().a[2][0] * values[1] + radau5().a[2][1] * values[2] +
           radau5().a[2][2] * values[3];
  // what backward Euler loses to a damper is h times the power at its end
  if (!table_) return cushioned_ ? values.back() : 0.5 * (values.front() + values.back());
  double sum = 0;
  const auto first = static_cast<std::size_t>(table_->explicit_first ? 0 : 1);
  for (std::size_t j = 0; j + first < values.size(); ++j)
    sum += table_->a[table_->stages - 1][j] * values[j + first];
  return sum;
}

void Stepper::accept(const std::vector<Track*>& tracks) {
  const AlphaCoefficients g = generalized_alpha(choice_.rho_inf);
  for (Track* t : tracks) {
    // after a starter the auxiliary acceleration is the true one: its offset is second order in the
    // step
    if (kind() == SchemeKind::kGeneralizedAlpha && !table_)
      t->A0 = (t->v - t->v0 - (h_ * (1 - g.gamma)) * t->A0) / (h_ * g.gamma);
    else
      t->A0 = t->a;
    t->v1 = t->v0;
    t->v0 = t->v;
    t->a0 = t->a;
    if (t->kind == Track::Kind::kRotation) {
      // the new reference frame is that of the step's end
      t->x1 = -t->x;
      t->x0.setZero();
      t->x_t0 = t->v;
    } else {
      t->x1 = t->x0;
      t->x0 = t->x;
      t->x_t0 = t->x_t;
    }
  }
  h_last_ = h_;
  fresh_ = false;
}

const char* Stepper::step_name() const {
  return table_ ? table_->name : to_string(kind());
}

const char* to_string(SchemeKind kind) {
  switch (kind) {
    case SchemeKind::kBackwardEuler:
      return "backward_euler";
    case SchemeKind::kBdf2:
      return "bdf2";
    case SchemeKind::kBdfAlpha:
      return "bdf_alpha";
    case SchemeKind::kGeneralizedAlpha:
      return "generalized_alpha";
    case SchemeKind::kTrBdf2:
      return "tr_bdf2";
    case SchemeKind::kEsdirk43:
      return "esdirk43";
    case SchemeKind::kRadau5:
      return "radau5";
    case SchemeKind::kIda:
      return "ida";
    case SchemeKind::kEsdirk32:
      break;
  }
  return "esdirk32";
}

}  // namespace cprsim
