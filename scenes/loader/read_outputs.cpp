// SPDX-License-Identifier: BSD-3-Clause
// Videos and records; expectations and sweeps are read in files of their own.
#include <algorithm>

#include "scenes/loader/reading.h"
#include "scenes/loader/schema.h"
#include "scenes/loader/suggest.h"
#include "scenes/loader/values.h"

namespace cprsim {

namespace {

constexpr double kUsualFps = 30;  // of an animation
constexpr double kMostFrames = 1e5;
constexpr double kMostSamples = 1e8;

std::string list_of(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names)
    text += (text.empty() ? "" : ", ") + name;
  return text.empty() ? text : "did you mean " + text + "?";
}

// names of output files stay inside the output folder
void check_file_name(Reading& r, const Node& node, const char* key) {
  const Attribute& a = *node.attribute(key);
  const bool leaves = a.value.empty() || a.value.front() == '/' ||
                      a.value.find("..") != std::string::npos ||
                      a.value.find('\\') != std::string::npos;
  if (leaves)
    r.report.bad_value("E306", node, a, "a file name inside the output folder is needed here");
}

void read_color_by(const Node& node, VideoSpec& video) {
  const std::string_view quantity = node.value("quantity");
  video.color_by = quantity == "curvature"        ? ColorBy::kCurvature
                   : quantity == "bending_moment" ? ColorBy::kBendingMoment
                   : quantity == "tension"        ? ColorBy::kTension
                   : quantity == "strain_energy"  ? ColorBy::kStrainEnergy
                                                  : ColorBy::kNone;
  const auto range = parse_numbers(node.value("range"));
  if (range && range->size() == 2) video.color_range = Vec2((*range)[0], (*range)[1]);
}

int camera_index(Reading& r, const Node& node) {
  const Attribute& a = *node.attribute("camera");
  std::vector<std::string> names;
  for (std::size_t k = 0; k < r.scene.cameras.size(); ++k) {
    if (r.scene.cameras[k].name == a.value) return static_cast<int>(k);
    names.push_back(r.scene.cameras[k].name);
  }
  r.report.bad_value("E410", node, a, "there is no camera '" + a.value + "'",
                     mean(nearest_name(a.value, names)));
  return -1;
}

void read_video(Reading& r, const Node& node) {
  VideoSpec video;
  video.place = node.place;
  video.file = node.value("file");
  check_file_name(r, node, "file");
  video.camera = camera_index(r, node);
  video.fps = number_attribute(node, "fps", video.fps);
  video.speed = number_attribute(node, "speed", video.speed);
  if (r.scene.simulation.duration * video.fps / video.speed > kMostFrames)
    r.report.error("E509", node, "the film would have more than 100000 frames");
  for (const Node* trace : node.all("trace")) {
    TraceSpec spec{std::string(trace->value("of")), number_attribute(*trace, "seconds", 0)};
    const auto channels = channels_of(r, *trace, trace->attribute("of"));
    const bool position = channels.size() == 3 && channels[0].quantity == Quantity::kPosition;
    if (!channels.empty() && !position)
      r.report.bad_value("E411", *trace, *trace->attribute("of"),
                         "a trace follows a position, such as robot::platform.position");
    video.traces.push_back(std::move(spec));
  }
  if (const Node* color = node.child("color_by")) read_color_by(*color, video);
  if (const Node* forces = node.child("contact_forces"))
    video.contact_forces = optional_number(*forces, "scale");
  if (const Node* overlay = node.child("overlay")) {
    video.overlay = overlay->text;
    video.show_time = parse_bool(overlay->value("time")).value_or(true);
  }
  r.scene.videos.push_back(std::move(video));
}

void read_record(Reading& r, const Node& node) {
  RecordSpec record;
  record.place = node.place;
  record.rate = number_attribute(node, "rate", 0);
  record.prefix = node.value("prefix");
  check_file_name(r, node, "prefix");
  if (r.scene.simulation.duration * record.rate > kMostSamples)
    r.report.error("E509", node, "the record would have more than 1e8 samples");
  for (const Node* channel : node.all("channel"))
    for (const Channel& found : channels_of(r, *channel, nullptr)) {
      const auto same = [&](const Channel& other) { return other.name == found.name; };
      if (std::none_of(record.channels.begin(), record.channels.end(), same))
        record.channels.push_back(found);
    }
  record.csv = node.child("csv") != nullptr;
  record.hdf5 = node.child("hdf5") != nullptr;
  record.npz = node.child("npz") != nullptr;
  if (const Node* vtk = node.child("vtk"))
    record.vtk_every = static_cast<int>(number_attribute(*vtk, "every", 1));
  if (const Node* gltf = node.child("gltf")) {
    record.gltf_fps = number_attribute(*gltf, "fps", kUsualFps);
    if (r.scene.simulation.duration * record.gltf_fps > kMostFrames)
      r.report.error("E509", *gltf, "the animation would have more than 100000 keyframes");
  }
  r.scene.records.push_back(std::move(record));
}

}  // namespace

void warn_of_pairs(Reading& r, const Node& node, const std::vector<Channel>& channels) {
  std::vector<ContactPair> told;
  for (const Channel& channel : channels) {
    if (channel.entity != ChannelEntity::kContactPair) continue;
    const auto same = [&](const ContactPair& pair) { return same_pair(pair, channel.pair); };
    if (std::any_of(told.begin(), told.end(), same)) continue;
    told.push_back(channel.pair);
    const std::string why = why_never_touching(r.scene, channel.pair);
    if (!why.empty())
      r.report.warn("W512", node,
                    "'" + party_name(r.scene, channel.pair[0]) + "' and '" +
                        party_name(r.scene, channel.pair[1]) + "' never touch: " + why);
  }
}

std::vector<Channel> channels_of(Reading& r, const Node& node, const Attribute* attribute) {
  const std::string& pattern = attribute ? attribute->value : node.text;
  std::vector<Channel> channels = find_channels(r.scene, pattern);
  if (!channels.empty()) {
    watch_pairs(r.scene, channels);
    warn_of_pairs(r, node, channels);
    return channels;
  }
  // of something that is there but could not be read: its own error is enough
  const std::string entity = pattern.substr(0, pattern.find_first_of(".("));
  if (r.report.failed() && r.frames.find_outwards(0, entity)) return channels;
  const std::string message = "there is no channel '" + pattern + "'";
  const std::string hint = list_of(nearest_channels(r.scene, pattern));
  if (attribute)
    r.report.bad_value("E411", node, *attribute, message, hint);
  else
    r.report.bad_text("E411", node, message, hint);
  return channels;
}

namespace {

// Formulas choose from metres: a first guess, where it is not about metres.
void read_accuracy_goal(Reading& r, const Node& world) {
  constexpr double kFirstGuess = 1e-4;  // of the longest rod
  const Node* physics = chosen_physics(world);
  const Node* solver = physics ? physics->child("cprsim:solver") : nullptr;
  const Node* node = solver ? solver->child("accuracy") : nullptr;
  if (!node || !r.scene.solver.accuracy) return;
  AccuracyGoal goal;
  goal.error = *r.scene.solver.accuracy;
  goal.relative = parse_bool(node->value("relative")).value_or(false);
  if (const Attribute* of = node->attribute("of")) {
    goal.of = of->value;
    goal.channels = channels_of(r, *node, of);
  }
  if (!goal.relative && goal.of.empty()) return;
  const bool metres = !goal.channels.empty() && goal.channels.front().unit == "m";
  if (goal.relative || !metres)
    r.scene.solver.accuracy =
        std::clamp((goal.relative ? goal.error : kFirstGuess) * longest_rod(r.scene), 1e-12, 1.0);
  r.scene.accuracy_goal = std::move(goal);
}

}  // namespace

void read_outputs(Reading& r, const Node& world) {
  read_accuracy_goal(r, world);
  for (const Node* node : world.all("cprsim:video"))
    read_video(r, *node);
  for (const Node* node : world.all("cprsim:record"))
    read_record(r, *node);
  for (const Node* node : world.all("cprsim:expect"))
    read_expect(r, *node);
  for (const Node* node : world.all("cprsim:sweep"))
    read_sweep(r, *node, world);
}

}  // namespace cprsim
