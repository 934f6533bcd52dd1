#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "catalog/study_kinds.hpp"
#include "core/error.hpp"
#include "linalg/linear_solver.hpp"
#include "memory_archive.hpp"
#include "seeded_catalog.hpp"
#include "study/linear_solver/linear_solver.hpp"
#include "study/runner.hpp"

namespace fw::study {
namespace {

using testing::HasSubstr;

StudyResult run(const std::string& solvers, const std::string& problem, const std::string& keys = "") {
  const std::string text = "kind = \"linear_solver\"\ntitle = \"test\"\nsolvers = [" + solvers +
                           "]\n[linear_solver]\nsteps = [0.01]\nrepetitions = 2\nsequence = 4\n" + keys +
                           "[[problem]]\n" + problem;
  const catalog::BuiltinCatalog catalog;
  const Plan plan =
      read_plan(CheckedTable::parse_text(text, "solvers.toml"), catalog::study_kinds(), catalog, false);
  MemoryArchive archive;
  return run_plan(plan, archive, {});
}

double figure(const CaseResult& result, const std::string& name) {
  for (const SummaryCell& cell : result.summary) {
    if (cell.name == name) return std::get<double>(cell.value);
  }
  throw std::logic_error("no figure " + name);
}

const std::string cloth = "name = \"small_cloth\"\nparameters = { count = 6, stiffness = 1000 }\n";

TEST(LinearSolverStudy, FindsTheSameSolutionWithEverySolver) {
  std::string solvers;
  for (const linalg::LinearSolverInfo& info : linalg::linear_solvers()) {
    solvers += (solvers.empty() ? "\"" : ", \"") + info.name + "\"";
  }
  const StudyResult study = run(solvers, cloth);
  ASSERT_EQ(study.cases.size(), 1 + linalg::linear_solvers().size());
  for (const CaseResult& result : study.cases) {
    EXPECT_EQ(result.verdict, Verdict::holds) << result.id << ": " << result.reason;
    EXPECT_LE(figure(result, "residual"), 1e-7) << result.id;
    if (result.id.ends_with("spectrum")) continue;
    EXPECT_LE(figure(result, "difference"), 1e-5) << result.id;
#ifndef __SANITIZE_ADDRESS__  // whose allocator does not tell
    EXPECT_GT(figure(result, "memory"), 1e3) << result.id;
#endif
  }
}

TEST(LinearSolverStudy, StartsWarmFromTheSystemBefore) {
  const StudyResult study =
      run("\"cg\", \"petsc -ksp_type cg -pc_type icc\"", cloth, "largest_spectrum = 0\n");
  std::int64_t saved = 0;
  for (const CaseResult& result : study.cases) {
    const auto iterations = [&](const std::string& start) {
      for (const Column& column : result.columns) {
        if (column.name == "sequence_iterations_" + start)
          return std::get<std::vector<std::int64_t>>(column.values);
      }
      throw std::logic_error("no column for " + start);
    };
    ASSERT_EQ(iterations("cold").size(), 4u);
    saved += iterations("cold")[3] - iterations("warm")[3];
    EXPECT_EQ(iterations("warm")[0], iterations("cold")[0]) << "the first system has no system before";
    EXPECT_LE(iterations("warm")[3], iterations("cold")[3]);
  }
  EXPECT_GT(saved, 0);
}

TEST(LinearSolverStudy, FailsASolverThatDoesNotGetThere) {
  const StudyResult study =
      run("\"petsc -ksp_type richardson -pc_type none -ksp_max_it 3\"", cloth, "largest_spectrum = 0\n");
  EXPECT_EQ(study.cases.front().verdict, Verdict::fails);
  EXPECT_THAT(study.cases.front().reason, HasSubstr("system 0 of the simulation"));
}

TEST(LinearSolverStudy, FindsTheSpectrumOfAChainInClosedForm) {
  // A = m I + h² k T with T = tridiag(−1, 2, −1): eigenvalues m + 4 h² k sin²(jπ/(2(N+1))).
  const StudyResult study =
      run("\"cg\"", "name = \"linear_chain\"\nparameters = { count = 9, mass = 0.5, stiffness = 200 }\n");
  const CaseResult& spectrum = study.cases.front();
  ASSERT_TRUE(spectrum.id.ends_with("spectrum"));
  const double h = 0.01, k = 200.0, m = 0.5;
  const auto& eigenvalues = std::get<std::vector<double>>(spectrum.columns.front().values);
  ASSERT_EQ(eigenvalues.size(), 9u);
  for (int j = 1; j <= 9; ++j) {
    const double sine = std::sin(j * std::numbers::pi / 20.0);
    EXPECT_NEAR(eigenvalues[static_cast<std::size_t>(j - 1)], m + 4 * h * h * k * sine * sine, 1e-13);
  }
  EXPECT_NEAR(figure(spectrum, "condition"), eigenvalues.back() / eigenvalues.front(), 1e-12);
  EXPECT_EQ(spectrum.verdict, Verdict::holds) << spectrum.reason;
}

std::string refusal(const std::string& solvers, const std::string& problem = cloth,
                    const std::string& keys = "") {
  try {
    run(solvers, problem, keys);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(LinearSolverStudy, RefusesBadInputBeforeAnythingRuns) {
  EXPECT_THAT(refusal("\"cg\", \"colmod\""),
              HasSubstr("solvers.toml:3: solvers[1]: unknown linear solver \"colmod\""));
  EXPECT_THAT(refusal("\"cg -fast\""), HasSubstr("takes no options, found \"-fast\""));
  EXPECT_THAT(refusal("\"petsc -mat_type dense\""),
              HasSubstr("-mat_type: found \"dense\", expected aij, baij or sbaij"));
  EXPECT_THAT(refusal("\"petsc -ksp_typo cg\""), HasSubstr("ksp_typo"));
  EXPECT_THAT(refusal("\"cg\"", "name = \"dahlquist\"\n"), HasSubstr("expected M q'' = f(t, q, q')"));
  EXPECT_THAT(refusal(""), HasSubstr("solvers: found an empty list"));
}

}  // namespace
}  // namespace fw::study
