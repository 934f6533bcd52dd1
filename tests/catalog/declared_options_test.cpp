#include "catalog/declared_options.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "catalog/integrator_options.hpp"
#include "catalog/oracle_options.hpp"
#include "core/error.hpp"

namespace fw::catalog {
namespace {

std::string refusal_of_call(const std::string& call) {
  try {
    make_method(call);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(DeclaredOptions, RefuseWhatIsWrongByMethodOptionFoundAndExpected) {
  const std::vector<std::pair<std::string, std::string>> calls = {
      {"rkc1[stages=1]",
       "method \"rkc1\": option stages: found \"1\", expected an integer from 2 to 500, or \"auto\""},
      {"rkc2[stages=Auto]",
       "method \"rkc2\": option stages: found \"Auto\", expected an integer from 2 to 500, or \"auto\""},
      {"implicit_euler_linearised[tangent=psd_projecton]",
       "method \"implicit_euler_linearised\": option tangent: found \"psd_projecton\", expected one of "
       "\"exact\", \"tensile_geometric_term\", \"psd_projection\"; did you mean \"psd_projection\"?"},
      {"implicit_euler_linearised[linear_tolerance=nan]",
       "method \"implicit_euler_linearised\": option linear_tolerance: found \"nan\", expected a finite "
       "number > 0 and <= 1"},
      {"sundials:cvode_bdf[max_order=6]",
       "method \"sundials:cvode_bdf\": option max_order: found \"6\", expected an integer from 1 to 5"},
      {"sundials:cvode_adams[krylov_dimension=2.5]",
       "method \"sundials:cvode_adams\": option krylov_dimension: found \"2.5\", expected an integer from 1 "
       "to 10000"},
      {"sundials:ida[tolerance_factr=1]",
       "method \"sundials:ida\": unknown option \"tolerance_factr\", expected one of tolerance_factor; did "
       "you mean \"tolerance_factor\"?"},
      {"sundials:arkode_mri[coupling=mis_kw4]",
       "method \"sundials:arkode_mri\": option coupling: found \"mis_kw4\", expected one of \"mis_kw3\", "
       "\"mri_gark_erk33a\", \"mri_gark_erk45a\"; did you mean \"mis_kw3\"?"},
      {"petsc:ts_theta[theta=0]",
       "method \"petsc:ts_theta\": option theta: found \"0\", expected a finite number > 0 and <= 1"},
      {"petsc:ts_theta[endpoint=true]",
       "method \"petsc:ts_theta\": option endpoint: found \"true\", expected one of \"no\", \"yes\""},
      {"petsc:ts_bdf[order=7]",
       "method \"petsc:ts_bdf\": option order: found \"7\", expected an integer from 1 to 6"},
      {"gsl:rk4[tolerance_factor=2]",
       "method \"gsl:rk4\": option tolerance_factor: found \"2\", expected a finite number > 0 and <= 1"},
      {"sundials:arkode_erk[table=cash_karp_6_4_5,tableau=rk4]",
       "method \"sundials:arkode_erk\": options table and tableau: found both, expected one of them"},
  };
  for (const auto& [call, message] : calls) EXPECT_EQ(refusal_of_call(call), message);
}

TEST(DeclaredOptions, ChangeTheMethod) {
  const auto read = [](const MethodOptions& given) {
    return read_options<integrators::RungeKuttaChebyshevOptions>(given).stages;
  };
  EXPECT_EQ(read({}), 8);
  EXPECT_EQ(read({{"stages", "13"}}), 13);
  EXPECT_EQ(read({{"stages", "auto"}}), 0);

  const auto mri = read_options<oracles::MriOptions>(
      {{"inner", "implicit"}, {"inner_table", "kvaerno_4_2_3"}, {"inner_steps", "0"}});
  EXPECT_TRUE(mri.inner_is_implicit);
  EXPECT_EQ(mri.inner_table, "kvaerno_4_2_3");
  EXPECT_EQ(mri.inner_steps, 0);
  EXPECT_THROW(read_options<oracles::MriOptions>({{"inner_table", "kvaerno_4_2_3"}}), InputError);

  const auto adams = read_options<CvodeCall>({{"nonlinear_solver", "newton"}, {"max_order", "12"}},
                                             {.formula = oracles::CvodeFormula::adams});
  EXPECT_EQ(adams.options.iteration, oracles::CvodeIteration::newton);
  EXPECT_EQ(adams.options.maximum_order, 12);

  EXPECT_EQ(make_method("rkc2[stages=13]")->info().stages, 13);
  EXPECT_THAT(make_method("sundials:arkode_mri[coupling=mis_kw3]")->info().title,
              ::testing::HasSubstr("mis_kw3"));
  EXPECT_TRUE(make_method("sundials:arkode_erk[table=verner_8_5_6]")->info().order == 6);
  EXPECT_EQ(make_method("petsc:ts_basicsymplectic[order=4]")->info().order, 4);
}

/// The defaults that are printed are those in force.
TEST(DeclaredOptions, HaveTheDefaultsThatTheyTell) {
  std::size_t count = 0;
  for (const MethodEntry& entry : methods()) {
    const MethodInfo& info = entry.info();
    for (const settings::SettingDescription& option : entry.options) {
      if (!option.default_value || !option.info.default_text.empty()) continue;
      const std::string text = default_text(option);
      if (text.empty()) continue;
      ++count;
      const MethodInfo given = make_method(MethodCall{entry.name, {{option.info.name, text}}})->info();
      EXPECT_EQ(given.title, info.title) << entry.name << ' ' << option.info.name;
      EXPECT_EQ(given.order, info.order) << entry.name << ' ' << option.info.name;
      EXPECT_EQ(given.stages, info.stages) << entry.name << ' ' << option.info.name;
    }
  }
  EXPECT_GT(count, 100u);
}

TEST(DeclaredOptions, HaveAMeaningAndARangeOrChoicesOrAreText) {
  for (const MethodEntry& entry : methods()) {
    for (const auto& [info, value] : entry.options) {
      EXPECT_FALSE(info.doc.empty()) << entry.name << ' ' << info.name;
      const bool has_range = std::isfinite(info.range.lowest) && std::isfinite(info.range.highest);
      const bool has_bounds = info.highest < std::numeric_limits<std::int64_t>::max();
      const bool is_said = info.type == settings::Type::number    ? has_range
                           : info.type == settings::Type::integer ? has_bounds
                                                                  : !info.choices.empty();
      EXPECT_TRUE(is_said || info.name == "petsc") << entry.name << ' ' << info.name;
    }
  }
}

}  // namespace
}  // namespace fw::catalog
