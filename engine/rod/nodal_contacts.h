// SPDX-License-Identifier: BSD-3-Clause
// The touching side of a rod whose method takes contacts as what their equivalents (2) of
// engine/rod/contact.h are: forces and moments at the nodes of its grid. It keeps the points, says
// what acts at a node and how that changes with the node's turn and with the forces
//   M_k = sum over points (h G_a t_k × f + S_a l × f),   dM_k = h G_a (phi × t_k) × f + ...  (1)
// and how nodes move where there is friction. All forces are unknowns of the robot, those from what
// stands still, too: a rod answers for them by its OpenPorts and needs no rows of its own.
#pragma once

#include <vector>

#include "engine/rod/contact_motion.h"
#include "engine/rod/rod_model.h"

namespace cprsim {

/// What the rod says of itself to its contacts.
class ContactHost {
 public:
  virtual ~ContactHost() = default;

  virtual const std::vector<NodeState>& grid_nodes() const = 0;
  virtual const std::vector<double>& node_grid() const = 0;  ///< s / L
  virtual double rod_length() const = 0;
  virtual const StageRates& stage_rates() const = 0;
  /// v = c_v p + this, in dynamics.
  virtual Vec3 velocity_history(std::size_t node) const = 0;
  virtual ContactScale scale_of_contacts() const = 0;
};

class NodalContacts final : public TouchingRod {
 public:
  using ByForces = Eigen::Matrix<double, 6, Eigen::Dynamic>;

  explicit NodalContacts(const ContactHost& host) : host_(host) {}

  const std::vector<NodeState>& contact_nodes() const override { return host_.grid_nodes(); }

  const std::vector<double>& contact_grid() const override { return host_.node_grid(); }

  void set_surfaces(const std::vector<Surface>& surfaces, double radius, bool friction) override;

  const std::vector<Surface>& surfaces() const override { return surfaces_; }

  bool may_touch() const override { return given_; }

  bool owns_forces() const override { return false; }

  std::vector<RodContact>& contacts() override { return contacts_; }

  const std::vector<RodContact>& contacts() const { return contacts_; }

  std::vector<ContactRows>& contact_state() override { return rows_; }

  ContactEnds contact_ends(std::size_t contact) const override;

  ContactScale contact_scale() const override { return host_.scale_of_contacts(); }

  const OpenPorts& open_ports() const override { return ports_; }

  void set_open_direction(const VecX& forces) override { direction_ = forces; }

  void accept_contacts() override;

  /// Of the forces of all contacts, in their order.
  Eigen::Index columns() const { return 3 * static_cast<Eigen::Index>(contacts_.size()); }

  /// Force and moment that all contacts leave at a node whose axes are R, world axes.
  Vec6 load_at(std::size_t node, const Mat3& R) const;
  /// Its moment by the node's turn phi.
  Mat3 moment_by_turn(std::size_t node, const Mat3& R) const;
  /// Force and moment by the forces, in the order of columns().
  ByForces load_by_forces(std::size_t node, const Mat3& R) const;

  /// For the rows that are formed elsewhere: one for each contact.
  void begin_rows();

  /// @param moves (phi, dp) of each node by [z; zeta_A; 1; F], and by more, which `rest` takes, a
  /// matrix for each contact; T_F, WA_F, WB_F are the rod's to fill
  void describe_motions(const std::vector<MatX>& moves, std::vector<MatX>* rest = nullptr);

  OpenPorts& ports() { return ports_; }

  const VecX& direction() const { return direction_; }

  void keep();
  void move(double alpha);
  void visit(Archive& archive);

  void set_contacts(const std::vector<RodContact>& contacts) { contacts_ = contacts; }

  /// Turns of the nodes since the last step, with friction.
  Track* turns() { return motion_.turns(); }

  void fill_turns();

  void start_turns() { motion_.start_turns(); }

  /// W, taken out by friction.
  double friction_power() const;

 private:
  ContactNode node(std::size_t k) const;
  double cell_length(std::size_t cell) const;
  template <class Visit>
  void at_node(std::size_t node, Visit visit) const;

  const ContactHost& host_;
  bool given_ = false;
  std::vector<Surface> surfaces_;
  double radius_ = 0;
  std::vector<RodContact> contacts_;
  std::vector<ContactRows> rows_;
  ContactMotion motion_;
  std::vector<Vec3> kept_;
  OpenPorts ports_;
  VecX direction_;
};

}  // namespace cprsim
