#include "study/work_precision/work_precision.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "catalog/study_kinds.hpp"
#include "core/error.hpp"
#include "memory_archive.hpp"
#include "seeded_catalog.hpp"
#include "study/runner.hpp"

namespace fw::study {
namespace {

using testing::HasSubstr;

const std::string duffing = "[[problem]]\nname = \"driven_duffing\"\nt_end = 2.3\n";

std::string spec(const std::string& methods, const std::string& problems = duffing,
                 const std::string& keys = "") {
  return "kind = \"work_precision\"\ntitle = \"test\"\nmethods = [" + methods +
         "]\n[work_precision]\nmax_evaluations = 6000\nrepetitions = 2\nshortest_sample = 1e-5\n" + keys +
         problems;
}

Plan plan_of(const std::string& text, const Catalog& catalog, bool quick = false) {
  return read_plan(CheckedTable::parse_text(text, "ladders.toml"), catalog::study_kinds(), catalog, quick);
}

StudyResult run(const std::string& text, const Catalog& catalog, MemoryArchive& archive) {
  return run_plan(plan_of(text, catalog), archive, {});
}

const CaseResult& find(const StudyResult& study, const std::string& id) {
  for (const CaseResult& result : study.cases) {
    if (result.id == id) return result;
  }
  throw std::logic_error("no case " + id);
}

TEST(WorkPrecision, EfficiencyOrdersHoldForConstantStepsAndAreNoClaimForOthers) {
  MemoryArchive archive;
  const StudyResult study = run(spec("\"rk4\", \"velocity_verlet\", \"kutta3\", \"dormand_prince_54\""),
                                SeededCatalog({}), archive);
  for (const char* id :
       {"driven_duffing-rk4-fixed", "driven_duffing-velocity_verlet-fixed", "driven_duffing-kutta3-fixed"}) {
    EXPECT_EQ(find(study, id).verdict, Verdict::holds) << id << ": " << find(study, id).reason;
  }
  EXPECT_EQ(find(study, "driven_duffing-dormand_prince_54-adaptive").verdict, Verdict::not_applicable);
}

/// Another integrator under a name, with what it says of itself changed.
class Renamed final : public Integrator {
 public:
  Renamed(std::unique_ptr<Integrator> inner, int claimed) : inner_(std::move(inner)), info_(inner_->info()) {
    info_.order = info_.order_with_velocity_forces = claimed;
  }
  const MethodInfo& info() const override { return info_; }
  const ExtendedSolver& extended_solver() const override { return inner_->extended_solver(); }

 private:
  Solution do_solve(const Ivp& ivp, const StepControl& control, Observer& observer,
                    const SolveOptions& options) const override {
    return inner_->solve(ivp, control, observer, options);
  }
  std::unique_ptr<Integrator> inner_;
  MethodInfo info_;
};

TEST(WorkPrecision, FailsASchemeThatClaimsAnotherOrder) {
  Seeds seeds;
  seeds["too_high"] = [] { return std::make_unique<Renamed>(catalog::make_method("heun3"), 4); };
  seeds["too_low"] = [] { return std::make_unique<Renamed>(catalog::make_method("heun3"), 2); };
  seeds["right"] = [] { return std::make_unique<Renamed>(catalog::make_method("heun3"), 3); };
  MemoryArchive archive;
  const StudyResult study = run(spec("\"too_high\", \"too_low\", \"right\""), SeededCatalog(seeds), archive);
  EXPECT_EQ(find(study, "driven_duffing-too_high-fixed").verdict, Verdict::fails);
  EXPECT_EQ(find(study, "driven_duffing-too_low-fixed").verdict, Verdict::fails);
  EXPECT_EQ(find(study, "driven_duffing-right-fixed").verdict, Verdict::holds)
      << find(study, "driven_duffing-right-fixed").reason;
}

TEST(WorkPrecision, CallsAnOrderAboveTheClaimSuperconvergenceOnLinearProblemsOnly) {
  Seeds seeds;
  seeds["too_high"] = [] { return std::make_unique<Renamed>(catalog::make_method("heun3"), 4); };
  seeds["too_low"] = [] { return std::make_unique<Renamed>(catalog::make_method("heun3"), 2); };
  const std::string both = "[[problem]]\nname = \"harmonic_oscillator\"\nt_end = 3.1\n" + duffing;
  MemoryArchive archive;
  const StudyResult study = run(spec("\"too_high\", \"too_low\"", both), SeededCatalog(seeds), archive);
  const CaseResult& above = find(study, "harmonic_oscillator-too_low-fixed");
  EXPECT_EQ(above.verdict, Verdict::not_applicable) << above.reason;
  EXPECT_THAT(above.reason, HasSubstr("superconvergence on a linear problem"));
  EXPECT_EQ(find(study, "driven_duffing-too_low-fixed").verdict, Verdict::fails);
  EXPECT_EQ(find(study, "harmonic_oscillator-too_high-fixed").verdict, Verdict::fails);
}

TEST(WorkPrecision, SaysNothingOfPowersWhereStepsDoNotResolveTheFastestMotion) {
  MemoryArchive archive;
  const StudyResult study = run(
      spec("\"radau_iia2\"", "[[problem]]\nname = \"prothero_robinson\"\nparameters = { lambda = -1e5 }\n"),
      SeededCatalog({}), archive);
  const CaseResult& result = find(study, "prothero_robinson-radau_iia2-fixed");
  EXPECT_EQ(result.verdict, Verdict::not_applicable) << result.reason;
}

TEST(WorkPrecision, KeepsEverySampleAndTheirMinimum) {
  MemoryArchive archive;
  const StudyResult study = run(spec("\"rk4\""), SeededCatalog({}), archive);
  const CaseResult& result = find(study, "driven_duffing-rk4-fixed");
  const std::vector<double> seconds = numbers_of(result, "seconds"),
                            samples = numbers_of(result, "seconds_samples");
  ASSERT_GT(seconds.size(), 5u);
  ASSERT_EQ(samples.size(), 2 * seconds.size());
  for (std::size_t k = 0; k < seconds.size(); ++k) {
    EXPECT_EQ(seconds[k], std::fmin(samples[2 * k], samples[2 * k + 1]));
    EXPECT_GT(seconds[k], 0.0);
  }
  const std::vector<double> evaluations = numbers_of(result, "rhs_evaluations");
  for (std::size_t k = 1; k < evaluations.size(); ++k) EXPECT_GT(evaluations[k], evaluations[k - 1]);
}

TEST(WorkPrecision, DrawsTheFrontOfAllMethodsAndDrawsItAgainFromKeptCases) {
  MemoryArchive archive;
  const std::string text = spec("\"rk4\", \"dormand_prince_853\", \"explicit_euler\"");
  const SeededCatalog catalog({});
  StudyResult first = run(text, catalog, archive);
  const auto front_of = [](const StudyResult& study) {
    const CaseResult& front = find(study, "driven_duffing-front");
    return std::pair{numbers_of(front, "front_rhs_evaluations"),
                     numbers_of(front, "front_rhs_evaluations_error")};
  };
  const auto [costs, errors] = front_of(first);
  ASSERT_GE(costs.size(), 2u);
  std::int64_t counted = 0;
  for (const CaseResult& result : first.cases) {
    if (result.id.ends_with("front")) continue;
    counted += std::get<std::int64_t>(cell_of(result, "front_points_rhs_evaluations").value);
    const std::vector<double> work = numbers_of(result, "rhs_evaluations"),
                              error = numbers_of(result, "error");
    for (std::size_t k = 0; k < work.size(); ++k) {
      bool reached = false;
      for (std::size_t j = 0; j < costs.size(); ++j)
        reached = reached || (costs[j] <= work[k] && errors[j] <= error[k]);
      EXPECT_TRUE(reached) << result.id << " is below the front";
    }
  }
  EXPECT_EQ(counted, static_cast<std::int64_t>(costs.size()));
  EXPECT_EQ(front_of(run(text, catalog, archive)), front_of(first));
  plan_of(text, catalog).conclude(first);
  EXPECT_EQ(front_of(first), (std::pair{costs, errors}));
}

TEST(WorkPrecision, GivesTheSameNumbersWithTwoJobs) {
  const SeededCatalog catalog({});
  MemoryArchive one, two;
  const Plan plan = plan_of(spec("\"rk4\", \"dormand_prince_54\", \"implicit_midpoint\""), catalog);
  const StudyResult serial = run_plan(plan, one, {});
  RunOptions options;
  options.jobs = 2;
  const StudyResult parallel = run_plan(plan, two, options);
  for (std::size_t k = 0; k < serial.cases.size(); ++k) {
    if (serial.cases[k].id.ends_with("front")) continue;
    for (const char* name : {"error", "rhs_evaluations", "newton_iterations", "factorisations"}) {
      EXPECT_EQ(numbers_of(serial.cases[k], name), numbers_of(parallel.cases[k], name));
    }
    EXPECT_TRUE(plan.cases[k].is_timed);
  }
}

TEST(WorkPrecision, NamesTheKeyOfAWrongSetting) {
  const SeededCatalog catalog({});
  for (const auto& [key, message] : {std::pair{"step_ratio = 1.0\n", "step_ratio"},
                                     {"levels = 0\n", "levels"},
                                     {"control = \"none\"\n", "control"},
                                     {"control = \"adaptive\"\n", "no method that can run"},
                                     {"start_error = 1e-9\nfinest_error = 1e-3\n", "finest_error"},
                                     {"start_error = 1e-13\n", "start_error"},
                                     {"reference = \"binary32\"\n", "reference"}}) {
    try {
      plan_of(spec("\"rk4\"", duffing, key), catalog);
      FAIL() << key;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(message));
    }
  }
}

}  // namespace
}  // namespace fw::study
