// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/loader/solver_setting.h"

#include <algorithm>

#include "scenes/loader/values.h"

namespace cprsim {

namespace {

struct Setting {
  const char* name;
  const char* element;                ///< below <cprsim:solver>; empty: the solver itself
  const char* attribute;              ///< empty: the element's text
  std::vector<std::string> excluded;  ///< attributes of the same element
};

const std::vector<Setting>& table() {
  static const std::vector<Setting> all{{"method", "", "method", {}},
                                        {"accuracy", "accuracy", "", {}},
                                        {"scheme", "time", "scheme", {"alpha", "rho_inf"}},
                                        {"alpha", "time", "alpha", {}},
                                        {"rho_inf", "time", "rho_inf", {}},
                                        {"step", "time", "step", {"tolerance"}},
                                        {"tolerance", "time", "tolerance", {"step"}},
                                        {"points", "space", "points", {}},
                                        {"integrator", "space", "integrator", {}},
                                        {"order", "space", "order", {}},
                                        {"degree", "space", "degree", {}},
                                        {"elements", "space", "elements", {}},
                                        {"residual", "nonlinear", "tolerance", {}}};
  return all;
}

// what is asked for by name holds for every rod
void forget_methods(Node& node) {
  if (node.name == "cprsim:rod" || node.name == "cprsim:rod_class")
    std::erase_if(node.attributes, [](const Attribute& a) { return a.name == "method"; });
  for (const auto& child : node.children)
    forget_methods(*child);
}

// whoever asks for an accuracy leaves resolution and steps to the program
void forget_resolution(Node& solver) {
  for (const auto& child : solver.children)
    if (child->name == "time" || child->name == "space")
      std::erase_if(child->attributes, [](const Attribute& a) {
        return a.name != "scheme" && a.name != "alpha" && a.name != "rho_inf" &&
               a.name != "integrator" && a.name != "basis";
      });
}

void set_text(Node& node, const std::string& text) {
  node.text = text;
  node.text_place = {};
}

}  // namespace

const std::vector<std::string>& solver_settings() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const Setting& setting : table())
      list.emplace_back(setting.name);
    return list;
  }();
  return names;
}

bool is_solver_setting(std::string_view name) {
  const auto& names = solver_settings();
  return std::find(names.begin(), names.end(), name) != names.end();
}

Node& physics_of(Node& world) {
  for (const auto& child : world.children)
    if (child->name == "physics" && parse_bool(child->value("default")).value_or(false))
      return *child;
  return world.need("physics");
}

void set_solver_setting(Node& world, std::string_view name, const std::string& value) {
  const auto setting = std::find_if(table().begin(), table().end(),
                                    [&](const Setting& s) { return name == s.name; });
  Node& solver = physics_of(world).need("cprsim:solver");
  if (!solver.attribute("method")) solver.set_attribute("method", "auto");
  if (name == "method") forget_methods(world);
  if (name == "accuracy") forget_resolution(solver);
  if (name == "step") set_text(physics_of(world).need("max_step_size"), value);
  Node& node = *setting->element == '\0' ? solver : solver.need(setting->element);
  if (*setting->attribute == '\0') {
    node.attributes.clear();
    set_text(node, value);
    return;
  }
  std::erase_if(node.attributes, [&](const Attribute& a) {
    return std::find(setting->excluded.begin(), setting->excluded.end(), a.name) !=
           setting->excluded.end();
  });
  node.set_attribute(setting->attribute, value);
  for (Attribute& a : node.attributes)
    if (a.name == setting->attribute) a.place = a.value_place = {};
  // a <time> made here has no scheme yet
  if (node.name == "time" && !node.attribute("scheme")) node.set_attribute("scheme", "esdirk32");
}

}  // namespace cprsim
