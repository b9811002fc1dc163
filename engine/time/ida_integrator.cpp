// SPDX-License-Identifier: BSD-3-Clause
#include "engine/time/ida_integrator.h"

#include <ida/ida.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_nonlinearsolver.h>

#include <cmath>
#include <stdexcept>
#include <string>

namespace cprsim {

namespace {

constexpr double kUncounted = 1e-30;  // error weight of what does not count; IDA wants it positive
constexpr int kMostFailures = 20;     // of error tests and solves, a step

Eigen::Map<VecX> values(N_Vector vector) {
  return {NV_DATA_S(vector), NV_LENGTH_S(vector)};
}

void check(int flag, const char* what) {
  if (flag < 0) throw std::runtime_error(std::string("SUNDIALS: ") + what + " failed");
}

}  // namespace

struct IdaIntegrator::Memory {
  std::vector<Track*> tracks;
  std::vector<TrackError> errors;
  double tolerance = 0;
  Solve solve;

  SUNContext context = nullptr;
  N_Vector y = nullptr, y_t = nullptr;
  SUNNonlinearSolver solver = nullptr;
  void* ida = nullptr;
  double time = 0, first_step = 0;
  long rejected_before = 0;
  Eigen::Index size = 0;  // of x of all tracks; v is as long

  ~Memory() {
    if (ida != nullptr) IDAFree(&ida);
    if (solver != nullptr) SUNNonlinSolFreeEmpty(solver);
    for (N_Vector vector : {y, y_t})
      if (vector != nullptr) N_VDestroy(vector);
    if (context != nullptr) SUNContext_Free(&context);
  }

  /// Calls act(track, its x in y, its v in y).
  template <typename Act>
  void each(const Act& act) const {
    Eigen::Index at = 0;
    for (std::size_t i = 0; i < tracks.size(); ++i) {
      act(*tracks[i], at, size + at);
      at += tracks[i]->x.size();
    }
  }

  long rejected() const {
    long tests = 0, solves = 0;
    IDAGetNumErrTestFails(ida, &tests);
    IDAGetNumNonlinSolvConvFails(ida, &solves);
    return tests + solves;
  }

  /// y and y_t from what the tracks hold.
  void load() const {
    auto at_y = values(y), at_y_t = values(y_t);
    each([&](const Track& t, Eigen::Index x, Eigen::Index v) {
      const Eigen::Index n = t.x.size();
      at_y.segment(x, n) = t.x;
      at_y.segment(v, n) = t.v;
      at_y_t.segment(x, n) = t.x_t;
      at_y_t.segment(v, n) = t.a;
    });
  }

  void unload() const {
    const auto at_y = values(y), at_y_t = values(y_t);
    each([&](Track& t, Eigen::Index x, Eigen::Index v) {
      const Eigen::Index n = t.x.size();
      t.x = at_y.segment(x, n);
      t.v = at_y.segment(v, n);
      t.x_t = at_y_t.segment(x, n);
      t.a = at_y_t.segment(v, n);
    });
  }

  // The correction of what IDA predicts.
  int correct(N_Vector correction) {
    N_Vector predicted = nullptr, predicted_t = nullptr, unused[3];
    double now = 0, c = 0;
    void* user = nullptr;
    check(IDAGetNonlinearSystemData(ida, &now, &predicted, &predicted_t, &unused[0], &unused[1],
                                    &unused[2], &c, &user),
          "IDAGetNonlinearSystemData");
    const auto guess = values(predicted), guess_t = values(predicted_t);
    each([&](Track& t, Eigen::Index x, Eigen::Index v) {
      const Eigen::Index n = t.x.size();
      t.x_h = guess_t.segment(x, n) - c * guess.segment(x, n);
      t.v_h = guess_t.segment(v, n) - c * guess.segment(v, n);
    });
    if (!solve(now, {c, c, true})) return SUN_NLS_CONV_RECVR;
    auto found = values(correction);
    each([&](Track& t, Eigen::Index x, Eigen::Index v) {
      const Eigen::Index n = t.x.size();
      t.x_t = c * t.x + t.x_h;
      if (t.kind == Track::Kind::kLinear) t.v = t.x_t;
      t.a = c * t.v + t.v_h;
      found.segment(x, n) = t.x - guess.segment(x, n);
      found.segment(v, n) = t.v - guess.segment(v, n);
    });
    return SUN_NLS_SUCCESS;
  }

  // IDA's norm is a root mean square over all of y: with these weights, over what counts, the
  // square root of a sum.
  void weigh(N_Vector weights) const {
    double step = 0;
    IDAGetCurrentStep(ida, &step);
    if (!(step > 0)) step = first_step;
    auto w = values(weights);
    w.setConstant(kUncounted);
    const double all = std::sqrt(static_cast<double>(w.size())) / tolerance;
    std::size_t i = 0;
    each([&](const Track&, Eigen::Index x, Eigen::Index v) {
      const TrackError& error = errors[i++];
      w.segment(x, error.coordinates).setConstant(all / error.unit);
      w.segment(v, error.coordinates).setConstant(all * step / error.unit);
    });
  }
};

IdaIntegrator::IdaIntegrator(std::vector<Track*> tracks, std::vector<TrackError> errors,
                             double tolerance, Solve solve)
    : memory_(std::make_unique<Memory>()) {
  memory_->tracks = std::move(tracks);
  memory_->errors = std::move(errors);
  memory_->tolerance = tolerance;
  memory_->solve = std::move(solve);
}

IdaIntegrator::~IdaIntegrator() = default;

void IdaIntegrator::begin(double time, double step) {
  Memory& m = *memory_;
  m.first_step = step;
  for (Track* track : m.tracks)
    if (track->kind == Track::Kind::kRotation) {
      track->x.setZero();
      track->x_t = track->v;
    }
  if (m.ida == nullptr) {
    for (const Track* track : m.tracks)
      m.size += track->x.size();
    check(SUNContext_Create(nullptr, &m.context), "SUNContext_Create");
    m.y = N_VNew_Serial(2 * m.size, m.context);
    m.y_t = N_VClone(m.y);
    m.load();
    m.ida = IDACreate(m.context);
    // a residual of IDA's own form is never asked for: the solver below is all that would
    const auto no_residual = [](double, N_Vector, N_Vector, N_Vector, void*) { return -1; };
    check(IDAInit(m.ida, no_residual, time, m.y, m.y_t), "IDAInit");
    check(IDASetUserData(m.ida, &m), "IDASetUserData");
    const auto quiet = [](int, const char*, const char*, char*, void*) {};
    check(IDASetErrHandlerFn(m.ida, quiet, nullptr), "IDASetErrHandlerFn");
    const auto weigh = [](N_Vector, N_Vector weights, void* memory) {
      static_cast<Memory*>(memory)->weigh(weights);
      return 0;
    };
    check(IDAWFtolerances(m.ida, weigh), "IDAWFtolerances");
    m.solver = SUNNonlinSolNewEmpty(m.context);
    m.solver->content = &m;
    m.solver->ops->gettype = [](SUNNonlinearSolver) { return SUNNONLINEARSOLVER_ROOTFIND; };
    m.solver->ops->setsysfn = [](SUNNonlinearSolver, SUNNonlinSolSysFn) { return SUN_NLS_SUCCESS; };
    m.solver->ops->solve = [](SUNNonlinearSolver solver, N_Vector, N_Vector correction, N_Vector,
                              double, int, void*) {
      return static_cast<Memory*>(solver->content)->correct(correction);
    };
    check(IDASetNonlinearSolver(m.ida, m.solver), "IDASetNonlinearSolver");
    check(IDASetMaxErrTestFails(m.ida, kMostFailures), "IDASetMaxErrTestFails");
    check(IDASetMaxConvFails(m.ida, kMostFailures), "IDASetMaxConvFails");
  } else {
    m.load();
    check(IDAReInit(m.ida, time, m.y, m.y_t), "IDAReInit");
  }
  m.rejected_before = 0;
  m.time = time;
  check(IDASetInitStep(m.ida, step), "IDASetInitStep");
  begun_ = true;
}

std::optional<double> IdaIntegrator::advance(double end) {
  Memory& m = *memory_;
  check(IDASetStopTime(m.ida, end), "IDASetStopTime");
  double reached = m.time;
  if (IDASolve(m.ida, end, &reached, m.y, m.y_t, IDA_ONE_STEP) < 0) {
    begun_ = false;
    m.unload();
    return std::nullopt;
  }
  m.time = reached;
  return reached;
}

long IdaIntegrator::take_rejected() {
  const long all = memory_->rejected(), fresh = all - memory_->rejected_before;
  memory_->rejected_before = all;
  return fresh;
}

double IdaIntegrator::next_step() const {
  double step = 0;
  IDAGetCurrentStep(memory_->ida, &step);
  return step;
}

}  // namespace cprsim
