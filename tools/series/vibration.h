// SPDX-License-Identifier: BSD-3-Clause
// How something vibrates, from samples: the strongest frequency, its amplitude, how fast it decays.
// With a = sum_k w_k x(t_k) exp(-i omega t_k) over a Hann window w whose weights add up to 2, |a|
// is the amplitude of a harmonic motion of the frequency omega / 2 pi. It is largest at the
// strongest one; taken over short windows along the record it falls like exp(-sigma t), and
//   zeta = sigma / sqrt(sigma² + omega²)                                                       (1)
// is the damping ratio (the logarithmic decrement over one period is 2 pi zeta / sqrt(1 - zeta²)).
// Source: Harris, "On the use of windows for harmonic analysis with the discrete Fourier
// transform", Proc. IEEE 66 (1978), for the window.
#pragma once

#include <optional>
#include <vector>

namespace cprsim {

struct Vibration {
  double frequency = 0;                 ///< Hz, of the damped motion
  double amplitude = 0;                 ///< mean over the record, in the unit of the values
  std::optional<double> damping_ratio;  ///< (1); nothing where fewer than eight periods are there
};

/// @param time increasing, s; need not be even
/// @param value one each; a straight line through them is taken out first
/// @return nothing if less than three periods were seen, or no frequency stands out: it holds less
/// than a tenth of the mean square
std::optional<Vibration> find_vibration(const std::vector<double>& time,
                                        const std::vector<double>& value);

}  // namespace cprsim
