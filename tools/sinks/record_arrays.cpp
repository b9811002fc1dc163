// SPDX-License-Identifier: BSD-3-Clause
#include "tools/sinks/record_arrays.h"

#include <algorithm>
#include <stdexcept>

namespace cprsim {

namespace {

constexpr std::size_t kBlockBytes = 4 << 20;  ///< what a block may take
constexpr std::size_t kMostRows = 128;        ///< lost at most when the process is killed

/// In whose axes the components of a channel are given.
std::string frame_of(const Channel& channel) {
  switch (channel.quantity) {
    case Quantity::kPosition:
    case Quantity::kOrientation:
    case Quantity::kLinearVelocity:
    case Quantity::kAngularVelocity:
    case Quantity::kForce:
    case Quantity::kMoment:
      return "world";
    case Quantity::kCurvature:
    case Quantity::kShearStretch:
      return "section";
    case Quantity::kJointPosition:
    case Quantity::kJointVelocity:
    case Quantity::kJointEffort:
    case Quantity::kJointLimit:
      return "joint";
    default:
      return "";
  }
}

std::vector<double> fractions(const RodSample& rod) {
  std::vector<double> s;
  for (const RodPoint& point : rod.points)
    s.push_back(point.s);
  return s;
}

/// x y z w, of the two signs the one nearer to the last.
Vec4 continued(const Mat3& R, Vec4& last) {
  Vec4 q = Quat(R).normalized().coeffs();
  const double same = q.dot(last);
  if (same < 0 || (same == 0 && q.w() < 0)) q = -q;
  last = q;
  return q;
}

template <class Vector>
void put(std::vector<double>& block, const Vector& v) {
  block.insert(block.end(), v.data(), v.data() + v.size());
}

}  // namespace

std::size_t RecordArray::width() const {
  std::size_t numbers = 1;
  for (const std::size_t extent : shape)
    numbers *= extent;
  return numbers;
}

std::string rod_group(const RodSpec& rod) {
  return "rods/" + rod.name;
}

std::string link_group(const BodySpec& link) {
  return "links/" + link.name;
}

RecordArrays::RecordArrays(const Scene& scene, const std::vector<Channel>& channels,
                           const Snapshot& first) {
  if (first.rods.size() != scene.rods.size())
    throw std::invalid_argument("a snapshot of another scene");
  add({"", "time", {}, "s", ""});
  for (const Channel& channel : channels)
    add({"channels", channel.name, {}, channel.unit, frame_of(channel)});
  first_rod_array_ = list_.size();
  for (std::size_t r = 0; r < scene.rods.size(); ++r) {
    grids_.push_back(fractions(first.rods[r]));
    last_quaternions_.emplace_back(grids_[r].size(), Vec4::Zero());
    const std::string group = rod_group(scene.rods[r]);
    const std::size_t nodes = grids_[r].size();
    add({group, "length", {}, "m", ""});
    add({group, "position", {nodes, 3}, "m", "world"});
    add({group, "quaternion", {nodes, 4}, "1", "world"});
    add({group, "strain", {nodes, 6}, "1/m 1/m 1/m 1 1 1", "section"});
    add({group, "n", {nodes, 3}, "N", "world"});
    add({group, "m", {nodes, 3}, "N m", "world"});
  }
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    if (scene.bodies[b].is_static) continue;
    links_.push_back(b);
    const std::string group = link_group(scene.bodies[b]);
    add({group, "position", {3}, "m", "world"});
    add({group, "quaternion", {4}, "1", "world"});
  }
  last_quaternions_.emplace_back(links_.size(), Vec4::Zero());
  std::size_t row_bytes = 0;
  for (const RecordArray& array : list_)
    row_bytes += array.width() * sizeof(double);
  block_rows_ = std::clamp<std::size_t>(kBlockBytes / row_bytes, 1, kMostRows);
}

void RecordArrays::add(RecordArray array) {
  list_.push_back(std::move(array));
  blocks_.emplace_back();
}

void RecordArrays::append(const Snapshot& snapshot, std::span<const double> values) {
  if (values.size() + 1 != first_rod_array_ || snapshot.rods.size() != grids_.size())
    throw std::invalid_argument("a row of another recording");
  blocks_[0].push_back(snapshot.time);
  for (std::size_t i = 0; i < values.size(); ++i)
    blocks_[1 + i].push_back(values[i]);
  for (std::size_t r = 0; r < grids_.size(); ++r)
    append_rod(snapshot.rods[r], r);
  for (std::size_t k = 0; k < links_.size(); ++k)
    append_link(snapshot.bodies.at(links_[k]), k);
  ++rows_;
}

void RecordArrays::append_rod(const RodSample& rod, std::size_t index) {
  auto* const block = &blocks_[first_rod_array_ + 6 * index];
  block[0].push_back(rod.length);
  const std::vector<double>& grid = grids_[index];
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const bool there = rod.points.size() == grid.size() && rod.points[i].s == grid[i];
    const RodPoint point = there ? rod.points[i] : point_at(rod, grid[i]);
    put(block[1], point.position);
    put(block[2], continued(point.rotation, last_quaternions_[index][i]));
    put(block[3], point.curvature);
    put(block[3], point.shear_stretch);
    put(block[4], point.force);
    put(block[5], point.moment);
  }
}

void RecordArrays::append_link(const BodySample& link, std::size_t index) {
  auto* const block = &blocks_[first_rod_array_ + 6 * grids_.size() + 2 * index];
  put(block[0], link.X_WB.p);
  put(block[1], continued(link.X_WB.R, last_quaternions_.back()[index]));
}

void RecordArrays::clear() {
  for (std::vector<double>& block : blocks_)
    block.clear();
  rows_ = 0;
}

void RecordArrays::visit(Archive& archive) {
  for (std::vector<Vec4>& rod : last_quaternions_)
    archive.doubles(rod);
}

}  // namespace cprsim
