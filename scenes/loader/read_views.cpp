// SPDX-License-Identifier: BSD-3-Clause
// Lights, cameras and surroundings.
#include "scenes/loader/reading.h"
#include "scenes/loader/suggest.h"
#include "scenes/loader/values.h"

namespace cprsim {

namespace {

constexpr int kLargestImage = 8192;

Vec3 color(const Node* node, const Vec3& fallback) {
  const auto numbers = node ? parse_numbers(node->text) : std::nullopt;
  if (!numbers || numbers->size() < 3) return fallback;
  return {(*numbers)[0], (*numbers)[1], (*numbers)[2]};
}

void read_light(Reading& r, const Node& node, int scope, int vertex) {
  LightSpec light;
  light.name = node.value("name");
  light.place = node.place;
  const std::string_view type = node.value("type");
  light.kind = type == "point"  ? LightKind::kPoint
               : type == "spot" ? LightKind::kSpot
                                : LightKind::kDirectional;
  light.at = r.frames.frame_ref(r.frames.body_of(vertex), r.frames.posed(node, scope, vertex));
  light.direction = vec3_of(node.child("direction"), light.direction);
  if (light.direction.norm() < 1e-9)
    r.report.bad_text("E506", *node.child("direction"), "the light's direction has length 0");
  light.direction.normalize();
  light.diffuse = color(node.child("diffuse"), light.diffuse);
  light.specular = color(node.child("specular"), light.specular);
  light.intensity = number_of(node.child("intensity"), 1);
  light.cast_shadows = flag_of(node.child("cast_shadows"), false);
  r.scene.lights.push_back(std::move(light));
}

void read_picture(Reading& r, const Node& node, CameraSpec& camera) {
  const Node* image = node.child("image");
  if (!image) return;
  const auto pixels = [&](const char* key, int fallback) {
    const Node* value = image->child(key);
    const auto count = value ? parse_integer(value->text) : std::nullopt;
    if (count && *count > kLargestImage)
      r.report.bad_text("E509", *value, "pictures have at most 8192 pixels in a direction");
    return count ? static_cast<int>(*count) : fallback;
  };
  camera.width = pixels("width", camera.width);
  camera.height = pixels("height", camera.height);
}

void read_opening(Reading& r, const Node& node, CameraSpec& camera) {
  const Node* angle = node.child("horizontal_fov");
  camera.horizontal_fov = number_of(angle, camera.horizontal_fov);
  if (angle && camera.horizontal_fov > 3.1)
    r.report.bad_text("E306", *angle, "the opening angle must be less than 3.1 rad");
}

void read_camera(Reading& r, const Node& node) {
  CameraSpec camera;
  camera.name = node.value("name");
  camera.place = node.place;
  camera.eye = vec3_of(node.child("eye"), camera.eye);
  camera.up = vec3_of(node.child("up"), camera.up);
  if (camera.up.norm() < 1e-9)
    r.report.bad_text("E506", *node.child("up"), "<up> has no direction: its length is 0");
  if (const Node* target = node.child("look_at")) {
    camera.look_at = target->text.empty() ? Vec3::Zero() : vec3_of(target, Vec3::Zero());
    const Attribute* frame = target->attribute("frame");
    const auto found = frame ? r.frames.find_outwards(0, frame->value) : std::nullopt;
    if (found && found->kind != FrameKind::kRod)
      camera.look_at_frame = r.frames.frame_ref(found->index);
    else if (frame)
      r.report.bad_value("E403", *target, *frame,
                         "there is no link or frame '" + frame->value + "'",
                         mean(nearest_name(frame->value, r.frames.known_names(0))));
    else if ((camera.look_at - camera.eye).norm() < 1e-9)
      r.report.error("E506", *target, "the camera stands where it looks at");
  }
  read_opening(r, node, camera);
  read_picture(r, node, camera);
  if (const Node* orbit = node.child("orbit"))
    camera.orbit_rate = number_attribute(*orbit, "rate", 0);
  r.scene.cameras.push_back(std::move(camera));
}

// SDF's user camera looks along the x axis of its pose
void read_gui_camera(Reading& r, const Node& node) {
  CameraSpec camera;
  camera.name = node.value("name").empty() ? "gui" : std::string(node.value("name"));
  camera.place = node.place;
  const Pose X_WC = r.frames.posed(node, 0, r.frames.scopes()[0].self);
  camera.eye = X_WC.p;
  camera.look_at = X_WC.p + X_WC.R.col(0);
  camera.up = X_WC.R.col(2);
  read_opening(r, node, camera);
  r.scene.cameras.push_back(std::move(camera));
}

}  // namespace

void read_views(Reading& r, const Node& world) {
  for (const Node* light : world.all("light"))
    read_light(r, *light, 0, r.frames.scopes()[0].self);
  for (int b = 0; b < r.frames.body_count(); ++b) {
    const int vertex = r.frames.link_of(b);
    const FrameVertex& v = r.frames.vertices()[at(vertex)];
    for (const Node* light : v.node->all("light"))
      read_light(r, *light, v.scope, vertex);
  }
  for (const Node* camera : world.all("cprsim:camera")) {
    for (const CameraSpec& other : r.scene.cameras)
      if (other.name == camera->value("name"))
        r.report.error("E401", *camera, "a second camera '" + other.name + "'");
    read_camera(r, *camera);
  }
  if (const Node* gui = world.child("gui"))
    if (const Node* camera = gui->child("camera")) read_gui_camera(r, *camera);
  if (const Node* scene = world.child("scene")) {
    EnvironmentSpec& around = r.scene.environment;
    around.ambient = color(scene->child("ambient"), around.ambient);
    around.background_set = scene->child("background") != nullptr;
    around.background = color(scene->child("background"), around.background);
    around.shadows = flag_of(scene->child("shadows"), around.shadows);
    around.grid = flag_of(scene->child("grid"), around.grid);
  }
}

}  // namespace cprsim
