#include "study/kinds/simulate.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "catalog/builtin_catalog.hpp"
#include "study_of_text.hpp"

namespace fw::study {
namespace {

StudyResult simulated(const std::string& problem, const std::string& more = "") {
  return run_study("kind = 'simulate'\ntitle = 'T'\nmethods = ['velocity_verlet', 'dormand_prince_54']\n" +
                       more + "[[problem]]\n" + problem,
                   catalog::BuiltinCatalog());
}

TEST(SimulateStudy, HasEnergiesOfScenesAndOfProblemsWithOne) {
  const StudyResult scene =
      simulated("scene = '../scenes/double_spring.toml'\nt_end = 1\n", "steps = [1e-3]\n");
  const StudyResult problem = simulated("name = 'linear_chain'\nt_end = 3\n", "steps = [1e-2]\n");
  for (const StudyResult* study : {&scene, &problem}) {
    ASSERT_EQ(study->cases.size(), 2U);
    for (const CaseResult& result : study->cases) {
      const auto& kinetic = column(result, "kinetic_energy");
      const auto& potential = column(result, "potential_energy");
      const auto& total = column(result, "total_energy");
      ASSERT_EQ(kinetic.size(), column(result, "time").size());
      double largest = 0.0;
      for (std::size_t k = 0; k < total.size(); ++k) {
        EXPECT_EQ(total[k], kinetic[k] + potential[k]);
        largest = std::max(largest, kinetic[k]);
        EXPECT_GE(kinetic[k], 0.0);
      }
      EXPECT_GT(largest, 0.0);
      EXPECT_GT(figure(result, "seconds"), 0.0);
      EXPECT_GT(figure<std::int64_t>(result, "rhs_evaluations"), 100);
    }
  }
  // Nothing is invented where there is no energy.
  const StudyResult none = run_study(
      "kind = 'simulate'\ntitle = 'T'\nmethods = ['rk4']\nsteps = [1e-2]\n[[problem]]\nname = 'dahlquist'\n",
      catalog::BuiltinCatalog());
  EXPECT_THROW(column(none.cases.front(), "kinetic_energy"), std::logic_error);
}

TEST(SimulateStudy, GivesVelocitiesAToleranceOfTheirOwn) {
  const auto evaluations = [](const std::string& tolerances) {
    const StudyResult study = run_study(
        "kind = 'simulate'\ntitle = 'T'\nmethods = ['dormand_prince_54']\n[tolerances]\n"
        "relative = 1e-12\nabsolute = 1e-3\n" +
            tolerances + "[[problem]]\nscene = '../scenes/double_spring.toml'\nt_end = 1\n",
        catalog::BuiltinCatalog());
    return figure<std::int64_t>(study.cases.front(), "rhs_evaluations");
  };
  EXPECT_EQ(evaluations("absolute_velocity = 1e-3\n"), evaluations(""));
  EXPECT_GT(evaluations("absolute_velocity = 1e-9\n"), evaluations(""));
  EXPECT_THROW(evaluations("absolute_velocity = 0.0\n"), InputError);
}

}  // namespace
}  // namespace fw::study
