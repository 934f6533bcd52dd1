#include "catalog/method_call.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "catalog/methods.hpp"
#include "core/error.hpp"

namespace fw::catalog {
namespace {

/// What parsing, or making the method, is refused with; "accepted" where it is not.
std::string refusal_of(const std::string& text, bool make = false) {
  try {
    if (make) {
      make_method(text);
    } else {
      parse_method_call(text);
    }
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(MethodCall, OfAnotherProgramsNameIsToldOurs) {
  for (const char* name : {"euler",
                           "forward_euler",
                           "backward_euler",
                           "semi_implicit_euler",
                           "leapfrog",
                           "stormer_verlet",
                           "stoermer_verlet",
                           "crank_nicolson",
                           "runge_kutta",
                           "runge_kutta_4",
                           "rk2",
                           "rk23",
                           "ode23",
                           "rk45",
                           "ode45",
                           "dopri5",
                           "dopri853",
                           "dop853",
                           "rkf45",
                           "tsit5",
                           "vern6",
                           "radau",
                           "radau5",
                           "ode15s",
                           "lsoda",
                           "generalized_alpha",
                           "hht",
                           "avf",
                           "pbd",
                           "cvode_bdf",
                           "ida",
                           "ts_rosw",
                           "msbdf"}) {
    const std::string message = refusal_of(name, true);
    const std::string start = fmt::format("unknown method \"{}\"; it is called \"", name);
    ASSERT_TRUE(message.starts_with(start)) << message;
    const std::string ours = message.substr(start.size(), message.find('"', start.size()) - start.size());
    EXPECT_EQ(find_method(ours).name, ours);
  }
  EXPECT_TRUE(refusal_of("rk5", true).starts_with("unknown method \"rk5\"; did you mean"))
      << refusal_of("rk5", true);
}

TEST(MethodCall, IsANameAlone) {
  const MethodCall call = parse_method_call("rk4");
  EXPECT_EQ(call.name, "rk4");
  EXPECT_TRUE(call.options.empty());
}

TEST(MethodCall, HasOptionsInBrackets) {
  const MethodCall call =
      parse_method_call("implicit_euler_linearised[linear_solver=lu,tangent=psd_projection]");
  EXPECT_EQ(call.name, "implicit_euler_linearised");
  EXPECT_EQ(call.options, (MethodOptions{{"linear_solver", "lu"}, {"tangent", "psd_projection"}}));
}

TEST(MethodCall, KeepsEqualsSignsAndSpacesOfAValue) {
  const MethodCall call = parse_method_call("petsc:ts_theta[petsc=-ksp_type cg -pc_type=icc]");
  EXPECT_EQ(call.name, "petsc:ts_theta");
  EXPECT_EQ(call.options, (MethodOptions{{"petsc", "-ksp_type cg -pc_type=icc"}}));
}

TEST(MethodCall, HasNoEmptyBracketsAndNoEmptyValues) {
  const std::string form = "; expected name or name[option=value,option=value]";
  EXPECT_EQ(refusal_of("rk4[]"), "method \"rk4[]\": found [] without an option" + form);
  EXPECT_EQ(refusal_of("rkc2[stages=]"),
            "method \"rkc2[stages=]\": found option \"stages\" without a value" + form);
}

TEST(MethodCall, SaysWhatIsMalformed) {
  const std::string form = "; expected name or name[option=value,option=value]";
  EXPECT_EQ(refusal_of("rkc2[stages=5"), "method \"rkc2[stages=5\": found no closing ]" + form);
  EXPECT_EQ(refusal_of("rkc2[stages]"),
            "method \"rkc2[stages]\": found \"stages\" without option=value" + form);
  EXPECT_EQ(refusal_of("rkc2[=5]"), "method \"rkc2[=5]\": found \"=5\" without option=value" + form);
  EXPECT_EQ(refusal_of("rkc2[a=1,]"), "method \"rkc2[a=1,]\": found \"\" without option=value" + form);
  EXPECT_EQ(refusal_of("rkc2[a=1,a=2]"), "method \"rkc2[a=1,a=2]\": found option \"a\" twice" + form);
}

TEST(MethodCall, OfAnUnknownMethodOrOptionNamesTheKnownOnes) {
  EXPECT_NE(refusal_of("rk44", true).find("rk4"), std::string::npos) << refusal_of("rk44", true);
  const std::string refusal = refusal_of("rkc2[stage=5]", true);
  EXPECT_NE(refusal.find("\"stage\""), std::string::npos) << refusal;
  EXPECT_NE(refusal.find("stages"), std::string::npos) << refusal;
  EXPECT_EQ(refusal_of("rkc2[stages=5]", true), "accepted");
}

}  // namespace
}  // namespace fw::catalog
