// SPDX-License-Identifier: BSD-3-Clause
// Natural frequencies of Euler-Bernoulli beams clamped at one end and free at the other:
//   (1) cos β cosh β = -1      (2) ω = β² √(EI / ρA L⁴)
#pragma once

namespace cprsim {

/// The root β of (1) of mode 1, 2, ...: 1.8751..., 4.6941..., 7.8548..., to the last bit or two.
double clamped_free_root(int mode);

/// (2) in rad/s.
double clamped_free_frequency(int mode, double EI, double rhoA, double length);

}  // namespace cprsim
