// SPDX-License-Identifier: BSD-3-Clause
// Runge-Kutta tables in time. Their order conditions are tested, with those of the embedded
// formulas. The embedded weights of sdirk3 are those of the second-order formula on its first two
// stages.
#include <algorithm>
#include <cmath>

#include "engine/time/scheme.h"

namespace cprsim {
namespace {

/// Fills c, the diagonal and b - b_embedded from a and the embedded weights.
DirkTable finished(DirkTable t, const double* embedded) {
  const int last = t.stages - 1;
  for (int i = 0; i < t.stages; ++i) {
    t.c[i] = 0;
    for (int j = 0; j <= i; ++j)
      t.c[i] += t.a[i][j];
    t.b_error[i] = t.a[last][i] - embedded[i];
  }
  t.diagonal = t.a[last][last];
  return t;
}

DirkTable named(const char* name, int stages, int order, int embedded_order, bool explicit_first) {
  DirkTable t;
  t.name = name;
  t.stages = stages;
  t.order = order;
  t.embedded_order = embedded_order;
  t.explicit_first = explicit_first;
  return t;
}

void set_row(DirkTable& t, int i, std::initializer_list<double> row) {
  int j = 0;
  for (double value : row)
    t.a[i][j++] = value;
}

// Third-order companion of TR-BDF2: Hosea & Shampine, Appl. Numer. Math. 20 (1996).
DirkTable make_tr_bdf2() {
  const double d = 1 - std::sqrt(0.5), w = std::sqrt(2.0) / 4;
  DirkTable t = named("tr_bdf2", 3, 2, 2, true);
  set_row(t, 1, {d, d});
  set_row(t, 2, {w, w, d});
  const double embedded[] = {(1 - w) / 3, (3 * w + 1) / 3, d / 3};
  return finished(t, embedded);
}

constexpr double kGamma3 =
    0.43586652150845899942;  // root of 6 g³ - 18 g² + 9 g - 1, L-stability at order 3

DirkTable make_esdirk32() {
  const double g = kGamma3, c2 = 2 * g, c3 = 0.6;
  DirkTable t = named("esdirk32", 4, 3, 2, true);
  const double a32 = c3 * (c3 - 2 * g) / (4 * g);  // stage order 2
  const double r1 = 0.5 - g, r2 = 1. / 3 - g;  // quadrature conditions left after b4 = g, c4 = 1
  const double b3 = (r2 - c2 * r1) / (c3 * (c3 - c2)), b2 = (r1 - b3 * c3) / c2;
  set_row(t, 1, {g, g});
  set_row(t, 2, {c3 - g - a32, a32, g});
  set_row(t, 3, {1 - g - b2 - b3, b2, b3, g});
  const double embedded[] = {2756255671327. / 12835298489170., -10771552573575. / 22201958757719.,
                             9247589265047. / 10645013368117., 2193209047091. / 5459859503100.};
  return finished(t, embedded);
}

DirkTable make_esdirk43() {
  DirkTable t = named("esdirk43", 6, 4, 3, true);
  set_row(t, 1, {0.25, 0.25});
  set_row(t, 2, {8611. / 62500, -1743. / 31250, 0.25});
  set_row(t, 3, {5012029. / 34652500, -654441. / 2922500, 174375. / 388108, 0.25});
  set_row(t, 4,
          {15267082809. / 155376265600., -71443401. / 120774400, 730878875. / 902184768,
           2285395. / 8070912, 0.25});
  set_row(t, 5, {82889. / 524892, 0, 15625. / 83664, 69875. / 102672, -2260. / 8211, 0.25});
  const double embedded[] = {4586570599. / 29645900160., 0,
                             178811875. / 945068544,     814220225. / 1159782912,
                             -3700637. / 11593932,       61727. / 225920};
  return finished(t, embedded);
}

DirkTable make_sdirk3() {
  const double g = kGamma3;
  DirkTable t = named("sdirk3", 3, 3, 2, false);
  set_row(t, 0, {g});
  set_row(t, 1, {(1 - g) / 2, g});
  set_row(t, 2, {-(6 * g * g - 16 * g + 1) / 4, (6 * g * g - 20 * g + 5) / 4, g});
  const double e2 = (0.5 - g) / ((1 - g) / 2);
  const double embedded[] = {1 - e2, e2, 0};
  return finished(t, embedded);
}

RadauTable make_radau5() {
  const double r = std::sqrt(6.0);
  RadauTable t{{{(88 - 7 * r) / 360, (296 - 169 * r) / 1800, (-2 + 3 * r) / 225},
                {(296 + 169 * r) / 1800, (88 + 7 * r) / 360, (-2 - 3 * r) / 225},
                {(16 - r) / 36, (16 + r) / 36, 1. / 9}},
               {},
               {(4 - r) / 10, (4 + r) / 10, 1}};
  double upper[3][3] = {};
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) {
      double rest = t.a[i][j];
      for (int k = 0; k < std::min(i, j); ++k)
        rest -= t.lower[i][k] * upper[k][j];
      if (i >= j)
        t.lower[i][j] = rest;
      else
        upper[i][j] = rest / t.lower[i][i];
    }
    upper[j][j] = 1;
  }
  return t;
}

}  // namespace

const RadauTable& radau5() {
  static const RadauTable table = make_radau5();
  return table;
}

const DirkTable& tr_bdf2() {
  static const DirkTable table = make_tr_bdf2();
  return table;
}

const DirkTable& esdirk32() {
  static const DirkTable table = make_esdirk32();
  return table;
}

const DirkTable& esdirk43() {
  static const DirkTable table = make_esdirk43();
  return table;
}

const DirkTable& sdirk3() {
  static const DirkTable table = make_sdirk3();
  return table;
}

}  // namespace cprsim
