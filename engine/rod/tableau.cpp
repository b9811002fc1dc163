// SPDX-License-Identifier: BSD-3-Clause
#include "engine/rod/tableau.h"

namespace cprsim {
namespace {

constexpr double kSqrt3 = 1.7320508075688772935;
constexpr double kSqrt15 = 3.8729833462074168852;

constexpr ArcTableau kEuler{1, 1, {{0}}, {1}, {0}, "euler"};
constexpr ArcTableau kGauss2{1, 2, {{0.5}}, {1}, {0.5}, "gauss2"};
constexpr ArcTableau kGauss4{2,
                             4,
                             {{0.25, 0.25 - kSqrt3 / 6}, {0.25 + kSqrt3 / 6, 0.25}},
                             {0.5, 0.5},
                             {0.5 - kSqrt3 / 6, 0.5 + kSqrt3 / 6},
                             "gauss4"};
constexpr ArcTableau kGauss6{3,
                             6,
                             {{5. / 36, 2. / 9 - kSqrt15 / 15, 5. / 36 - kSqrt15 / 30},
                              {5. / 36 + kSqrt15 / 24, 2. / 9, 5. / 36 - kSqrt15 / 24},
                              {5. / 36 + kSqrt15 / 30, 2. / 9 + kSqrt15 / 15, 5. / 36}},
                             {5. / 18, 4. / 9, 5. / 18},
                             {0.5 - kSqrt15 / 10, 0.5, 0.5 + kSqrt15 / 10},
                             "gauss6"};
constexpr ArcTableau kRk4{4,
                          4,
                          {{0, 0, 0, 0}, {0.5, 0, 0, 0}, {0, 0.5, 0, 0}, {0, 0, 1, 0}},
                          {1. / 6, 1. / 3, 1. / 3, 1. / 6},
                          {0, 0.5, 0.5, 1},
                          "rk4"};

}  // namespace

const ArcTableau& arc_tableau(ArcIntegrator integrator) {
  switch (integrator) {
    case ArcIntegrator::kEuler:
      return kEuler;
    case ArcIntegrator::kRk4:
      return kRk4;
    case ArcIntegrator::kGauss2:
      return kGauss2;
    case ArcIntegrator::kGauss6:
      return kGauss6;
    case ArcIntegrator::kGauss4:
      break;
  }
  return kGauss4;
}

}  // namespace cprsim
