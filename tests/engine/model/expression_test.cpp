// SPDX-License-Identifier: BSD-3-Clause
#include "engine/model/expression.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

namespace cprsim {
namespace {

Expression parse(const std::string& text) {
  auto parsed = Expression::parse(text);
  const auto* mistake = std::get_if<Expression::Mistake>(&parsed);
  EXPECT_EQ(mistake, nullptr) << text << ": " << (mistake ? mistake->what : "");
  return mistake ? Expression() : std::get<Expression>(parsed);
}

std::size_t place_of_mistake(const std::string& text) {
  const auto parsed = Expression::parse(text);
  const auto* mistake = std::get_if<Expression::Mistake>(&parsed);
  EXPECT_NE(mistake, nullptr) << text.substr(0, 40);
  return mistake ? mistake->at : std::string::npos;
}

TEST(Expressions, MeanWhatTheyMeanOnPaper) {
  const double t = 0.7, pi = std::numbers::pi;
  const std::pair<const char*, double> cases[] = {
      {"2 + 3 * 4", 14},
      {"2 - 3 - 4", -5},
      {"16 / 4 / 2", 2},
      {"2 ^ 3 ^ 2", 512},
      {"-2 ^ 2", -4},
      {"2 ^ -1", 0.5},
      {"(2 + 3) * -4", -20},
      {"+1.5e-3", 1.5e-3},
      {"pi", pi},
      {"_pi - pi", 0},
      {"ln(e)", 1},
      {"log(e) + log10(100)", 3},
      {"sin(2 * pi * t)^2 + cos(2 * pi * t)^2", 1},
      {"t < 1 ? 3 : 4", 3},
      {"t >= 1 ? 3 : t > 0.5 ? 5 : 6", 5},
      {"(t != 2) + (t == 2) + (t <= 0.7)", 2},
      {"min(t, 0.5) + max(t, 1)", 1.5},
      {"abs(-t) - sqrt(t * t)", 0},
      {"sign(-2) * sign(3)", -1},
      {"exp(t) - (sinh(t) + cosh(t))", 0},
      {"tan(atan(t)) - asin(sin(t)) + acos(cos(t))", t},
      {" tanh ( 0 )\n", 0},
  };
  for (const auto& [text, value] : cases)
    EXPECT_NEAR(parse(text).evaluate(t).value, value, 1e-14) << text;
}

TEST(Expressions, AreDifferentiatedExactly) {
  const char* const formulas[] = {"3",
                                  "t",
                                  "t^3 - 2 * t",
                                  "1 / (1 + t)",
                                  "sin(3 * t) * cos(t^2)",
                                  "tan(t)",
                                  "asin(t)",
                                  "acos(t)",
                                  "atan(2 * t)",
                                  "sinh(t) / cosh(t)",
                                  "tanh(3 * t)",
                                  "exp(-t^2)",
                                  "ln(1 + t)",
                                  "log10(2 + t)",
                                  "sqrt(1 + t^2)",
                                  "t^1.5",
                                  "2^t",
                                  "(1 + t)^(2 - t)",
                                  "abs(t - 2)",
                                  "min(t, t^2) + max(sin(t), t)",
                                  "t < 0.5 ? t^2 : t^3"};
  const double h = 1e-5;
  for (const char* text : formulas) {
    const Expression f = parse(text);
    for (const double t : {0.13, 0.41, 0.77}) {
      const Jet a = f.evaluate(t - h), b = f.evaluate(t), c = f.evaluate(t + h);
      // central differences: h² times third derivatives, and round-off over h
      EXPECT_NEAR((c.value - a.value) / (2 * h), b.rate, 1e-8) << text << " at " << t;
      EXPECT_NEAR((c.rate - a.rate) / (2 * h), b.acceleration, 1e-7) << text << " at " << t;
    }
  }
}

TEST(Expressions, ArePowersAtZeroToo) {
  const Jet square = parse("t^2").evaluate(0), line = parse("t^1").evaluate(0);
  EXPECT_EQ(square.rate, 0);
  EXPECT_EQ(square.acceleration, 2);
  EXPECT_EQ(line.rate, 1);
  EXPECT_EQ(line.acceleration, 0);
}

TEST(Expressions, SayWhereTheyAreWrong) {
  EXPECT_EQ(place_of_mistake(""), 0u);
  EXPECT_EQ(place_of_mistake("2 +"), 3u);
  EXPECT_EQ(place_of_mistake("2 * (3 + t"), 10u);
  EXPECT_EQ(place_of_mistake("sine(t)"), 0u);
  EXPECT_EQ(place_of_mistake("2 x"), 2u);
  EXPECT_EQ(place_of_mistake("sin t"), 4u);
  EXPECT_EQ(place_of_mistake("min(1)"), 5u);
  EXPECT_EQ(place_of_mistake("t ? 1"), 5u);
  EXPECT_EQ(place_of_mistake("1e999"), 0u);
  EXPECT_EQ(place_of_mistake("."), 0u);
  EXPECT_EQ(place_of_mistake("2 # 3"), 2u);
}

// What would overflow a stack is refused instead.
TEST(Expressions, AreNeverTooDeepNorTooLong) {
  std::string tower = "t", sum = "t", right = "t";
  for (int k = 0; k < 1000; ++k) {
    tower += "^t";
    sum += "+t";
    right = "t+(" + right + ")";
  }
  EXPECT_LT(place_of_mistake(std::string(100000, '(')), 100u);
  EXPECT_LT(place_of_mistake(std::string(100000, '-') + "1"), 100u);
  EXPECT_LT(place_of_mistake(tower), 200u);
  EXPECT_LT(place_of_mistake(right), 200u);
  EXPECT_EQ(parse(sum).evaluate(1).value, 1001);
}

}  // namespace
}  // namespace cprsim
