// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/loader/sections.h"

#include "scenes/loader/values.h"

namespace cprsim {
namespace {

/// The shape of a <cross_section>; nothing after an error.
std::optional<SectionSpec> read_shape(Reading& r, const Node& node) {
  SectionSpec section;
  section.place = node.place;
  section.s = number_attribute(node, "s", 0);
  const Node* shape = nullptr;
  for (const auto& child : node.children) {
    if (child->broken) return std::nullopt;
    if (shape) r.report.error("E304", *child, "a <cross_section> holds one shape");
    shape = child.get();
  }
  if (!shape) {
    r.report.missing("E303", node, "<cross_section> has no shape");
    return std::nullopt;
  }
  const auto size = [&](const char* key) { return number_of(shape->child(key), 0); };
  if (shape->name == "circle") {
    section.size = Vec2(size("radius"), 0);
  } else if (shape->name == "annulus") {
    section.shape = SectionShape::kAnnulus;
    section.size = Vec2(size("outer_radius"), size("inner_radius"));
    if (section.size[1] >= section.size[0] && section.size[0] > 0)
      r.report.error("E506", *shape, "the inner radius is not smaller than the outer one");
  } else if (shape->name == "rectangle") {
    section.shape = SectionShape::kRectangle;
    section.size = Vec2(size("width"), size("height"));
  } else {
    section.shape = SectionShape::kEllipse;
    const Node* axes = shape->child("semi_axes");
    const auto values = axes ? parse_numbers(axes->text) : std::nullopt;
    if (values && values->size() == 2) section.size = Vec2((*values)[0], (*values)[1]);
    if (axes && section.size.minCoeff() <= 0)
      r.report.bad_text("E306", *axes, "semi-axes must be positive");
  }
  return section;
}

/// What several sections along a rod must fulfil besides.
void check_order(Reading& r, const Node& node, const SectionSpec* before,
                 const SectionSpec& section) {
  const Attribute* s = node.attribute("s");
  if (!s)
    r.report.missing("E308", node, "of several cross-sections each needs its s");
  else if (section.s > 1)
    r.report.bad_value("E306", node, *s, "s is a fraction of the rod's length, at most 1");
  else if (before && section.s < before->s)
    r.report.bad_value("E306", node, *s, "cross-sections stand in the order of their s");
  else if (before && section.s > before->s && section.shape != before->shape)
    r.report.error("E506", node,
                   "between two s the shape stays the same: give both shapes at the s where one "
                   "follows the other");
}

}  // namespace

std::vector<SectionSpec> read_sections(Reading& r, const std::vector<const Node*>& nodes) {
  std::vector<SectionSpec> sections;
  for (const Node* node : nodes) {
    const auto section = read_shape(r, *node);
    if (!section) continue;
    if (nodes.size() > 1)
      check_order(r, *node, sections.empty() ? nullptr : &sections.back(), *section);
    sections.push_back(*section);
  }
  return sections;
}

}  // namespace cprsim
