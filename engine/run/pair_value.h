// SPDX-License-Identifier: BSD-3-Clause
// Channels of a pair that touches, contact(a,b).X.
#pragma once

#include "engine/model/channel.h"
#include "engine/run/snapshot.h"

namespace cprsim {

/// @throws std::invalid_argument if pairs have no such quantity.
double pair_value(const Channel& channel, const ContactSample& contact);

}  // namespace cprsim
