// SPDX-License-Identifier: BSD-3-Clause
// What a scene wants written down, and what it expects to come true.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/model/channel.h"
#include "engine/model/place.h"

namespace cprsim {

struct RecordSpec {
  Place place;
  double rate = 0;  ///< Hz; 0: every step
  std::string prefix;
  std::vector<Channel> channels;  ///< globs expanded, in order
  bool csv = false, hdf5 = false, npz = false;
  int vtk_every = 0;    ///< every n-th record; 0: no VTK
  double gltf_fps = 0;  ///< frames per simulated second, whatever the rate; 0: no glTF
};

enum class ExpectKind { kValue, kBound, kDrift, kMatch, kEvent, kConverged };
/// Something touches, nothing touches any more, a joint reaches a limit.
enum class EventKind { kContact, kSeparation, kLimit };

struct Expectation {
  ExpectKind kind = ExpectKind::kConverged;
  Place place;
  std::vector<Channel> channels;  ///< scalar channels it speaks of (a vector's components)
  double at = 0, from = 0;
  double to = -1;              ///< -1: the end
  std::vector<double> equals;  ///< one per channel
  std::optional<double> tolerance, above, below, min, max;
  std::string reference;                  ///< match: file of a trajectory
  std::optional<double> rms;              ///< match: beside max, the largest error allowed
  bool take_lag_out = false;              ///< match: the run may be late
  EventKind event = EventKind::kContact;  ///< must come about between `from` and `to`
};

struct ExpectSpec {
  std::string name;
  Place place;
  std::vector<Expectation> all;
};

}  // namespace cprsim
