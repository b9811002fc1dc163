// SPDX-License-Identifier: BSD-3-Clause
#include "tools/series/vibration.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace cprsim {

namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr std::size_t kSamples = 2048;  // even ones that the record is turned into, at most
constexpr double kPeriods = 3;          // in a record, at least
constexpr double kWindow = 4;           // periods that a decaying amplitude is taken over
constexpr double kShare = 0.1;          // of the mean square, in the strongest frequency
constexpr double kFaintest = 1e-2;      // of the largest amplitude: below, noise is fitted
constexpr std::size_t kFewestWindows = 4;
constexpr double kTail = 1e-3;  // of the sum of squares

/// Samples at even distances from the first on.
struct Record {
  double step = 0;
  std::vector<double> x;

  double duration() const { return step * static_cast<double>(x.size() - 1); }
};

Record evenly(const std::vector<double>& time, const std::vector<double>& value) {
  Record record;
  const std::size_t count = std::min(kSamples, time.size());
  record.step = (time.back() - time.front()) / static_cast<double>(count - 1);
  std::size_t k = 1;
  for (std::size_t i = 0; i < count; ++i) {
    const double t = std::min(time.front() + record.step * static_cast<double>(i), time.back());
    while (k + 1 < time.size() && time[k] < t)
      ++k;
    const double part = (t - time[k - 1]) / (time[k] - time[k - 1]);
    record.x.push_back((1 - part) * value[k - 1] + part * value[k]);
  }
  return record;
}

void take_out_line(Record& record) {
  const auto n = static_cast<double>(record.x.size());
  double mean = 0, moment = 0, square = 0;
  for (std::size_t i = 0; i < record.x.size(); ++i)
    mean += record.x[i] / n;
  for (std::size_t i = 0; i < record.x.size(); ++i) {
    const double s = static_cast<double>(i) - 0.5 * (n - 1);
    moment += s * (record.x[i] - mean);
    square += s * s;
  }
  for (std::size_t i = 0; i < record.x.size(); ++i)
    record.x[i] -= mean + moment / square * (static_cast<double>(i) - 0.5 * (n - 1));
}

/// Leaves out what follows once the motion has died down.
void take_off_tail(Record& record) {
  double all = 0, rest = 0;
  for (const double x : record.x)
    all += x * x;
  std::size_t end = record.x.size();
  while (end > 2 && (rest += record.x[end - 1] * record.x[end - 1]) < kTail * all)
    --end;
  record.x.resize(end);
}

/// |a| over samples [from, from + count).
double amplitude(const Record& record, double frequency, std::size_t from, std::size_t count) {
  const std::complex<double> turn = std::polar(1.0, -kTurn * frequency * record.step),
                             window_turn = std::polar(1.0, kTurn / static_cast<double>(count));
  std::complex<double> at = 1, window = std::polar(1.0, 0.5 * kTurn / static_cast<double>(count));
  std::complex<double> sum = 0;
  double weights = 0;
  for (std::size_t i = 0; i < count; ++i, at *= turn, window *= window_turn) {
    const double w = 1 - window.real();
    sum += w * record.x[from + i] * at;
    weights += w;
  }
  return 2 * std::abs(sum) / weights;
}

/// The frequency at which the whole record has its largest amplitude, Hz.
double strongest(const Record& record) {
  const double apart = 0.25 / record.duration();  // the window's main lobe is 16 of these wide
  const auto most = static_cast<int>(0.5 / (record.step * apart));
  double best = 0, largest = 0;
  for (int k = static_cast<int>(4 * kPeriods); k < most; ++k) {
    const double a = amplitude(record, k * apart, 0, record.x.size());
    if (a <= largest) continue;
    largest = a;
    best = k * apart;
  }
  if (best == 0) return 0;
  // golden section within the neighbours
  const double ratio = 0.5 * (std::sqrt(5.0) - 1);
  double low = best - apart, high = best + apart;
  while (high - low > 1e-9 * best) {
    const double a = high - ratio * (high - low), b = low + ratio * (high - low);
    if (amplitude(record, a, 0, record.x.size()) > amplitude(record, b, 0, record.x.size()))
      high = b;
    else
      low = a;
  }
  return 0.5 * (low + high);
}

/// -d log |a| / dt over short windows, by least squares.
std::optional<double> decay(const Record& record, double frequency) {
  const auto count = static_cast<std::size_t>(std::lround(kWindow / (frequency * record.step)));
  if (count < 8 || count > record.x.size() / 2) return std::nullopt;
  std::vector<double> t, a;
  const std::size_t shift = std::max<std::size_t>(1, count / 4);
  for (std::size_t from = 0; from + count <= record.x.size(); from += shift) {
    t.push_back(record.step * static_cast<double>(from));
    a.push_back(amplitude(record, frequency, from, count));
    if (a.back() < kFaintest * *std::max_element(a.begin(), a.end())) {
      t.pop_back();
      a.pop_back();
      break;
    }
  }
  if (a.size() < kFewestWindows) return std::nullopt;
  const auto n = static_cast<double>(a.size());
  double mean_t = 0, mean_log = 0, moment = 0, square = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    mean_t += t[i] / n;
    mean_log += std::log(a[i]) / n;
  }
  for (std::size_t i = 0; i < a.size(); ++i) {
    moment += (t[i] - mean_t) * (std::log(a[i]) - mean_log);
    square += (t[i] - mean_t) * (t[i] - mean_t);
  }
  return -moment / square;
}

}  // namespace

std::optional<Vibration> find_vibration(const std::vector<double>& time,
                                        const std::vector<double>& value) {
  if (time.size() < 4 * static_cast<std::size_t>(kPeriods) || !(time.back() > time.front()))
    return std::nullopt;
  Record record = evenly(time, value);
  take_out_line(record);
  take_off_tail(record);
  double square = 0;
  for (const double x : record.x)
    square += x * x / static_cast<double>(record.x.size());
  if (!(square > 0) || !std::isfinite(square)) return std::nullopt;
  Vibration found;
  found.frequency = strongest(record);
  if (found.frequency * record.duration() < kPeriods) return std::nullopt;
  found.amplitude = amplitude(record, found.frequency, 0, record.x.size());
  if (0.5 * found.amplitude * found.amplitude < kShare * square) return std::nullopt;
  if (const auto sigma = decay(record, found.frequency))
    found.damping_ratio = *sigma / std::hypot(*sigma, kTurn * found.frequency);
  return found;
}

}  // namespace cprsim
