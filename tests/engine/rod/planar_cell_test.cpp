// SPDX-License-Identifier: BSD-3-Clause
// The linearised planar cell against differences of its evaluation, and its evaluation against the
// spatial cell. Along column c of Y and dU,
//   start + eps Y0_c, lifted + eps dU_c:   residual' = 0 (the affine column: -residual),
//                                           end' = Y_c
#include "engine/rod/planar_cell.h"

#include <gtest/gtest.h>

#include <memory>

#include "engine/math/so3.h"
#include "engine/rod/planar_immersion.h"
#include "tests/engine/robot/sample_scenes.h"
#include "tests/support/finite_difference.h"

namespace cprsim {
namespace {

using RowMatX = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

struct Case {
  ArcIntegrator integrator;
  CellLaw law;
  bool inertia, rotary;

  std::string name() const {
    return std::string(arc_tableau(integrator).name) + ", law " +
           std::to_string(static_cast<int>(law)) + (inertia ? ", inertia" : "") +
           (rotary ? ", rotary" : "");
  }
};

/// Everything a kernel is given: numbers near 1, nothing zero, residuals far from zero.
struct Cell {
  PlanarModel model;
  std::vector<PlanarSection> sections;
  std::vector<PlanarStage> stages;
  PlanarNode start{};
  PlanarKernel kernel{};
  std::shared_ptr<PlanarImmersion> immersion;

  int lifted() const { return kernel.lifted; }

  double& unknown(int i) {
    const auto at = static_cast<std::size_t>(i), S = stages.size();
    return at < S ? stages[at].kappa : stages[(at - S) / 2].v[(at - S) % 2];
  }

  double residual(int i) const {
    const auto at = static_cast<std::size_t>(i), S = stages.size();
    return at < S ? stages[at].residual_kappa : stages[(at - S) / 2].residual_v[(at - S) % 2];
  }

  PlanarNode evaluate() {
    PlanarNode end{};
    kernel.evaluate(model, stages.data(), start, end);
    return end;
  }
};

Vec6 vector_of(const PlanarNode& node) {
  Vec6 v;
  v << node.theta, node.p[0], node.p[1], node.n[0], node.n[1], node.m;
  return v;
}

PlanarNode node_of(const Vec6& v) {
  return {v[0], {v[1], v[2]}, {v[3], v[4]}, v[5], std::cos(v[0]), std::sin(v[0])};
}

/// A current, what follows the sections, springs, a dipole and a magnetisation in the plane.
void immerse(Cell& cell, Numbers& numbers) {
  const std::size_t S = cell.stages.size();
  const Mat3 plane = exp_so3({0.3, -0.7, 1.1});
  Mat3 offset;
  offset << 0, 0, 1, 1, 0, 0, 0, 1, 0;  // tangent along e1, x along e2
  const double height = 0.3;
  cell.immersion = std::make_shared<PlanarImmersion>(S, plane, offset, height);
  cell.immersion->in_space().place(std::vector<double>(S, 0.5), {{0, 1, {0.4, 0, 0.7}}});
  SectionProperties section;
  section.fluid = {0.8, 0.3, 0.6, 0.9};
  StageRates rates;
  rates.c_v = 1.3;
  rates.c_w = 0.7;
  RodForcing forcing;
  forcing.wind = plane * Vec3(3, -2, 0);
  LineLoad follower{0, 1, Vec3(0.6, 0, -0.4), Vec3(0, 0.5, 0), true, {}},
      springs{0, 1, Vec3::Zero(), Vec3::Zero(), false, {}};
  springs.law.law = 0;
  springs.law.values[0] = 1.7;
  Eigen::Map<Vec3>{springs.law.values + 4} = plane * Vec3(0.6, 0.8, 0);
  forcing.lines = {follower, springs};
  const Vec3 at = plane * Vec3(6, -5, height), moment = plane * Vec3(4e8, 3e8, 0);
  forcing.field.uniform = plane * Vec3(0.4, -0.3, 0);
  forcing.field.dipoles.push_back({{at.x(), at.y(), at.z()}, {moment.x(), moment.y(), moment.z()}});
  Track track;
  track.resize(2 * static_cast<Eigen::Index>(S));
  for (VecX* each : {&track.x_h, &track.v_h})
    for (double& x : *each)
      x = numbers.next();
  cell.immersion->prepare(section, rates, forcing, track);
  cell.model.immersion = cell.immersion.get();
  cell.model.around = cell.immersion->at(0);
}

Cell make_cell(const Case& c, unsigned seed) {
  Numbers numbers(seed);
  Cell cell;
  const ArcTableau& table = arc_tableau(c.integrator);
  cell.kernel = planar_kernel(table.stages, c.law);
  cell.model.table = &table;
  cell.model.h = 0.4;
  cell.model.C_b = 1.1;
  cell.model.C_v[0] = 0.05;
  cell.model.C_v[1] = 0.09;
  cell.model.k = c.inertia ? 2.5 : 0;
  cell.model.k_J = c.rotary ? 0.7 : 0;
  cell.sections.assign(static_cast<std::size_t>(table.stages), cell.model);
  cell.model.sections = cell.sections.data();
  cell.start = node_of(numbers.vec6());
  cell.stages.assign(static_cast<std::size_t>(table.stages), PlanarStage{});
  for (PlanarStage& s : cell.stages) {
    s.kappa0 = numbers.next();
    s.kappa = 2 * numbers.next();
    for (int i = 0; i < 2; ++i) {
      s.b[i] = numbers.next();
      s.v0[i] = (i == 0 ? 1 : 0) + 0.2 * numbers.next();
      s.v[i] = (i == 0 ? 1 : 0) + 0.2 * numbers.next();
    }
    s.b_J = numbers.next();
  }
  if (immersed(c.law)) immerse(cell, numbers);
  return cell;
}

RowMatX start_columns(int columns) {
  Numbers numbers(11);
  RowMatX Y = RowMatX::Zero(6, columns);
  // the shared columns first, so that both widths get the same ones
  for (int c : {0, 1, 2})
    Y.col(c) = numbers.vec6();
  Y.col(columns == kPlanarNarrow ? 3 : 6) = numbers.vec6();
  if (columns == kPlanarWide)
    for (int c : {3, 4, 5})
      Y.col(c) = numbers.vec6();
  return Y;
}

struct Linearized {
  RowMatX Y, dU;
  bool regular;
};

Linearized linearize(const Cell& cell, const RowMatX& Y0) {
  Linearized out{Y0, RowMatX::Zero(cell.lifted(), Y0.cols()), false};
  const auto f =
      Y0.cols() == kPlanarNarrow ? cell.kernel.linearize_narrow : cell.kernel.linearize_wide;
  out.regular = f(cell.model, cell.stages.data(), out.Y.data(), out.dU.data());
  return out;
}

/// Columns of residuals and end state by differences.
MatX differences(const Cell& cell, const RowMatX& Y0, const RowMatX& dU) {
  const auto f = [](Cell at) -> VecX {
    const PlanarNode end = at.evaluate();
    VecX values(at.lifted() + 6);
    for (int i = 0; i < at.lifted(); ++i)
      values[i] = at.residual(i);
    values.tail<6>() = vector_of(end);
    return values;
  };
  const auto increment = [&](Cell at, const VecX& d) {
    at.start = node_of(vector_of(at.start) + Y0 * d);
    const VecX u = dU * d;
    for (int i = 0; i < at.lifted(); ++i)
      at.unknown(i) += u[i];
    return at;
  };
  return difference_jacobian(f, cell, static_cast<int>(Y0.cols()), increment);
}

constexpr ArcIntegrator kIntegrators[] = {ArcIntegrator::kEuler, ArcIntegrator::kGauss2,
                                          ArcIntegrator::kGauss4, ArcIntegrator::kGauss6,
                                          ArcIntegrator::kRk4};

std::vector<Case> cases() {
  std::vector<Case> all;
  for (ArcIntegrator integrator : kIntegrators)
    for (CellLaw law : {CellLaw::kKirchhoff, CellLaw::kExtensibleStatic, CellLaw::kExtensible})
      for (bool inertia : {false, true})
        for (bool rotary : {false, true})
          if (law != CellLaw::kExtensibleStatic || !inertia)  // valid while k = 0
            all.push_back({integrator, law, inertia, rotary});
  return all;
}

/// And those with something around them.
std::vector<Case> all_cases() {
  std::vector<Case> all = cases();
  for (ArcIntegrator integrator : kIntegrators)
    for (CellLaw law : {CellLaw::kKirchhoffFluid, CellLaw::kExtensibleFluid})
      for (bool inertia : {false, true})
        all.push_back({integrator, law, inertia, inertia});
  return all;
}

TEST(PlanarCell, ColumnsAreDerivativesOfTheEvaluation) {
  for (const Case& c : all_cases())
    for (int columns : {kPlanarNarrow, kPlanarWide}) {
      SCOPED_TRACE(c.name() + ", " + std::to_string(columns) + " columns");
      Cell cell = make_cell(c, 7);
      double more = 1;
      for (PlanarSection& section : cell.sections) {
        for (double* of : {&section.C_b, section.C_v, section.C_v + 1, &section.k, &section.k_J})
          *of *= more;
        more += 0.2;
      }
      cell.evaluate();
      const RowMatX Y0 = start_columns(columns);
      const Linearized lin = linearize(cell, Y0);
      ASSERT_TRUE(lin.regular);
      MatX expected = MatX::Zero(cell.lifted() + 6, columns);
      expected.bottomRows<6>() = lin.Y;
      for (int i = 0; i < cell.lifted(); ++i)
        expected(i, columns == kPlanarNarrow ? 3 : 6) = -cell.residual(i);
      // differences of fourth order in steps of 1e-3 of columns of size 10: truncation 1e-9
      EXPECT_TRUE(jacobians_agree(expected, differences(cell, Y0, lin.dU), 1e-7, 1e-7));
    }
}

TEST(PlanarCell, NarrowAndWideAgree) {
  for (const Case& c : cases()) {
    Cell cell = make_cell(c, 3);
    cell.evaluate();
    const Linearized narrow = linearize(cell, start_columns(kPlanarNarrow)),
                     wide = linearize(cell, start_columns(kPlanarWide));
    for (int i = 0; i < 4; ++i) {
      const int j = i < 3 ? i : 6;
      EXPECT_EQ(narrow.Y.col(i), wide.Y.col(j)) << c.name() << ", column " << i;
      EXPECT_EQ(narrow.dU.col(i), wide.dU.col(j)) << c.name() << ", column " << i;
    }
    EXPECT_EQ(wide.Y.col(7).norm(), 0) << c.name();
  }
}

// The same cell in space, the plane's normal along x and the tangent along z at theta = 0: section
// axes x, y, z are the normal, and d = -y.
TEST(PlanarCell, EvaluatesWhatTheSpatialCellDoes) {
  for (const Case& c : cases()) {
    if (c.rotary) continue;  // written differently; tests/laws/planar_test.cpp compares motions
    SCOPED_TRACE(c.name());
    Cell cell = make_cell(c, 5);
    const PlanarNode end = cell.evaluate();
    const auto in_space = [](double* to, const double* v) {
      to[0] = 0;
      to[1] = -v[1];
      to[2] = v[0];
    };
    CellModel M;
    M.table = cell.model.table;
    M.h = cell.model.h;
    M.C_bt[0] = M.C_bt[1] = M.C_bt[2] = cell.model.C_b;
    M.C_se[1] = cell.model.C_v[1];
    M.C_se[2] = cell.model.C_v[0];
    M.k = cell.model.k;
    std::vector<CellStage> stages(cell.stages.size());
    for (std::size_t j = 0; j < stages.size(); ++j) {
      stages[j].u0[0] = cell.stages[j].kappa0;
      stages[j].w[0] = cell.stages[j].kappa;
      in_space(stages[j].v0, cell.stages[j].v0);
      in_space(stages[j].v, cell.stages[j].v);
      in_space(stages[j].b, cell.stages[j].b);
    }
    const auto node_in_space = [&](const PlanarNode& node) {
      NodeState out{};
      const double R[9] = {1, 0, 0, 0, node.c, -node.s, 0, node.s, node.c};
      std::copy_n(R, 9, out.R);
      in_space(out.p, node.p);
      in_space(out.n, node.n);
      out.m[0] = node.m;
      return out;
    };
    NodeState spatial_end;
    for (CellStage& s : stages)
      s.b[0] = 0;
    cell_kernel(static_cast<int>(stages.size()), c.law)
        .evaluate(M, stages.data(), node_in_space(cell.start), spatial_end);
    // the stages' b_J is a moment that the spatial cell does not have
    double moment = 0;
    for (std::size_t j = 0; j < stages.size(); ++j)
      moment += M.h * M.table->b[j] * cell.stages[j].b_J;
    NodeState expected = node_in_space(end);
    expected.m[0] -= moment;
    constexpr double kRoundOff = 1e-14;
    for (int i = 0; i < 9; ++i)
      EXPECT_NEAR(spatial_end.R[i], expected.R[i], kRoundOff);
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(spatial_end.p[i], expected.p[i], kRoundOff);
      EXPECT_NEAR(spatial_end.n[i], expected.n[i], kRoundOff);
      EXPECT_NEAR(spatial_end.m[i], expected.m[i], kRoundOff);
    }
  }
}

TEST(PlanarCell, EveryCopyGivesTheSameBits) {
  for (const Case& c : all_cases())
    for (unsigned seed = 1; seed <= 20; ++seed) {
      Cell cell = make_cell(c, seed);
      cell.evaluate();
      const int stages = static_cast<int>(cell.stages.size());
      for (int columns : {kPlanarNarrow, kPlanarWide}) {
        cell.kernel = planar_kernel_copy(0, stages, c.law);
        const Linearized first = linearize(cell, start_columns(columns));
        for (int copy = 1; copy < planar_kernel_copies(); ++copy) {
          cell.kernel = planar_kernel_copy(copy, stages, c.law);
          const Linearized other = linearize(cell, start_columns(columns));
          EXPECT_EQ(first.Y, other.Y) << c.name() << ", copy " << copy;
          EXPECT_EQ(first.dU, other.dU) << c.name() << ", copy " << copy;
        }
      }
    }
}

TEST(PlanarCell, NanIsReportedAsSingular) {
  Cell cell = make_cell({ArcIntegrator::kGauss4, CellLaw::kKirchhoff, false, false}, 1);
  cell.stages[0].kappa = std::nan("");
  cell.evaluate();
  EXPECT_FALSE(linearize(cell, start_columns(kPlanarNarrow)).regular);
}

}  // namespace
}  // namespace cprsim
