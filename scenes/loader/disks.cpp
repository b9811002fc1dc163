// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/loader/disks.h"

#include <algorithm>

#include "scenes/loader/values.h"

namespace cprsim {
namespace {

constexpr int kMostDisks = 500;

}  // namespace

void read_disks(Reading& r, const Node& owner, RodSpec& rod) {
  for (const Node* node : owner.all("disks")) {
    const Attribute *count = node->attribute("count"), *s = node->attribute("s");
    if ((count != nullptr) == (s != nullptr)) {
      r.report.error("E308", *node, "<disks> have a count or one s");
      continue;
    }
    DiskSpec disk;
    disk.mass = number_of(node->child("mass"), 0);
    disk.radius = number_of(node->child("radius"), 0);
    disk.s = number_attribute(*node, "s", 1);
    if (s && disk.s > 1)
      r.report.bad_value("E306", *node, *s, "s is a fraction of the rod's length, at most 1");
    const int n = static_cast<int>(number_attribute(*node, "count", 1));
    if (n > kMostDisks)
      r.report.bad_value("E306", *node, *count,
                         "a rod carries at most " + std::to_string(kMostDisks) + " disks");
    else
      for (int k = 1; k <= n; ++k) {
        if (count) disk.s = static_cast<double>(k) / n;
        rod.disks.push_back(disk);
      }
  }
  std::stable_sort(rod.disks.begin(), rod.disks.end(),
                   [](const DiskSpec& a, const DiskSpec& b) { return a.s < b.s; });
}

}  // namespace cprsim
