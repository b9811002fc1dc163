// SPDX-License-Identifier: BSD-3-Clause
// Targets: poses to which `cprsim solve` brings a frame.
#include <algorithm>
#include <numeric>

#include "scenes/loader/reading.h"
#include "scenes/loader/suggest.h"
#include "scenes/loader/values.h"

namespace cprsim {

namespace {

void read_freedoms(Reading& r, const Node& node, TargetSpec& target) {
  const Attribute* attribute = node.attribute("freedoms");
  if (!attribute) return;
  const std::vector<std::string> names = {"x", "y", "z", "roll", "pitch", "yaw"};
  target.asked.fill(false);
  for (const std::string_view text : split_words(attribute->value)) {
    const std::string word(text);
    const auto found = std::find(names.begin(), names.end(), word);
    if (found == names.end())
      r.report.bad_value("E307", node, *attribute, "'" + word + "' is not a freedom of a frame",
                         "x y z roll pitch yaw");
    else
      target.asked[static_cast<std::size_t>(found - names.begin())] = true;
  }
  if (std::none_of(target.asked.begin(), target.asked.end(), [](bool asked) { return asked; }))
    r.report.bad_value("E305", node, *attribute, "a target prescribes at least one freedom",
                       "x y z roll pitch yaw");
}

/// Drives of a joint or rod; a joint may have several.
std::vector<int> drives_of(const Reading& r, const Named& named) {
  std::vector<int> list;
  const auto joint = named.kind == FrameKind::kJoint ? r.joint_of_vertex.find(named.index)
                                                     : r.joint_of_vertex.end();
  for (std::size_t i = 0; i < r.scene.drives.size(); ++i) {
    const DriveSpec& drive = r.scene.drives[i];
    if (drive.quantity == DriveQuantity::kEffort) continue;
    if ((named.kind == FrameKind::kRod && drive.rod == named.index) ||
        (joint != r.joint_of_vertex.end() && drive.joint == joint->second))
      list.push_back(static_cast<int>(i));
  }
  return list;
}

void read_drives(Reading& r, const Node& node, int scope, TargetSpec& target) {
  const Attribute* attribute = node.attribute("free");
  if (!attribute) {
    target.drives.resize(r.scene.drives.size());
    std::iota(target.drives.begin(), target.drives.end(), 0);
    return;
  }
  for (const std::string_view text : split_words(attribute->value)) {
    const std::string word(text);
    const auto named = r.frames.find_outwards(scope, word);
    const std::vector<int> drives = named ? drives_of(r, *named) : std::vector<int>{};
    if (!named)
      r.report.bad_value("E403", node, *attribute, "there is no joint or rod '" + word + "'",
                         mean(nearest_name(word, r.frames.known_names(scope))));
    else if (drives.empty())
      r.report.bad_value("E310", node, *attribute, "'" + word + "' has no drive that could change",
                         "a <cprsim:drive> of it, of position, velocity or length");
    target.drives.insert(target.drives.end(), drives.begin(), drives.end());
  }
}

void read_target(Reading& r, const Node& node, int scope) {
  TargetSpec target;
  target.place = node.place;
  const Attribute& name = *node.attribute("frame");
  const auto found = r.frames.find_outwards(scope, name.value);
  if (!found || found->kind == FrameKind::kRod || found->kind == FrameKind::kRoot) {
    r.report.bad_value("E403", node, name, "there is no link or frame '" + name.value + "'",
                       mean(nearest_name(name.value, r.frames.known_names(scope))));
    return;
  }
  target.at = r.frames.frame_ref(found->index);
  const FrameScope& around = r.frames.scopes()[static_cast<std::size_t>(scope)];
  target.X_WT = r.frames.posed(node, scope, around.self);
  read_freedoms(r, node, target);
  read_drives(r, node, scope, target);
  if (target.drives.empty() && !node.attribute("free"))
    r.report.error("E310", node, "nothing is driven that could bring " + name.value + " there");
  r.scene.targets.push_back(std::move(target));
}

}  // namespace

void read_targets(Reading& r) {
  for_each_scope(r, [&](int scope, const Node& node) {
    for (const Node* target : node.all("cprsim:target"))
      read_target(r, *target, scope);
  });
}

}  // namespace cprsim
