#include "formula/expression.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "core/error.hpp"

namespace fw::formula {
namespace {

using testing::AllOf;
using testing::HasSubstr;

double value(const std::string& text, double t = 0.0) {
  return Expression(text)(t).value;
}

std::string message(const std::string& text) {
  try {
    const Expression expression(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Expression, BindsAsMathematicsDoes) {
  EXPECT_EQ(value("1+2*3"), 7.0);
  EXPECT_EQ(value("(1 + 2)*3"), 9.0);
  EXPECT_EQ(value("-2^2"), -4.0);
  EXPECT_EQ(value("2^3^2"), 512.0);
  EXPECT_EQ(value("2^-1"), 0.5);
  EXPECT_EQ(value("8/4/2"), 1.0);
  EXPECT_EQ(value("8-4-2"), 2.0);
  EXPECT_EQ(value("2*-t", 3.0), -6.0);
  EXPECT_EQ(value(" 1.5e-3 *\t.5e3"), 0.75);
  EXPECT_EQ(value("--+1"), 1.0);
}

struct Case {
  const char* text;
  double (*expected)(double t);
};

/// The rates are held against differences of the values in binary128, which know nothing of the rules.
TEST(Expression, HasValuesAndDerivativesOfEveryFunction) {
  const Case cases[] = {
      {"sqrt(1+t^2)", [](double t) { return std::sqrt(1 + t * t); }},
      {"exp(-t)*sin(2*pi*t)", [](double t) { return std::exp(-t) * std::sin(2 * std::numbers::pi * t); }},
      {"log(2+t)", [](double t) { return std::log(2 + t); }},
      {"cos(t)/(1+t)", [](double t) { return std::cos(t) / (1 + t); }},
      {"tan(t/3)", [](double t) { return std::tan(t / 3); }},
      {"sinh(t)-cosh(t/2)", [](double t) { return std::sinh(t) - std::cosh(t / 2); }},
      {"tanh(3*(t-1))", [](double t) { return std::tanh(3 * (t - 1)); }},
      {"abs(t-1)", [](double t) { return std::abs(t - 1); }},
      {"min(t, 1-t)", [](double t) { return std::min(t, 1 - t); }},
      {"max(t, 1-t)", [](double t) { return std::max(t, 1 - t); }},
      {"t^t", [](double t) { return std::pow(t, t); }},
      {"2^t", [](double t) { return std::pow(2, t); }},
      {"t^3 - 4*t^0", [](double t) { return t * t * t - 4; }}};
  for (const Case& one : cases) {
    const Expression expression(one.text);
    for (const double t : {0.3, 0.7, 1.9}) {
      const Jet<double> found = expression(t);
      const Float128 delta = 1e-10;
      const Float128 slope =
          (expression(Float128(t) + delta).value - expression(Float128(t) - delta).value) / (2 * delta);
      EXPECT_NEAR(found.value, one.expected(t), 4e-15 * (1 + std::abs(found.value)))
          << one.text << " at " << t;
      EXPECT_NEAR(found.rate, static_cast<double>(slope), 1e-13 * (1 + std::abs(found.rate)))
          << one.text << " at " << t;
      EXPECT_NEAR(static_cast<double>(expression(Float128(t)).value), found.value, 1e-14) << one.text;
    }
  }
}

TEST(Expression, IsAsExactAsItsArithmetic) {
  const Float128 t = Float128(1) / 3;
  EXPECT_LT(abs(Expression("sin(t)^2 + cos(t)^2")(t).value - 1), 4 * float128_epsilon);
}

TEST(Expression, KeepsDerivativesOfConstantsAtZero) {
  EXPECT_EQ(Expression("sqrt(0)+0^0.5+t")(0.0).rate, 1.0);
  EXPECT_EQ(Expression("t^2")(0.0).rate, 0.0);
}

TEST(Expression, KnowsItsKinks) {
  EXPECT_TRUE(Expression("sin(t)").is_smooth());
  for (const char* text : {"abs(t)", "1 + min(t,2)", "max(1,2)*t"})
    EXPECT_FALSE(Expression(text).is_smooth());
}

TEST(Expression, SaysPlaceFoundAndExpected) {
  EXPECT_THAT(message(""),
              AllOf(HasSubstr("character 1"), HasSubstr("found the end"), HasSubstr("expected a number")));
  EXPECT_THAT(message("1 + * 2"), AllOf(HasSubstr("character 5"), HasSubstr("found \"*\"")));
  EXPECT_THAT(message("sin t"),
              AllOf(HasSubstr("character 5"), HasSubstr("found \"t\""), HasSubstr("\"(\" after sin")));
  EXPECT_THAT(message("2*x"),
              AllOf(HasSubstr("character 3"), HasSubstr("found \"x\""), HasSubstr("sqrt exp log")));
  EXPECT_THAT(message("max(1)"), AllOf(HasSubstr("character 6"), HasSubstr("max has 2 arguments")));
  EXPECT_THAT(message("sin(1,2)"), AllOf(HasSubstr("found \",\""), HasSubstr("expected \")\"")));
  EXPECT_THAT(message("(1"), AllOf(HasSubstr("found the end"), HasSubstr("expected \")\"")));
  EXPECT_THAT(message("1 2"), AllOf(HasSubstr("character 3"), HasSubstr("an operator or the end")));
  EXPECT_THAT(message("1e999"), HasSubstr("range of double precision"));
  EXPECT_THAT(message("."), HasSubstr("character 1"));
  EXPECT_THAT(message("2·t"), AllOf(HasSubstr("character 2"), HasSubstr("found \"·\"")));
}

TEST(Expression, RefusesWhatIsTooDeep) {
  EXPECT_THAT(message(std::string(100000, '(')), HasSubstr("nested"));
  EXPECT_THAT(message(std::string(100000, '-') + "1"), HasSubstr("nested"));
  std::string waiting = "1";
  for (int k = 0; k < 80; ++k) waiting = "1+(" + waiting + ")";
  EXPECT_THAT(message(waiting), HasSubstr("wait for an operator"));
  std::string power = "1";
  for (int k = 0; k < 200; ++k) power += "^1";
  EXPECT_THAT(message(power), HasSubstr("wait for an operator"));
  EXPECT_LT(message(power).size(), 250u);  // quotes the beginning only
  std::string wide = "1";
  for (int k = 0; k < 5000; ++k) wide += "+1";
  EXPECT_EQ(value(wide), 5001.0);
}

}  // namespace
}  // namespace fw::formula
