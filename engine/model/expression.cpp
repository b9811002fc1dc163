// SPDX-License-Identifier: BSD-3-Clause
// A recursive descent into postfix order, and its evaluation.
#include "engine/model/expression.h"

#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>

namespace cprsim {

enum class Expression::Op : unsigned char {
  kNumber,
  kTime,
  kAdd,
  kSubtract,
  kMultiply,
  kDivide,
  kPower,
  kNegate,
  kLess,
  kLessEqual,
  kGreater,
  kGreaterEqual,
  kEqual,
  kUnequal,
  kChoose,
  kMin,
  kMax,
  kSin,
  kCos,
  kTan,
  kAsin,
  kAcos,
  kAtan,
  kSinh,
  kCosh,
  kTanh,
  kExp,
  kLn,
  kLog10,
  kSqrt,
  kAbs,
  kSign
};

namespace {

constexpr std::size_t kDeepest = 48;      ///< nested operations: bounds the stack of a parse
constexpr std::size_t kMostValues = 256;  ///< waiting at once during an evaluation

struct Function {
  const char* name;
  int arguments;
};

constexpr Function kFunctions[] = {{"min", 2},  {"max", 2},  {"sin", 1},  {"cos", 1},   {"tan", 1},
                                   {"asin", 1}, {"acos", 1}, {"atan", 1}, {"sinh", 1},  {"cosh", 1},
                                   {"tanh", 1}, {"exp", 1},  {"ln", 1},   {"log10", 1}, {"sqrt", 1},
                                   {"abs", 1},  {"sign", 1}};

}  // namespace

class ExpressionParser {
 public:
  using Op = Expression::Op;

  explicit ExpressionParser(std::string_view text) : text_(text) {}

  std::variant<Expression, Expression::Mistake> parse() {
    choice();
    if (!mistake_ && next() != '\0') fail("this does not belong to a formula");
    if (mistake_) return *mistake_;
    return std::move(out_);
  }

 private:
  // The first character that is not white space, '\0' at the end.
  char next() {
    while (at_ < text_.size() &&
           (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\n' || text_[at_] == '\r'))
      ++at_;
    return at_ < text_.size() ? text_[at_] : '\0';
  }

  bool accept(std::string_view word) {
    next();
    if (text_.substr(at_, word.size()) != word) return false;
    at_ += word.size();
    return true;
  }

  void fail(std::string what) {
    if (!mistake_) mistake_ = {at_, std::move(what)};
  }

  void emit(Op op, double number = 0) {
    out_.program_.push_back({op, number});
    const auto code = static_cast<int>(op);
    if (op == Op::kNumber || op == Op::kTime) {
      if (++waiting_ > kMostValues) fail("the formula is too long");
    } else if (op == Op::kChoose) {
      waiting_ -= 2;
    } else if (code <= static_cast<int>(Op::kMax) && op != Op::kNegate) {
      --waiting_;
    }
  }

  // condition ? a : b
  void choice() {
    if (++depth_ > kDeepest) fail("the formula is nested too deeply");
    if (mistake_) return;
    comparison();
    if (accept("?")) {
      choice();
      if (!accept(":")) fail("':' is missing");
      choice();
      emit(Op::kChoose);
    }
    --depth_;
  }

  void comparison() {
    sum();
    constexpr std::pair<std::string_view, Op> kSigns[] = {
        {"<=", Op::kLessEqual}, {">=", Op::kGreaterEqual}, {"==", Op::kEqual},
        {"!=", Op::kUnequal},   {"<", Op::kLess},          {">", Op::kGreater}};
    for (const auto& [sign, op] : kSigns)
      if (accept(sign)) {
        sum();
        emit(op);
        return;
      }
  }

  void sum() {
    product();
    while (!mistake_) {
      const char sign = next();
      if (sign != '+' && sign != '-') return;
      ++at_;
      product();
      emit(sign == '+' ? Op::kAdd : Op::kSubtract);
    }
  }

  void product() {
    signed_power();
    while (!mistake_) {
      const char sign = next();
      if (sign != '*' && sign != '/') return;
      ++at_;
      signed_power();
      emit(sign == '*' ? Op::kMultiply : Op::kDivide);
    }
  }

  // -a^b is -(a^b)
  void signed_power() {
    if (++depth_ > kDeepest) fail("the formula is nested too deeply");
    if (mistake_) return;
    if (accept("-")) {
      signed_power();
      emit(Op::kNegate);
    } else if (accept("+")) {
      signed_power();
    } else {
      operand();
      if (accept("^")) {
        signed_power();
        emit(Op::kPower);
      }
    }
    --depth_;
  }

  void operand() {
    const char c = next();
    if (accept("(")) {
      choice();
      if (!accept(")")) fail("')' is missing");
    } else if ((c >= '0' && c <= '9') || c == '.') {
      number();
    } else if ((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_') {
      word();
    } else {
      fail(c == '\0' ? "the formula ends too early"
                     : "a number, t or a function should stand here");
    }
  }

  void number() {
    double value = 0;
    const char* const begin = text_.data() + at_;
    const auto read = std::from_chars(begin, text_.data() + text_.size(), value);
    if (read.ec != std::errc() || !std::isfinite(value)) return fail("this is not a number");
    at_ += static_cast<std::size_t>(read.ptr - begin);
    emit(Op::kNumber, value);
  }

  void word() {
    const std::size_t begin = at_;
    while (at_ < text_.size() &&
           (std::isalnum(static_cast<unsigned char>(text_[at_])) != 0 || text_[at_] == '_'))
      ++at_;
    std::string_view name = text_.substr(begin, at_ - begin);
    if (name == "t") return emit(Op::kTime);
    if (name == "pi" || name == "_pi") return emit(Op::kNumber, std::numbers::pi);
    if (name == "e" || name == "_e") return emit(Op::kNumber, std::numbers::e);
    if (name == "log") name = "ln";
    int code = static_cast<int>(Op::kMin);
    for (const Function& function : kFunctions) {
      if (name == function.name) return call(function, static_cast<Op>(code));
      ++code;
    }
    at_ = begin;
    fail("'" + std::string(name) + "' is neither t, pi, e nor a function");
  }

  void call(const Function& function, Op op) {
    if (!accept("("))
      return fail(std::string(function.name) + " wants its argument in parentheses");
    for (int k = 0; k < function.arguments; ++k) {
      if (k > 0 && !accept(",")) return fail(std::string(function.name) + " wants two arguments");
      choice();
    }
    if (!accept(")")) fail("')' is missing");
    emit(op);
  }

  std::string_view text_;
  std::size_t at_ = 0, depth_ = 0, waiting_ = 0;
  Expression out_;
  std::optional<Expression::Mistake> mistake_;
};

std::variant<Expression, Expression::Mistake> Expression::parse(std::string_view text) {
  return ExpressionParser(text).parse();
}

Jet Expression::evaluate(double t) const {
  std::array<Jet, kMostValues> stack;
  std::size_t top = 0;  // one past the last value
  for (const auto& [op, number] : program_) {
    if (op == Op::kNumber || op == Op::kTime) {
      stack[top++] = op == Op::kTime ? Jet{t, 1, 0} : Jet{number, 0, 0};
      continue;
    }
    if (op == Op::kChoose) {
      top -= 2;
      if (stack[top - 1].value != 0)
        stack[top - 1] = stack[top];
      else
        stack[top - 1] = stack[top + 1];
      continue;
    }
    if (op <= Op::kMax && op != Op::kNegate) --top;
    Jet& a = stack[top - 1];
    const Jet& b = stack[top];  // of operations on two
    const double x = a.value;
    const auto truth = [](bool holds) { return Jet{holds ? 1. : 0., 0, 0}; };
    switch (op) {
      case Op::kAdd:
        a = a + b;
        break;
      case Op::kSubtract:
        a = a - b;
        break;
      case Op::kMultiply:
        a = a * b;
        break;
      case Op::kDivide: {
        const double y = b.value;
        a = a * chain(b, 1 / y, -1 / (y * y), 2 / (y * y * y));
        break;
      }
      case Op::kPower:
        a = power(a, b);
        break;
      case Op::kNegate:
        a = Jet{} - a;
        break;
      case Op::kLess:
        a = truth(x < b.value);
        break;
      case Op::kLessEqual:
        a = truth(x <= b.value);
        break;
      case Op::kGreater:
        a = truth(x > b.value);
        break;
      case Op::kGreaterEqual:
        a = truth(x >= b.value);
        break;
      case Op::kEqual:
        a = truth(x == b.value);
        break;
      case Op::kUnequal:
        a = truth(x != b.value);
        break;
      case Op::kMin:
        if (b.value < x) a = b;
        break;
      case Op::kMax:
        if (b.value > x) a = b;
        break;
      case Op::kSin:
        a = chain(a, std::sin(x), std::cos(x), -std::sin(x));
        break;
      case Op::kCos:
        a = chain(a, std::cos(x), -std::sin(x), -std::cos(x));
        break;
      case Op::kTan: {
        const double f = std::tan(x), f1 = 1 + f * f;
        a = chain(a, f, f1, 2 * f * f1);
        break;
      }
      case Op::kAsin:
      case Op::kAcos: {
        const double sign = op == Op::kAsin ? 1 : -1, w = 1 - x * x, r = std::sqrt(w);
        a = chain(a, op == Op::kAsin ? std::asin(x) : std::acos(x), sign / r, sign * x / (w * r));
        break;
      }
      case Op::kAtan: {
        const double w = 1 / (1 + x * x);
        a = chain(a, std::atan(x), w, -2 * x * w * w);
        break;
      }
      case Op::kSinh:
        a = chain(a, std::sinh(x), std::cosh(x), std::sinh(x));
        break;
      case Op::kCosh:
        a = chain(a, std::cosh(x), std::sinh(x), std::cosh(x));
        break;
      case Op::kTanh: {
        const double f = std::tanh(x), f1 = 1 - f * f;
        a = chain(a, f, f1, -2 * f * f1);
        break;
      }
      case Op::kExp: {
        const double f = std::exp(x);
        a = chain(a, f, f, f);
        break;
      }
      case Op::kLn:
        a = chain(a, std::log(x), 1 / x, -1 / (x * x));
        break;
      case Op::kLog10: {
        const double c = 1 / std::numbers::ln10;
        a = chain(a, std::log10(x), c / x, -c / (x * x));
        break;
      }
      case Op::kSqrt: {
        const double f = std::sqrt(x);
        a = chain(a, f, 0.5 / f, -0.25 / (x * f));
        break;
      }
      case Op::kAbs:
        if (x < 0) a = Jet{} - a;
        break;
      case Op::kSign:
        a = {x > 0 ? 1. : x < 0 ? -1. : 0., 0, 0};
        break;
      case Op::kNumber:
      case Op::kTime:
      case Op::kChoose:
        break;  // done above
    }
  }
  return stack[0];
}

}  // namespace cprsim
