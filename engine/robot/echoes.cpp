// SPDX-License-Identifier: BSD-3-Clause
#include "engine/robot/echoes.h"

#include <algorithm>

namespace cprsim {
namespace {

std::vector<RodContact>* list_of(Robot& robot, std::size_t rod) {
  TouchingRod* side = robot.rods[rod].model->touching();
  return side && side->may_touch() ? &side->contacts() : nullptr;
}

RodContact echo_of(const RodContact& contact, std::size_t rod) {
  RodContact echo;
  echo.role = ContactRole::kEcho;
  echo.other_rod = static_cast<int>(rod);
  echo.partner = contact.partner;
  echo.cell = contact.other_cell;
  echo.xi = contact.other_xi;
  echo.lever = contact.other_lever;
  echo.force = -contact.force;
  if (contact.grip == Grip::kTie) echo.grip = Grip::kTie;
  return echo;
}

}  // namespace

double place_in_list(const RodContact& contact) {
  return static_cast<double>(contact.cell) + (contact.at_node() ? 0 : 0.5);
}

void put_in_order(std::vector<RodContact>& contacts) {
  std::stable_sort(contacts.begin(), contacts.end(), [](const RodContact& a, const RodContact& b) {
    return place_in_list(a) < place_in_list(b);
  });
}

void mirror_contacts(Robot& robot) {
  std::vector<std::vector<RodContact>*> lists;
  for (std::size_t r = 0; r < robot.rods.size(); ++r) {
    lists.push_back(list_of(robot, r));
    if (!lists[r]) continue;
    lists[r]->erase(
        std::remove_if(lists[r]->begin(), lists[r]->end(),
                       [](const RodContact& c) { return c.role == ContactRole::kEcho; }),
        lists[r]->end());
    put_in_order(*lists[r]);
  }
  // both entries get the same number first
  int count = 0;
  std::vector<std::vector<RodContact>> echoes(lists.size());
  for (std::size_t r = 0; r < lists.size(); ++r)
    for (std::size_t i = 0; lists[r] && i < lists[r]->size(); ++i) {
      RodContact& own = (*lists[r])[i];
      if (own.role != ContactRole::kShared || own.other_rod < 0) continue;
      own.partner = count++;
      echoes[static_cast<std::size_t>(own.other_rod)].push_back(echo_of(own, r));
    }
  std::vector<int> own_entry(static_cast<std::size_t>(count)), echo_entry(own_entry);
  const auto entry = [&](const RodContact& contact, bool echo) -> int& {
    return (echo ? echo_entry : own_entry)[static_cast<std::size_t>(contact.partner)];
  };
  for (std::size_t r = 0; r < lists.size(); ++r) {
    if (!lists[r]) continue;
    lists[r]->insert(lists[r]->end(), echoes[r].begin(), echoes[r].end());
    put_in_order(*lists[r]);
    for (std::size_t i = 0; i < lists[r]->size(); ++i) {
      const RodContact& contact = (*lists[r])[i];
      if (contact.partner >= 0)
        entry(contact, contact.role == ContactRole::kEcho) = static_cast<int>(i);
    }
  }
  for (std::vector<RodContact>* list : lists)
    for (std::size_t i = 0; list && i < list->size(); ++i) {
      RodContact& contact = (*list)[i];
      if (contact.partner >= 0)
        contact.partner = entry(contact, contact.role != ContactRole::kEcho);
    }
}

void update_echoes(Robot& robot) {
  for (std::size_t r = 0; r < robot.rods.size(); ++r) {
    std::vector<RodContact>* list = list_of(robot, r);
    for (std::size_t i = 0; list && i < list->size(); ++i) {
      RodContact& echo = (*list)[i];
      if (echo.role != ContactRole::kEcho) continue;
      const std::vector<RodContact>& others =
          *list_of(robot, static_cast<std::size_t>(echo.other_rod));
      const RodContact& contact = others[static_cast<std::size_t>(echo.partner)];
      echo.xi = contact.other_xi;
      echo.lever = contact.other_lever;
    }
  }
}

}  // namespace cprsim
