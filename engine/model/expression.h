// SPDX-License-Identifier: BSD-3-Clause
// Formulas of the time t, as in "0.1 * sin(2 * pi * t)".
//
// Drives need rates and accelerations of what they prescribe, so a formula is evaluated in numbers
// that carry their first and second derivative; muParser, which knows the same language, has
// difference quotients only.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "engine/model/jet.h"

namespace cprsim {

class Expression {
 public:
  struct Mistake {
    std::size_t at;  ///< character of the text
    std::string what;
  };

  /// Numbers, t, pi, e; + - * / ^ (to the right), comparisons, `a ? b : c`, parentheses, and the
  /// functions sin cos tan asin acos atan sinh cosh tanh exp ln log (= ln) log10 sqrt abs sign min
  /// max.
  static std::variant<Expression, Mistake> parse(std::string_view text);

  /// @param t in s. Not finite where the formula is not, as 1/t at 0.
  Jet evaluate(double t) const;

 private:
  friend class ExpressionParser;

  enum class Op : unsigned char;

  struct Instruction {
    Op op;
    double number;
  };

  std::vector<Instruction> program_;  ///< in postfix order
};

}  // namespace cprsim
