// SPDX-License-Identifier: BSD-3-Clause
// The linearised cell against differences of its evaluation. Along column c of Y and dU,
//   start ⊕ eps Y0_c, lifted + eps dU_c:   residual' = 0 (the affine column: -residual),
//                                           end' = Y_c
#include "engine/rod/cell.h"

#include <gtest/gtest.h>

#include "engine/math/so3.h"
#include "engine/rod/rod_end.h"
#include "tests/engine/robot/sample_scenes.h"
#include "tests/support/finite_difference.h"

namespace cprsim {
namespace {

using RowMat3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
using RowMatX = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

struct Case {
  ArcIntegrator integrator;
  CellLaw law;
  bool rotary, inertia, body_rates;

  std::string name() const {
    return std::string(arc_tableau(integrator).name) + ", law " +
           std::to_string(static_cast<int>(law)) + (rotary ? ", rotary" : "") +
           (inertia ? ", inertia" : "") + (body_rates ? ", body rates" : "");
  }
};

/// Everything a kernel is given: numbers near 1, nothing zero, residuals far from zero.
struct Cell {
  CellModel model;
  std::vector<CellStage> stages;
  std::vector<FluidSection> fluid;
  std::vector<CellSection> sections;
  NodeState start{};
  const CellKernel* kernel = nullptr;

  std::size_t S() const { return stages.size(); }

  int lifted() const { return kernel->lifted; }

  double& unknown(int i) {
    const auto at = static_cast<std::size_t>(i);
    if (at < 3 * S()) return stages[at / 3].w[at % 3];
    return stages[at / 3 - S()].v[at % 3];
  }

  double residual(int i) const {
    const auto at = static_cast<std::size_t>(i);
    if (at < 3 * S()) return stages[at / 3].residual_u[at % 3];
    return stages[at / 3 - S()].residual_v[at % 3];
  }

  NodeState evaluate() {
    NodeState end{};
    model.fluid = fluid.data();
    model.sections = sections.data();
    kernel->evaluate(model, stages.data(), start, end);
    return end;
  }
};

void put(double* to, const Vec3& v) {
  Eigen::Map<Vec3>{to} = v;
}

Cell make_cell(const Case& c, unsigned seed) {
  Numbers numbers(seed);
  Cell cell;
  const ArcTableau& table = arc_tableau(c.integrator);
  cell.kernel = &cell_kernel(table.stages, c.rotary ? generalized(c.law) : c.law);
  CellModel& M = cell.model;
  M.table = &table;
  M.h = 0.4;
  put(M.C_bt, {1.1, 0.8, 0.9});
  put(M.C_se, {0.05, 0.09, 0.03});
  M.k = c.inertia ? 2.5 : 0;
  M.rotary = c.rotary;
  put(M.rhoJ, {0.1, 0.2, 0.25});
  M.c_v = 3;
  M.c_w = 2.5;
  M.body_rates = c.body_rates;
  const Mat3 R = exp_so3(2 * numbers.vec3());
  Eigen::Map<RowMat3>{cell.start.R} = R;
  put(cell.start.p, numbers.vec3());
  put(cell.start.n, numbers.vec3());
  put(cell.start.m, numbers.vec3());
  cell.stages.assign(static_cast<std::size_t>(table.stages), CellStage{});
  for (CellStage& s : cell.stages) {
    // u0 carries the rest curvature besides the history of damping
    for (double* q : {s.u0, s.b, s.theta_h, s.omega_h, s.w})
      put(q, numbers.vec3());
    put(s.v0, Vec3::UnitZ() + 0.2 * numbers.vec3());
    put(s.v, Vec3::UnitZ() + 0.2 * numbers.vec3());
    Eigen::Map<RowMat3>{s.R_start} = R * exp_so3(0.5 * numbers.vec3());
    if (is_unloaded(c.law)) put(s.b, Vec3::Zero());
  }
  cell.sections.assign(cell.stages.size(), M);
  cell.fluid.assign(immersed(c.law) ? cell.stages.size() : 0, FluidSection{});
  for (FluidSection& f : cell.fluid) {
    f.normal = 0.4;
    f.tangential = 0.2;
    f.added_mass = 0.3;
    // never at rest along the axis, where drag has no second derivative
    put(f.velocity_h, 8 * R.col(2) + numbers.vec3());
    put(f.acceleration_h, numbers.vec3());
    // next to a dipole
    f.loaded = f.magnetic = 1;
    put(f.magnetization, numbers.vec3());
  }
  static const MagneticDipole dipole{{3, -2, 2.5}, {4e7, 7e7, -3e7}};
  static const OuterField field{{{0.2, -0.3, 0.1}, &dipole, 1}};
  if (immersed(c.law)) {
    M.loaded = true;
    M.field = &field;
  }
  return cell;
}

RowMatX start_columns(int columns, unsigned seed) {
  Numbers numbers(seed);
  RowMatX Y(12, columns);
  // the shared columns first, so that both widths get the same ones
  const auto fill = [&](Eigen::Index c) { Y.col(c) << numbers.vec6(), numbers.vec6(); };
  Y.setZero();
  for (int c = 0; c < 6; ++c)
    fill(c);
  fill(columns == kNarrow ? 6 : 12);
  if (columns == kWide)
    for (int c = 6; c < 12; ++c)
      fill(c);
  return Y;
}

struct Linearized {
  RowMatX Y, dU;
  bool regular;
};

Linearized linearize(const Cell& cell, const NodeState& end, const RowMatX& Y0) {
  Linearized out{Y0, RowMatX::Zero(cell.lifted(), Y0.cols()), false};
  const auto f = Y0.cols() == kNarrow ? cell.kernel->linearize_narrow : cell.kernel->linearize_wide;
  out.regular = f(cell.model, cell.stages.data(), cell.start, end, out.Y.data(), out.dU.data());
  return out;
}

/// The cell moved by the columns' weights d.
Cell moved(Cell cell, const RowMatX& Y0, const RowMatX& dU, const VecX& d) {
  const Vec12 y = Y0 * d;
  const VecX u = dU * d;
  Eigen::Map<RowMat3>{cell.start.R} =
      exp_so3(y.head<3>()) * Mat3(Eigen::Map<RowMat3>{cell.start.R});
  Eigen::Map<Vec3>{cell.start.p} += y.segment<3>(3);
  Eigen::Map<Vec3>{cell.start.n} += y.segment<3>(6);
  Eigen::Map<Vec3>{cell.start.m} += y.segment<3>(9);
  for (int i = 0; i < cell.lifted(); ++i)
    cell.unknown(i) += u[i];
  return cell;
}

/// Columns of residuals and end state by differences.
MatX differences(const Cell& cell, const RowMatX& Y0, const RowMatX& dU) {
  struct Values {
    VecX residual;
    NodeState end;
  };

  const auto f = [](Cell at) {
    Values v;
    v.end = at.evaluate();
    v.residual.resize(at.lifted());
    for (int i = 0; i < at.lifted(); ++i)
      v.residual[i] = at.residual(i);
    return v;
  };
  const auto increment = [&](const Cell& at, const VecX& d) { return moved(at, Y0, dU, d); };
  const auto subtract = [](const Values& a, const Values& b) -> VecX {
    VecX d(a.residual.size() + 12);
    d << a.residual - b.residual,
        log_so3(Mat3(rotation_of(a.end)) * Mat3(rotation_of(b.end)).transpose()),
        position_of(a.end) - position_of(b.end), force_of(a.end) - force_of(b.end),
        moment_of(a.end) - moment_of(b.end);
    return d;
  };
  return difference_jacobian(f, cell, static_cast<int>(Y0.cols()), increment, subtract, 1e-3);
}

std::vector<Case> cases() {
  std::vector<Case> all;
  for (ArcIntegrator integrator :
       {ArcIntegrator::kEuler, ArcIntegrator::kGauss2, ArcIntegrator::kGauss4,
        ArcIntegrator::kGauss6, ArcIntegrator::kRk4})
    for (CellLaw law : {CellLaw::kKirchhoff, CellLaw::kExtensibleStatic, CellLaw::kExtensible,
                        CellLaw::kKirchhoffFluid, CellLaw::kExtensibleFluid})
      for (bool rotary : {false, true})
        for (bool inertia : {false, true})
          for (bool body_rates : {false, true}) {
            // valid while k = 0, and nothing turns
            if (law == CellLaw::kExtensibleStatic && (inertia || rotary)) continue;
            if (!rotary && body_rates) continue;
            all.push_back({integrator, law, rotary, inertia, body_rates});
          }
  for (ArcIntegrator integrator : {ArcIntegrator::kGauss4, ArcIntegrator::kGauss6})
    for (CellLaw law : {CellLaw::kUnloaded, CellLaw::kUnloadedExtensible})
      all.push_back({integrator, law, false, false, false});
  return all;
}

TEST(Cell, ColumnsAreDerivativesOfTheEvaluation) {
  for (const Case& c : cases())
    for (int columns : {kNarrow, kWide}) {
      SCOPED_TRACE(c.name() + ", " + std::to_string(columns) + " columns");
      Cell cell = make_cell(c, 7);
      const NodeState end = cell.evaluate();
      const RowMatX Y0 = start_columns(columns, 11);
      const Linearized lin = linearize(cell, end, Y0);
      ASSERT_TRUE(lin.regular);
      MatX expected = MatX::Zero(cell.lifted() + 12, columns);
      expected.bottomRows<12>() = lin.Y;
      for (int i = 0; i < cell.lifted(); ++i)
        expected(i, columns == kNarrow ? 6 : 12) = -cell.residual(i);
      // differences of fourth order in steps of 1e-3 of columns of size 10: truncation 1e-9
      EXPECT_TRUE(jacobians_agree(expected, differences(cell, Y0, lin.dU), 1e-7, 1e-7));
    }
}

TEST(Cell, NarrowAndWideGiveTheSameBits) {
  for (const Case& c : cases()) {
    Cell cell = make_cell(c, 3);
    const NodeState end = cell.evaluate();
    const Linearized narrow = linearize(cell, end, start_columns(kNarrow, 5)),
                     wide = linearize(cell, end, start_columns(kWide, 5));
    for (int i = 0; i < 7; ++i) {
      const int j = i < 6 ? i : 12;
      EXPECT_EQ(narrow.Y.col(i), wide.Y.col(j)) << c.name() << ", column " << i;
      EXPECT_EQ(narrow.dU.col(i), wide.dU.col(j)) << c.name() << ", column " << i;
    }
  }
}

// Poses alone are integrated; what the other law finds for n and m follows from them.
TEST(Cell, WithoutLoadsFindsWhatTheOtherLawsFind) {
  for (ArcIntegrator integrator : {ArcIntegrator::kGauss4, ArcIntegrator::kGauss6})
    for (const auto& [unloaded, other] :
         {std::pair{CellLaw::kUnloaded, CellLaw::kKirchhoff},
          std::pair{CellLaw::kUnloadedExtensible, CellLaw::kExtensibleStatic}})
      for (int columns : {kNarrow, kWide}) {
        const Case c{integrator, unloaded, false, false, false};
        SCOPED_TRACE(c.name());
        Cell a = make_cell(c, 13), b = a;
        b.kernel = &cell_kernel(arc_tableau(integrator).stages, other);
        const NodeState at_a = a.evaluate(), at_b = b.evaluate();
        const Linearized of_a = linearize(a, at_a, start_columns(columns, 5)),
                         of_b = linearize(b, at_b, start_columns(columns, 5));
        constexpr double kRoundOff = 3e-14;  // of numbers near 1, columns near 10
        EXPECT_LT((rotation_of(at_a) - rotation_of(at_b)).norm(), kRoundOff);
        EXPECT_LT((position_of(at_a) - position_of(at_b)).norm(), kRoundOff);
        EXPECT_EQ(force_of(at_a), force_of(at_b));
        EXPECT_LT((moment_of(at_a) - moment_of(at_b)).norm(), kRoundOff);
        for (int i = 0; i < a.lifted(); ++i)
          EXPECT_NEAR(a.residual(i), b.residual(i), kRoundOff);
        EXPECT_LT((of_a.Y - of_b.Y).cwiseAbs().maxCoeff(), kRoundOff * of_b.Y.norm());
        EXPECT_LT((of_a.dU - of_b.dU).cwiseAbs().maxCoeff(), kRoundOff * of_b.dU.norm());
      }
}

TEST(Cell, PaddingStaysZero) {
  for (const Case& c : cases()) {
    Cell cell = make_cell(c, 3);
    const NodeState end = cell.evaluate();
    EXPECT_EQ(linearize(cell, end, start_columns(kNarrow, 5)).Y.col(7).norm(), 0);
    EXPECT_EQ(linearize(cell, end, start_columns(kWide, 5)).Y.rightCols<3>().norm(), 0);
  }
}

TEST(Cell, GaussRunBackwardsReturnsToTheStart) {
  for (const Case& c : cases()) {
    if (c.integrator == ArcIntegrator::kEuler || c.integrator == ArcIntegrator::kRk4) continue;
    // about one axis, where it does not matter from which section rotation vectors are counted
    Cell cell = make_cell(c, 9);
    for (CellStage& s : cell.stages)
      put(s.w, Vec3(0.3, -0.8, 0.5) * s.w[0]);
    const NodeState start = cell.start, end = cell.evaluate();
    Cell back = cell;
    back.start = end;
    back.model.h = -cell.model.h;
    std::reverse(back.stages.begin(), back.stages.end());
    std::reverse(back.fluid.begin(), back.fluid.end());
    const NodeState again = back.evaluate();
    constexpr double kRoundOff = 1e-14;  // of numbers near 1
    EXPECT_LT((rotation_of(again) - rotation_of(start)).norm(), kRoundOff) << c.name();
    EXPECT_LT((position_of(again) - position_of(start)).norm(), kRoundOff) << c.name();
    EXPECT_LT((force_of(again) - force_of(start)).norm(), kRoundOff) << c.name();
    EXPECT_LT((moment_of(again) - moment_of(start)).norm(), kRoundOff) << c.name();
  }
}

TEST(Cell, NanIsReportedAsSingular) {
  Cell cell = make_cell({ArcIntegrator::kGauss4, CellLaw::kKirchhoff, false, false, false}, 1);
  cell.stages[0].w[0] = std::nan("");
  const NodeState end = cell.evaluate();
  EXPECT_FALSE(linearize(cell, end, start_columns(kNarrow, 5)).regular);
  Cell unloaded = make_cell({ArcIntegrator::kGauss4, CellLaw::kUnloaded, false, false, false}, 1);
  unloaded.stages[0].w[0] = std::nan("");
  const NodeState unloaded_end = unloaded.evaluate();
  EXPECT_FALSE(linearize(unloaded, unloaded_end, start_columns(kNarrow, 5)).regular);
}

}  // namespace
}  // namespace cprsim
