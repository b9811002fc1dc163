// SPDX-License-Identifier: BSD-3-Clause
// Everything that turns a text of a scene into numbers.
#include <cmath>
#include <string_view>

#include "engine/model/expression.h"
#include "scenes/loader/values.h"
#include "tests/fuzz/target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cprsim;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (const auto x = parse_number(text)) {
    require(std::isfinite(*x), "a number is finite");
    require(parse_number(format_number(*x)) == x, "a number reads back as itself");
  }
  parse_integer(text);
  parse_bool(text);
  parse_numbers(text);
  parse_vec3(text);
  parse_keyframes(text);
  const auto parsed = Expression::parse(text);
  if (const auto* mistake = std::get_if<Expression::Mistake>(&parsed))
    require(mistake->at <= size && !mistake->what.empty(), "a mistake has a place and a reason");
  else
    for (const double t : {0., 0.5, 1e9})
      std::get<Expression>(parsed).evaluate(t);
  return 0;
}
