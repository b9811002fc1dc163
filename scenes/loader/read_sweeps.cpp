// SPDX-License-Identifier: BSD-3-Clause
// Studies over values of the scene, for cprsim sweep.
#include "scenes/loader/override.h"
#include "scenes/loader/reading.h"
#include "scenes/loader/values.h"

namespace cprsim {

namespace {

constexpr int kMostValues = 10000;

SweepVary read_vary(Reading& r, const Node& node, const Node& world) {
  SweepVary vary;
  vary.path = node.value("path");
  check_path(world, *node.attribute("path"), node, r.report);
  for (const std::string_view word : split_words(node.text))
    vary.values.emplace_back(word);
  const auto from = optional_number(node, "from"), to = optional_number(node, "to");
  const auto count = static_cast<int>(number_attribute(node, "count", 0));
  const bool range = from || to || count > 0;
  if (range == !vary.values.empty() || (range && !(from && to && count > 0))) {
    r.report.missing("E310", node, "<vary> needs a list of values, or from, to and count");
  } else if (count > kMostValues) {
    r.report.bad_value("E509", node, *node.attribute("count"), "at most 10000 values");
  } else {
    for (int i = 0; i < count; ++i)
      vary.values.push_back(
          format_number(count == 1 ? *from : *from + (*to - *from) * i / (count - 1)));
  }
  return vary;
}

}  // namespace

void read_sweep(Reading& r, const Node& node, const Node& world) {
  SweepSpec sweep;
  sweep.name = node.value("name");
  sweep.place = node.place;
  for (const Node* vary : node.all("vary"))
    sweep.vary.push_back(read_vary(r, *vary, world));
  if (const Node* reference = node.child("reference"))
    sweep.reference = std::string(reference->value("value"));
  for (const Node* measure : node.all("measure")) {
    const std::string_view norm = measure->value("norm");
    sweep.measures.push_back({std::string(measure->value("of")),
                              channels_of(r, *measure, measure->attribute("of")),
                              norm == "rms"     ? Norm::kRms
                              : norm == "final" ? Norm::kFinal
                                                : Norm::kMax});
  }
  r.scene.sweeps.push_back(std::move(sweep));
}

}  // namespace cprsim
