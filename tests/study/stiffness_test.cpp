#include "study/stiffness/stiffness.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "catalog/study_kinds.hpp"
#include "core/error.hpp"
#include "memory_archive.hpp"
#include "seeded_catalog.hpp"
#include "study/measure/work_columns.hpp"
#include "study/runner.hpp"

namespace fw::study {
namespace {

using testing::HasSubstr;

std::string spec(const std::string& methods, const std::string& measure, const std::string& values,
                 const std::string& keys = "") {
  return "kind = \"stiffness\"\ntitle = \"test\"\nmethods = [" + methods + "]\n[stiffness]\nmeasure = \"" +
         measure + "\"\nrepetitions = 2\nshortest_sample = 1e-5\n" + keys +
         "[[problem]]\nname = \"prothero_robinson\"\nvary = { parameter = \"lambda\", values = [" + values +
         "] }\n";
}

StudyResult run(const std::string& text, const Catalog& catalog) {
  const Plan plan =
      read_plan(CheckedTable::parse_text(text, "stiff.toml"), catalog::study_kinds(), catalog, false);
  MemoryArchive archive;
  return run_plan(plan, archive, {});
}

const CaseResult& find(const StudyResult& study, const std::string& end) {
  for (const CaseResult& result : study.cases) {
    if (result.id == "prothero_robinson-" + end) return result;
  }
  throw std::logic_error("no case " + end);
}

double figure(const CaseResult& result, const std::string& name) {
  return std::get<double>(cell_of(result, name).value);
}

const std::string decades = "-1.0, -1e4, -1e6, -1e8, -1e10";

TEST(Stiffness, ObservedOrdersAreThePredictedOnesFarOutAndTheClassicalOnesNearby) {
  const StudyResult study =
      run(spec("\"implicit_midpoint\", \"sdirk2\", \"gauss2\", \"radau_iia2\", \"ros3p\"", "orders", decades),
          SeededCatalog({}));
  for (const auto& [method, classical, stiff] : {std::tuple{"implicit_midpoint", 2.0, 2.0},
                                                 {"sdirk2", 2.0, 1.0},
                                                 {"gauss2", 4.0, 2.0},
                                                 {"radau_iia2", 3.0, 2.0},
                                                 {"ros3p", 3.0, 2.0}}) {
    const CaseResult& result = find(study, std::string(method) + "-orders");
    EXPECT_EQ(result.verdict, Verdict::holds) << method << ": " << result.reason;
    EXPECT_NEAR(figure(result, "nonstiff_order"), classical, 0.1) << method;
    EXPECT_EQ(figure(result, "predicted_stiff_order"), stiff) << method;
    EXPECT_NEAR(figure(result, "stiff_order"), stiff, 0.1) << method;
  }
}

TEST(Stiffness, FailsASchemeThatFallsToALowerOrderThanItsCoefficientsSay) {
  // Both have order 2; far out TR-BDF2 keeps it and SDIRK2 falls to 1.
  const StudyResult study = run(spec("\"tr_bdf2\"", "orders", decades),
                                SeededCatalog({{"tr_bdf2", [] { return catalog::make_method("sdirk2"); }}}));
  const CaseResult& result = find(study, "tr_bdf2-orders");
  EXPECT_EQ(result.verdict, Verdict::fails) << result.reason;
  EXPECT_NEAR(figure(result, "stiff_order"), 1.0, 0.1);
  EXPECT_NEAR(figure(result, "nonstiff_order"), 2.0, 0.1);
}

TEST(Stiffness, FailsASchemeWhoseOrderIsWrongWhereNothingIsStiff) {
  const StudyResult study =
      run(spec("\"radau_iia2\"", "orders", decades),
          SeededCatalog({{"radau_iia2", [] { return catalog::make_method("tr_bdf2"); }}}));
  // The seed tells its own order 2; the coefficients of Radau IIA predict 2 far out as well.
  EXPECT_EQ(find(study, "radau_iia2-orders").verdict, Verdict::holds);
  const StudyResult other = run(spec("\"gauss3\"", "orders", decades),
                                SeededCatalog({{"gauss3", [] { return catalog::make_method("gauss2"); }}}));
  EXPECT_EQ(find(other, "gauss3-orders").verdict, Verdict::fails);
}

const std::string rising = "-1e2, -3e2, -1e3, -3e3, -1e4, -3e4";

TEST(Stiffness, StepsOfAnExplicitSchemeGrowLikeTheEigenvalue) {
  const StudyResult study = run(spec("\"rk4\", \"implicit_euler\"", "cost", rising), SeededCatalog({}));
  const CaseResult& rk4 = find(study, "rk4-cost");
  EXPECT_EQ(rk4.verdict, Verdict::holds) << rk4.reason;
  EXPECT_NEAR(figure(rk4, "step_exponent"), 1.0, 0.1);
  const CaseResult& implicit_euler = find(study, "implicit_euler-cost");
  EXPECT_EQ(implicit_euler.verdict, Verdict::not_applicable);
  EXPECT_LE(std::abs(figure(implicit_euler, "step_exponent")), 0.1) << "its steps do not see the stiffness";
  EXPECT_EQ(text_of(rk4, "stepping"), "explicit");
  EXPECT_EQ(text_of(implicit_euler, "stepping"), "implicit");
  for (const double error : numbers_of(rk4, "error")) EXPECT_LE(error, 0.01);
}

TEST(Stiffness, FailsAnExplicitSchemeThatStabilityDoesNotLimitAsItShould) {
  // Stages that grow with the step: steps ~ |lambda|^(1/2) or less.
  const StudyResult study =
      run(spec("\"rk4\"", "cost", rising),
          SeededCatalog({{"rk4", [] { return catalog::make_method("rkc2[stages=auto]"); }}}));
  EXPECT_EQ(find(study, "rk4-cost").verdict, Verdict::fails) << find(study, "rk4-cost").reason;
}

TEST(Stiffness, DoesNotJudgeStepsThatAccuracyLimits) {
  // The slow end: the first run does, or its error is what takes steps; |lambda| h stays far inside the interval.
  const StudyResult study =
      run(spec("\"rk4\", \"heun3\"", "cost", "-0.1, -0.2, -0.4, -0.8", "target_error = 1e-9\n"),
          SeededCatalog({}));
  const StudyResult loose =
      run(spec("\"rk4\"", "cost", "-0.1, -0.2, -0.4, -0.8", "target_error = 0.5\n"), SeededCatalog({}));
  EXPECT_EQ(find(study, "rk4-cost").verdict, Verdict::not_applicable) << find(study, "rk4-cost").reason;
  EXPECT_EQ(find(study, "heun3-cost").verdict, Verdict::not_applicable) << find(study, "heun3-cost").reason;
  EXPECT_EQ(find(loose, "rk4-cost").verdict, Verdict::not_applicable) << find(loose, "rk4-cost").reason;
  EXPECT_THAT(find(loose, "rk4-cost").reason,
              testing::AnyOf(HasSubstr("no coarser run"), HasSubstr("where accuracy does")));
}

TEST(Stiffness, FindsWhereImplicitStepsBeginToPay) {
  const StudyResult study = run(
      spec("\"rk4\", \"implicit_euler\"", "cost", "-1.0, -1e1, -1e2, -1e3, -1e4, -1e5"), SeededCatalog({}));
  const CaseResult& overview = find(study, "overview");
  EXPECT_THAT(overview.reason, HasSubstr("by operations"));
  const std::vector<double> plain = numbers_of(overview, "cheapest_explicit_cost"),
                            implicit = numbers_of(overview, "cheapest_implicit_cost");
  ASSERT_EQ(plain.size(), 6u);
  EXPECT_LT(plain.front(), implicit.front());
  EXPECT_GT(plain.back(), implicit.back());
  const std::vector<double> index = numbers_of(overview, "stiffness_index");
  EXPECT_NEAR(index.back(), 1.3e5, 1.0);
}

TEST(Stiffness, CrossesAtThePositiveParameter) {
  const StudyResult study =
      run("kind = \"stiffness\"\ntitle = \"test\"\nmethods = [\"velocity_verlet\", \"generalised_alpha\"]\n"
          "[stiffness]\nmeasure = \"cost\"\nrepetitions = 2\nshortest_sample = 1e-5\n"
          "[[problem]]\nname = \"spring_pendulum\"\nlabel = \"prothero_robinson\"\n"
          "vary = { parameter = \"stiffness\", from = 1e4, to = 1e8, count = 5 }\n",
          SeededCatalog({}));
  const CaseResult& overview = find(study, "overview");
  const double crossing = figure(overview, "crossing_cost");
  EXPECT_GT(crossing, 1e4) << overview.reason;
  EXPECT_LT(crossing, 1e8);
  EXPECT_LE(figure(overview, "crossing_cost_low"), crossing);
  EXPECT_GE(figure(overview, "crossing_cost_high"), crossing);
}

TEST(OperationCosts, SumUpWhatARunHasDone) {
  Work work;
  work.rhs_evaluations = 10;
  work.jacobian_evaluations = 2;
  work.factorisations = 1;
  work.linear_solves = 5;
  const OperationCosts costs;
  EXPECT_EQ(costs.of(work), 10.0 + 2 * costs.jacobian + costs.factorisation + 5 * costs.linear_solve);
  work.linear_iterations = 100;  // solves by iteration count by their iterations
  EXPECT_EQ(costs.of(work), 10.0 + 2 * costs.jacobian + costs.factorisation + 100 * costs.linear_iteration);
}

}  // namespace
}  // namespace fw::study
