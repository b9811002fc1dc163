// SPDX-License-Identifier: BSD-3-Clause
#include "tools/series/recorded_states.h"

#include <fmt/core.h>

#include <cmath>

#include "tools/hdf5/hdf5_input.h"
#include "tools/series/measured_table.h"

namespace cprsim {

namespace {

constexpr std::size_t kMostNodes = 1'000'000;

Mat3 rotation(const double* q) {
  const Quat quaternion(q[3], q[0], q[1], q[2]);
  if (!(quaternion.norm() > 0.5 && quaternion.norm() < 2))
    throw TableError("a quaternion that is none");
  return quaternion.normalized().toRotationMatrix();
}

Vec3 vector(const double* v) {
  return {v[0], v[1], v[2]};
}

}  // namespace

struct RecordedStates::File {
  struct Rod {
    std::string group;
    std::vector<double> s;
  };

  Hdf5Input input;
  std::vector<Rod> rods;
  std::vector<std::string> links;  ///< groups; empty: one that never moves

  explicit File(const std::string& path) : input(path) {}

  /// An array of so many rows of this shape.
  void require(const std::string& array, std::size_t rows, std::vector<std::size_t> shape) const {
    shape.insert(shape.begin(), rows);
    if (!input.has(array)) throw TableError("the file has no " + array);
    if (input.shape(array) != shape) throw TableError(array + " has another size than the scene's");
  }

  RodSample rod(std::size_t index, std::size_t row) const {
    const Rod& of = rods[index];
    const auto read = [&](const char* name) { return input.row(of.group + "/" + name, row); };
    const std::vector<double> length = read("length"), p = read("position"), q = read("quaternion"),
                              strain = read("strain"), n = read("n"), m = read("m");
    RodSample sample;
    sample.length = length[0];
    for (std::size_t k = 0; k < of.s.size(); ++k) {
      RodPoint point;
      point.s = of.s[k];
      point.position = vector(&p[3 * k]);
      point.rotation = rotation(&q[4 * k]);
      point.curvature = vector(&strain[6 * k]);
      point.shear_stretch = vector(&strain[6 * k + 3]);
      point.force = vector(&n[3 * k]);
      point.moment = vector(&m[3 * k]);
      sample.points.push_back(point);
    }
    return sample;
  }
};

RecordedStates::RecordedStates(const std::string& path, const Scene& scene) : scene_(scene) {
  try {
    file_ = std::make_unique<File>(path);
    const Hdf5Input& input = file_->input;
    if (!input.has("time") || input.shape("time").size() != 1)
      throw TableError("the file has no array /time");
    times_ = input.numbers("time");
    if (times_.empty()) throw TableError("the file holds no instant");
    for (std::size_t k = 0; k < times_.size(); ++k)
      if (!std::isfinite(times_[k]) || (k > 0 && times_[k] <= times_[k - 1]))
        throw TableError(fmt::format("time does not increase at time[{}]", k));
    scene_hash_ = input.text("/", "scene_hash");
    for (const RodSpec& rod : scene.rods) {
      File::Rod found{"rods/" + rod.name, {}};
      if (!input.has(found.group + "/s")) throw TableError("the file has no rod " + rod.name);
      found.s = input.numbers(found.group + "/s");
      const std::size_t nodes = found.s.size();
      if (nodes < 2 || nodes > kMostNodes) throw TableError(found.group + "/s is no rod's");
      file_->require(found.group + "/length", times_.size(), {});
      for (const auto& [name, width] :
           {std::pair{"position", 3}, std::pair{"quaternion", 4}, std::pair{"strain", 6},
            std::pair{"n", 3}, std::pair{"m", 3}})
        file_->require(found.group + "/" + name, times_.size(),
                       {nodes, static_cast<std::size_t>(width)});
      file_->rods.push_back(std::move(found));
    }
    for (const BodySpec& body : scene.bodies) {
      const std::string group = "links/" + body.name;
      file_->links.push_back(body.is_static ? "" : group);
      if (body.is_static) continue;
      file_->require(group + "/position", times_.size(), {3});
      file_->require(group + "/quaternion", times_.size(), {4});
    }
  } catch (const TableError& error) {
    throw TableError(path + ": " + error.what());
  } catch (const Hdf5Error& error) {
    throw TableError(path + ": not readable as HDF5: " + error.what());
  }
}

RecordedStates::~RecordedStates() = default;

Snapshot RecordedStates::at(std::size_t index) const {
  Snapshot snapshot;
  snapshot.time = times_.at(index);
  snapshot.joints.resize(scene_.joints.size());
  snapshot.tendons.resize(scene_.tendons.size());
  try {
    for (std::size_t r = 0; r < file_->rods.size(); ++r)
      snapshot.rods.push_back(file_->rod(r, index));
    for (std::size_t b = 0; b < file_->links.size(); ++b) {
      BodySample body;
      body.X_WB = scene_.bodies[b].X_WB;
      const std::string& group = file_->links[b];
      if (!group.empty()) {
        body.X_WB.p = vector(file_->input.row(group + "/position", index).data());
        body.X_WB.R = rotation(file_->input.row(group + "/quaternion", index).data());
      }
      snapshot.bodies.push_back(body);
    }
  } catch (const Hdf5Error& error) {
    throw TableError(
        fmt::format("the state at {} s cannot be read: {}", snapshot.time, error.what()));
  }
  return snapshot;
}

}  // namespace cprsim
