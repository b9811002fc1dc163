// SPDX-License-Identifier: BSD-3-Clause
// Forces between two rods stand in both rods' lists: in one as an unknown of the robot, in the
// other as its echo, with the sign changed. Contacts and ties alike.
#pragma once

#include "engine/robot/robot.h"

namespace cprsim {

/// In cells along its rod: points within a cell come after the node at its start.
double place_in_list(const RodContact& contact);

/// Base to tip; what has one place stays as it is.
void put_in_order(std::vector<RodContact>& contacts);

/// Forgets all echoes, makes them anew from what they are of, and puts the lists in order.
void mirror_contacts(Robot& robot);

/// The same where nothing left its cell and nothing came or went.
void update_echoes(Robot& robot);

}  // namespace cprsim
