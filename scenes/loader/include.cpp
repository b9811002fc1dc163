// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/loader/include.h"

#include <algorithm>

#include "scenes/loader/files.h"
#include "scenes/loader/reporter.h"

namespace cprsim {

namespace {

constexpr std::size_t kDeepest = 8;
constexpr std::size_t kMostFiles = 200;

// reads the named file once it is found to be harmless; null after an error
std::unique_ptr<Node> read_included(const Node& uri, IncludeContext& context,
                                    std::vector<std::string>& open) {
  Reporter& report = context.report;
  const std::size_t file = static_cast<std::size_t>(std::max(uri.place.file, 0));
  const FoundFile found =
      find_resource(uri.text, context.folders[file], context.roots, "model.sdf");
  if (!found.code.empty()) {
    Diagnostic& d = report.bad_text(found.code, uri, found.message);
    for (const std::string& place : found.tried)
      d.details.push_back("tried " + place);
    return nullptr;
  }
  if (std::find(open.begin(), open.end(), found.path) != open.end()) {
    Diagnostic& d = report.bad_text("E108", uri, "'" + uri.text + "' includes itself");
    for (const std::string& path : open)
      d.details.push_back("by way of " + path);
    return nullptr;
  }
  if (open.size() > kDeepest || context.paths.size() >= kMostFiles) {
    report.bad_text("E108", uri, "includes are nested deeper than 8, or more than 200 files");
    return nullptr;
  }
  FileContent content = read_file(found.path);
  if (!content.code.empty()) {
    report.bad_text(content.code, uri, "'" + uri.text + "' " + content.message);
    return nullptr;
  }
  open.push_back(found.path);
  const int index = report.add_file(found.path, std::move(content.text));
  context.folders.push_back(folder_of(found.path));
  context.paths.push_back(found.path);
  // a copy: the list of files grows while the tree is built
  const std::string text = report.files()[static_cast<std::size_t>(index)].text;
  auto root = parse_document(text, index, report);
  if (!root || !check_root(*root, report)) return nullptr;
  return root;
}

std::unique_ptr<Node> take_model(Node& root, const Node& uri, Reporter& report) {
  for (auto& child : root.children)
    if (child->name == "model") {
      child->parent = nullptr;
      return std::move(child);
    }
  report.bad_text("E303", uri, "'" + uri.text + "' holds no <model>; only models can be included");
  return nullptr;
}

void replace_child(Node& model, const Node* given) {
  if (!given) return;
  auto& list = model.children;
  list.erase(std::remove_if(list.begin(), list.end(),
                            [&](const auto& child) { return child && child->name == given->name; }),
             list.end());
  model.append(given->clone());
}

// what the <include> says over what the file says
void adapt(Node& model, const Node& include, Reporter& report) {
  if (const Node* name = include.child("name")) model.set_attribute("name", name->text);
  replace_child(model, include.child("pose"));
  replace_child(model, include.child("static"));
  const Node* placement = include.child("placement_frame");
  if (!placement) return;
  if (!include.child("pose"))
    report.error("E310", *placement, "an include with a <placement_frame> needs a <pose>");
  model.set_attribute("placement_frame", placement->text);
}

}  // namespace

bool check_root(const Node& root, Reporter& report) {
  if (root.name != "sdf") {
    std::string what = "the root element is <" + root.name + ">, not <sdf>";
    if (root.name == "robot") what += ": this is URDF; convert it with 'gz sdf -p'";
    if (root.name == "mujoco") what += ": this is MJCF";
    if (root.name == "world" || root.name == "model")
      what += "; wrap it in <sdf version=\"1.11\" xmlns:cprsim=\"urn:cprsim:1\">";
    report.error("E205", root, what);
    return false;
  }
  const Attribute* version = root.attribute("version");
  if (!version) {
    report.error("E207", root, "<sdf> has no version", "version=\"1.11\"");
    return false;
  }
  for (const char* known : {"1.7", "1.8", "1.9", "1.10", "1.11", "1.12"})
    if (version->value == known) return true;
  const bool old = version->value.size() == 3 && version->value >= "1.0" && version->value < "1.7";
  report.bad_value(
      "E207", root, *version,
      old ? "SDF " + version->value + " is too old: poses mean something else there"
          : "'" + version->value + "' is no SDF version that cprsim reads, 1.7 to 1.12",
      old ? "convert it with 'gz sdf -p'" : "");
  return false;
}

void expand_includes(Node& node, IncludeContext& context, std::vector<std::string> open) {
  for (auto& child : node.children) {
    if (child->name != "include" || child->foreign) {
      const bool nests = child->name == "world" || child->name == "model";
      if (nests) expand_includes(*child, context, open);
      continue;
    }
    const Node* uri = child->child("uri");
    const std::string_view merge = child->value("merge");
    const bool plain = merge.empty() || merge == "false" || merge == "0";
    if (!uri || !plain) continue;  // validation says what is wrong
    std::vector<std::string> inner = open;
    auto root = read_included(*uri, context, inner);
    auto model = root ? take_model(*root, *uri, context.report) : nullptr;
    if (!model) {
      child->broken = true;
      continue;
    }
    adapt(*model, *child, context.report);
    expand_includes(*model, context, inner);
    model->parent = &node;
    child = std::move(model);
  }
}

}  // namespace cprsim
