#include "study/kinds/agreement.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "catalog/study_kinds.hpp"
#include "core/error.hpp"
#include "mechanics/mass_spring_system.hpp"
#include "memory_archive.hpp"
#include "paths.hpp"
#include "seeded_catalog.hpp"
#include "study/runner.hpp"

namespace fw::study {
namespace {

using testing::HasSubstr;

/// A solver that is right, of a system that is not: every stiffness is off by a small factor.
class SolverOfAnotherSystem final : public Integrator {
 public:
  explicit SolverOfAnotherSystem(double factor)
      : inner_(catalog::make_method("dormand_prince_54")), factor_(factor), info_(inner_->info()) {
    info_.name = "wrong";
  }
  const MethodInfo& info() const override { return info_; }
  const ExtendedSolver& extended_solver() const override { return inner_->extended_solver(); }

 private:
  Solution do_solve(const Ivp& ivp, const StepControl& control, Observer& observer,
                    const SolveOptions& options) const override {
    Ivp other = ivp;
    if (const auto* springs = dynamic_cast<const mechanics::MassSpringSystem*>(ivp.system.get())) {
      mechanics::MassSpringModel model = springs->model();
      for (double& stiffness : model.springs.stiffness) stiffness *= factor_;
      other.system = std::make_shared<const mechanics::MassSpringSystem>(std::move(model));
    }
    return inner_->solve(other, control, observer, options);
  }

  std::unique_ptr<Integrator> inner_;
  double factor_;
  MethodInfo info_;
};

StudyResult run(const std::string& methods, const std::string& problem, const Seeds& seeds = {},
                const std::string& more = "", bool quick = false) {
  const std::string text = "kind = \"agreement\"\ntitle = \"test\"\nmethods = [" + methods + "]\n" + more +
                           "[agreement]\nerror = 1e-7\nmost_steps = 2048\n[[problem]]\n" + problem;
  const SeededCatalog catalog(seeds);
  const Plan plan =
      read_plan(CheckedTable::parse_text(text, "agreement.toml"), catalog::study_kinds(), catalog, quick);
  MemoryArchive archive;
  return run_plan(plan, archive, {});
}

template <class Value>
const std::vector<Value>& values(const CaseResult& result, const std::string& name) {
  for (const Column& column : result.columns) {
    if (column.name == name) return std::get<std::vector<Value>>(column.values);
  }
  throw std::logic_error("no column " + name);
}

const std::string cloth = "name = \"small_cloth\"\nt_end = 0.2\n";

TEST(Agreement, HoldsAcrossFamiliesAndLibraries) {
  const StudyResult study = run(
      "\"rk4\", \"velocity_verlet\", \"sdirk2\", \"explicit_euler\", \"gsl:rk8pd\", \"sundials:cvode_bdf\"",
      cloth);
  ASSERT_EQ(study.cases.size(), 1u);
  const CaseResult& result = study.cases.front();
  EXPECT_EQ(result.verdict, Verdict::holds) << result.reason;
  const auto& names = values<std::string>(result, "method");
  ASSERT_EQ(names.size(), 7u);
  EXPECT_EQ(names.front(), "certified");
  const auto& difference = values<double>(result, "difference");
  for (std::size_t i = 0; i < 7; ++i) {
    EXPECT_EQ(difference[8 * i], 0.0);
    for (std::size_t j = 0; j < 7; ++j) EXPECT_EQ(difference[7 * i + j], difference[7 * j + i]);
  }
}

TEST(Agreement, SeesASolverWhoseStiffnessIsOffByAHundredThousandth) {
  const Seeds seeds{{"wrong", [] { return std::make_unique<SolverOfAnotherSystem>(1.0 + 1e-5); }},
                    {"right", [] { return std::make_unique<SolverOfAnotherSystem>(1.0); }}};
  const StudyResult right = run("\"rk4\", \"right\"", cloth, seeds);
  EXPECT_EQ(right.cases.front().verdict, Verdict::holds) << right.cases.front().reason;
  const StudyResult wrong = run("\"rk4\", \"wrong\"", cloth, seeds);
  const CaseResult& result = wrong.cases.front();
  EXPECT_EQ(result.verdict, Verdict::fails);
  EXPECT_THAT(result.reason, HasSubstr("wrong"));
  // It disagrees with the reference and with rk4, which agree with each other.
  EXPECT_EQ(values<std::int64_t>(result, "agrees"),
            (std::vector<std::int64_t>{-1, 1, 0, 1, -1, 0, 0, 0, -1}));
}

TEST(Agreement, BelievesEstimatesLessWhereForcesHaveKinks) {
  const std::string rope =
      "scene = \"" + fw::test::source_directory() + "/studies/scenes/short_rope.toml\"\nt_end = 0.43\n";
  const auto judged = [&](double factor) {
    const Seeds seeds{{"wrong", [=] { return std::make_unique<SolverOfAnotherSystem>(factor); }}};
    return run("\"dormand_prince_54\", \"wrong\"", rope, seeds, "").cases.front();
  };
  EXPECT_EQ(judged(1.0 + 1e-2).verdict, Verdict::fails) << judged(1.0 + 1e-2).reason;
  EXPECT_NE(judged(1.0).verdict, Verdict::fails) << judged(1.0).reason;
}

TEST(Agreement, NamesMethodsThatStayTooInaccurateAndLeavesOutThoseThatCannotRun) {
  const StudyResult study =
      run("\"rk4\", \"explicit_euler\", \"velocity_verlet\"", "name = \"rotation\"\nt_end = 12.0\n");
  const CaseResult& result = study.cases.front();
  EXPECT_EQ(result.verdict, Verdict::holds) << result.reason;
  EXPECT_EQ(values<std::string>(result, "method"),
            (std::vector<std::string>{"exact", "rk4", "explicit_euler"}));
  EXPECT_EQ(values<std::int64_t>(result, "compared"), (std::vector<std::int64_t>{1, 1, 0}));
  EXPECT_THAT(result.reason, HasSubstr("not accurate enough to compare: explicit_euler"));
}

TEST(Agreement, ReadsPatternsOfMethods) {
  const StudyResult study = run("\"gsl:rk*\", \"rk4\", \"gsl:rk4\"", "name = \"harmonic_oscillator\"\n", {},
                                "without = [\"gsl:rk*imp\"]\n");
  EXPECT_EQ(
      values<std::string>(study.cases.front(), "method"),
      (std::vector<std::string>{"exact", "gsl:rk2", "gsl:rk4", "gsl:rkf45", "gsl:rkck", "gsl:rk8pd", "rk4"}));
}

std::string refusal(const std::string& methods, const std::string& more = "") {
  try {
    run(methods, "name = \"harmonic_oscillator\"\n", {}, more);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Agreement, RefusesPatternsWithoutMeaning) {
  EXPECT_THAT(refusal("\"gls:*\""),
              HasSubstr("agreement.toml:3: methods[0]: found \"gls:*\", which no method fits"));
  EXPECT_THAT(refusal("\"rk4\", \"rk5\""), HasSubstr("methods[1]: unknown method \"rk5\""));
  EXPECT_THAT(refusal("\"rk4\"", "without = [\"heun\"]\n"), HasSubstr("without[0]: found \"heun\""));
  EXPECT_THAT(refusal("\"rk4\", \"petsc:ts_theta[petsc=-ksp_tpye cg]\""), HasSubstr("methods[1]"));
  EXPECT_THAT(refusal("\"rk4\"", "without = [\"rk4\"]\n"), HasSubstr("methods: found no method"));
}

}  // namespace
}  // namespace fw::study
