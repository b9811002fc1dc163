// SPDX-License-Identifier: BSD-3-Clause
// A scene is loaded or refused with a reason that has a place.
#include <string_view>

#include "scenes/loader/load.h"
#include "tests/fuzz/target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cprsim;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  // a folder that is not there: nothing outside the text can be included
  const LoadResult result = load_scene_text(text, "/nonexistent/fuzz.xml");
  require(result.scene != nullptr || has_errors(result.diagnostics),
          "what is refused is refused for a reason");
  require(result.scene == nullptr || !has_errors(result.diagnostics), "a scene has no errors");
  for (const Diagnostic& d : result.diagnostics) {
    require(!explain_code(d.code).empty(), "every code is explained");
    to_json(d);
  }
  to_text(result.diagnostics);
  return 0;
}
