// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/reference_arc.h"

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <stdexcept>
#include <string>

namespace cprsim {
namespace {

// layout of the state: p 0..2, h 3..6 (x y z w), n 7..9, m 10..12
constexpr int kSize = 13;
using State = Eigen::Matrix<double, kSize, 1>;

Eigen::Map<State> entries(N_Vector y) {
  return Eigen::Map<State>(N_VGetArrayPointer(y));
}

int slope(realtype s, N_Vector y_vector, N_Vector y_s_vector, void* rod_pointer) {
  const ReferenceRod& given = *static_cast<const ReferenceRod*>(rod_pointer);
  const Eigen::Map<State> y = entries(y_vector);
  Eigen::Map<State> y_s = entries(y_s_vector);
  const Quat h(y[6], y[3], y[4], y[5]);
  const Mat3 R = h.normalized().toRotationMatrix();
  const Vec3 n = y.segment<3>(7), m = y.segment<3>(10);
  ReferenceRod rod;
  rod.C_bt = given.C_bt;
  rod.C_se = given.C_se;
  rod.u_ref = given.u_ref;
  rod.f = given.f;
  rod.l = given.l;
  if (given.vary) given.vary(s, R, rod);
  if (given.vary_at) given.vary_at({R, y.segment<3>(0)}, rod);

  // (2)
  const Vec3 u = rod.u_ref + rod.C_bt * (R.transpose() * m);
  const Vec3 v = Vec3::UnitZ() + rod.C_se * (R.transpose() * n);

  // (1)
  const Vec3 p_s = R * v;
  const Quat h_s = h * Quat(0, u.x() / 2, u.y() / 2, u.z() / 2);
  y_s.segment<3>(0) = p_s;
  y_s.segment<4>(3) = h_s.coeffs();
  y_s.segment<3>(7) = -rod.f;
  y_s.segment<3>(10) = -p_s.cross(n) - rod.l;
  return 0;
}

void check(int flag, const char* call) {
  if (flag < 0) throw std::runtime_error(std::string(call) + " failed: " + std::to_string(flag));
}

/// One CVODE integration and what it owns.
class Integration {
 public:
  Integration(const ReferenceRod& rod, const State& start, double tolerance) : rod_(rod) {
    check(SUNContext_Create(nullptr, &context_), "SUNContext_Create");
    y_ = N_VNew_Serial(kSize, context_);
    absolute_ = N_VNew_Serial(kSize, context_);
    entries(y_) = start;
    entries(absolute_) = tolerance * scales(rod, start);
    solver_ = SUNNonlinSol_FixedPoint(y_, 0, context_);
    memory_ = CVodeCreate(CV_ADAMS, context_);
    check(CVodeInit(memory_, slope, 0, y_), "CVodeInit");
    check(CVodeSVtolerances(memory_, tolerance, absolute_), "CVodeSVtolerances");
    check(CVodeSetUserData(memory_, &rod_), "CVodeSetUserData");
    check(CVodeSetNonlinearSolver(memory_, solver_), "CVodeSetNonlinearSolver");
    check(CVodeSetMaxNumSteps(memory_, 1000000), "CVodeSetMaxNumSteps");
    check(CVodeSetMaxNonlinIters(memory_, 30), "CVodeSetMaxNonlinIters");
  }

  Integration(const Integration&) = delete;
  Integration& operator=(const Integration&) = delete;

  ~Integration() {
    CVodeFree(&memory_);
    SUNNonlinSolFree(solver_);
    N_VDestroy(absolute_);
    N_VDestroy(y_);
    SUNContext_Free(&context_);
  }

  State advance(double s) {
    if (s <= 0) return entries(y_);
    realtype reached = 0;
    check(CVodeSetStopTime(memory_, s), "CVodeSetStopTime");
    check(CVode(memory_, s, y_, &reached, CV_NORMAL), "CVode");
    return entries(y_);
  }

 private:
  /// Sizes below which an entry does not matter: its length, 1, force and moment of the problem.
  static State scales(const ReferenceRod& rod, const State& start) {
    const double force = start.segment<3>(7).norm() + rod.f.norm() * rod.length;
    const double moment =
        start.segment<3>(10).norm() + (rod.l.norm() + force) * rod.length + 1e-100;
    State scale;
    scale.segment<3>(0).setConstant(rod.length);
    scale.segment<4>(3).setOnes();
    scale.segment<3>(7).setConstant(force + 1e-100);
    scale.segment<3>(10).setConstant(moment);
    return scale;
  }

  ReferenceRod rod_;
  SUNContext context_ = nullptr;
  N_Vector y_ = nullptr, absolute_ = nullptr;
  SUNNonlinearSolver solver_ = nullptr;
  void* memory_ = nullptr;
};

}  // namespace

ReferenceSection integrate_reference_arc(const ReferenceRod& rod, const ReferenceSection& base,
                                         double fraction, double tolerance) {
  State start;
  start.segment<3>(0) = base.X_WS.p;
  start.segment<4>(3) = Quat(base.X_WS.R).normalized().coeffs();
  start.segment<3>(7) = base.n;
  start.segment<3>(10) = base.m;
  Integration integration(rod, start, tolerance);
  const State end = integration.advance(fraction * rod.length);
  const Quat h(end[6], end[3], end[4], end[5]);
  return {{h.normalized().toRotationMatrix(), end.segment<3>(0)},
          end.segment<3>(7),
          end.segment<3>(10)};
}

}  // namespace cprsim
