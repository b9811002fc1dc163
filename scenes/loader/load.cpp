// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/loader/load.h"

#include <cstdlib>
#include <filesystem>
#include <new>

#include "scenes/loader/files.h"
#include "scenes/loader/include.h"
#include "scenes/loader/override.h"
#include "scenes/loader/reading.h"
#include "scenes/loader/schema.h"

namespace cprsim {

namespace {

// FNV-1a, 64 bit, over the bytes of all files: tells whether two runs had the same input
std::string hash_of(const std::vector<SourceFile>& files) {
  std::uint64_t hash = 14695981039346656037ull;
  for (const SourceFile& file : files)
    for (const char c : file.text) {
      hash ^= static_cast<unsigned char>(c);
      hash *= 1099511628211ull;
    }
  constexpr char kHex[] = "0123456789abcdef";
  std::string text;
  for (int shift = 60; shift >= 0; shift -= 4)
    text += kHex[(hash >> shift) & 15];
  return text;
}

// the world to simulate; a file with a bare model is a world that holds just that
Node* choose_world(Node& root, Reporter& report) {
  Node* world = nullptr;
  Node* model = nullptr;
  for (const auto& child : root.children) {
    if (child->name == "world") {
      if (world)
        report.error("E520", *child, "more than one world is not available in this version",
                     "available: one <world> per file");
      else
        world = child.get();
    } else if (child->name == "model" && !model) {
      model = child.get();
    }
  }
  if (world && model) report.error("E301", *model, "a <model> beside a <world> belongs into it");
  if (world) return world;
  if (!model) {
    report.missing("E303", root, "<sdf> has no <world>");
    return nullptr;
  }
  auto wrapped = std::make_unique<Node>();
  wrapped->name = "world";
  wrapped->place = model->place;
  wrapped->set_attribute("name", model->value("name"));
  for (auto& child : root.children)
    if (child.get() == model) {
      wrapped->append(std::move(child));
      child = std::move(wrapped);
      child->parent = &root;
      return child.get();
    }
  return nullptr;
}

std::vector<std::string> root_folders(const std::string& folder, const LoadOptions& options) {
  std::vector<std::string> roots{folder};
  for (const std::string& path : options.resource_paths)
    roots.push_back(path);
  return roots;
}

void read_world(Reading& reading, const Node& world) {
  read_settings(reading, world);
  read_profiles(reading, world);
  read_bodies(reading, world);
  read_joints(reading, world);
  read_rods(reading, world);
  read_tendons(reading);
  read_ties(reading);
  read_actions(reading);
  read_initial(reading, world);
  read_magnetic_fields(reading, world);
  read_targets(reading);
  read_views(reading, world);
  check_physics(reading);
  check_fields(reading, world);
  check_tendons(reading);
  check_ties(reading);
  check_planar(reading, world);
  check_contact(reading);
  read_outputs(reading, world);
}

// the code of <fails with="..."/>, known even if nothing else in the scene can be read
std::string expected_failure(const Node& world) {
  for (const Node* expect : world.all("cprsim:expect"))
    if (const Node* fails = expect->child("fails")) return std::string(fails->value("with"));
  return {};
}

void load(const std::string& text, const std::string& name, const LoadOptions& options,
          Reporter& report, LoadResult& result) {
  auto root = parse_document(text, 0, report);
  if (!root || !check_root(*root, report)) return;
  IncludeContext includes{
      report, root_folders(folder_of(name), options), {folder_of(name)}, {name}};
  std::error_code ignored;
  expand_includes(*root, includes, {std::filesystem::weakly_canonical(name, ignored).string()});
  Node* world = choose_world(*root, report);
  if (!world) return;
  apply_overrides(*world, options, report);
  result.got = values_at(*world, options.get, report);
  result.expected_failure = expected_failure(*world);
  validate(*root, options.lax, report);

  auto scene = std::make_unique<Scene>();
  FrameGraph frames(*world, report);
  Reading reading{*scene,         frames, report, options, includes.folders,
                  includes.roots, {},     {},     {},      {}};
  read_world(reading, *world);
  for (const SourceFile& file : report.files())
    scene->files.push_back(file.path);
  scene->hash = hash_of(report.files());
  if (!report.failed()) result.scene = std::move(scene);
}

}  // namespace

LoadResult load_scene_text(std::string_view text, const std::string& name,
                           const LoadOptions& options) {
  LoadResult result;
  Reporter report;
  const std::string content(text);
  try {
    report.add_file(name, content);
    load(content, name, options, report, result);
  } catch (const std::bad_alloc&) {
    result.scene.reset();
    report.at(Severity::kError, "E105", {0, 0, 0}, 0, "reading this scene needs too much memory");
  }
  result.diagnostics = report.take();
  return result;
}

LoadResult load_scene(const std::string& path, const LoadOptions& options) {
  const bool standard = path == "-";
  const std::string name = standard ? "<stdin>" : path;
  FileContent content = standard ? read_standard_input() : read_file(path);
  if (content.code.empty()) return load_scene_text(content.text, name, options);
  LoadResult result;
  Diagnostic d;
  d.code = content.code;
  d.file = name;
  d.message = content.code == "E101" ? "cannot be opened: " + content.message
                                     : "the file " + content.message;
  result.diagnostics.push_back(std::move(d));
  return result;
}

std::vector<std::string> environment_resource_paths() {
  std::vector<std::string> paths;
  for (const char* variable : {"CPRSIM_RESOURCE_PATH", "GZ_SIM_RESOURCE_PATH", "SDF_PATH"}) {
    const char* value = std::getenv(variable);
    std::string_view rest = value ? value : "";
    while (!rest.empty()) {
      const std::size_t colon = rest.find(':');
      if (colon != 0) paths.emplace_back(rest.substr(0, colon));
      rest.remove_prefix(colon == std::string_view::npos ? rest.size() : colon + 1);
    }
  }
  return paths;
}

}  // namespace cprsim
