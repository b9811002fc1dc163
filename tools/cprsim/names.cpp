// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cprsim/names.h"

namespace cprsim {

const char* mode_name(Mode mode) {
  switch (mode) {
    case Mode::kStatic:
      return "static";
    case Mode::kQuasistatic:
      return "quasistatic";
    case Mode::kDynamic:
      return "dynamic";
  }
  return "";
}

const char* method_name(Method method) {
  switch (method) {
    case Method::kAuto:
      return "auto";
    case Method::kShooting:
      return "shooting";
  }
  return "";
}

std::string place_name(const Scene& scene, const Place& place) {
  if (!place.known() || place.file < 0) return {};
  return scene.files.at(static_cast<std::size_t>(place.file)) + ":" + std::to_string(place.line);
}

}  // namespace cprsim
