// SPDX-License-Identifier: BSD-3-Clause
// How the nodes of a rod's grid move, as its contacts see it: with friction the slip (6) of
// engine/rod/contact.h asks for velocities v and turning rates w of nodes, whatever the method that
// finds where the nodes are. In dynamics w follows from the turn since the last step, which the
// time scheme integrates like any coordinate (equations of engine/robot/body.cpp); without rates
// slip is counted from where the nodes were when the last step was accepted.
#pragma once

#include <vector>

#include "engine/rod/contact.h"
#include "engine/time/scheme.h"

namespace cprsim {

class ContactMotion {
 public:
  /// @param nodes of the grid. Without friction nothing moves as contacts see it.
  void start(bool friction, std::size_t nodes);

  bool friction() const { return friction_; }

  /// Nodes as a step leaves them.
  void accept(const std::vector<NodeState>& nodes);

  /// @param velocity_history of the node: v = c_v p + this, read in dynamics only
  ContactNode at(std::size_t node, const NodeState& state, const StageRates& rates,
                 const Vec3& velocity_history) const;

  /// Turns of the nodes since the last step; null without friction.
  Track* turns() { return friction_ ? &turns_ : nullptr; }

  void fill_turns(const std::vector<NodeState>& nodes, const StageRates& rates);
  void start_turns();

  /// But for turns(), which are visited as all tracks are.
  void visit(Archive& archive);

 private:
  /// Turn since the last step and its rate, section axes.
  struct Turn {
    Vec3 theta, theta_t;
  };

  Turn turn_of(std::size_t node, const Mat3& R, const StageRates& rates) const;

  bool friction_ = false;
  std::vector<NodeState> accepted_;
  std::vector<Mat3> references_;  ///< axes of accepted_
  Track turns_{Track::Kind::kRotation};
};

/// W, taken out by contacts where a rod slips.
double friction_power(const std::vector<RodContact>& contacts,
                      const std::vector<ContactRows>& rows);

}  // namespace cprsim
