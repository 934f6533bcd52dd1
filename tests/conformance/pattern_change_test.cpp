#include <gtest/gtest.h>

#include "catalog/methods.hpp"
#include "changing_network.hpp"

namespace fw::catalog {
namespace {

/// The catalogue's methods that make matrices and can run on the network: implicit ones, and r-RESPA whose
/// kicks are implicit. Mass-spring systems alone do not change their pattern between steps.
std::vector<const MethodEntry*> methods_with_matrices(const OdeSystem& system) {
  std::vector<const MethodEntry*> list;
  for (const MethodEntry& entry : methods()) {
    const MethodInfo& info = entry.info();
    if (info.is_explicit && info.name != "r_respa") continue;
    if (why_not_applicable(info, system).empty()) list.push_back(&entry);
  }
  return list;
}

bool is_foreign(const std::string& name) {
  return name.find(':') != std::string::npos;
}

void expect_the_same_as_with_dense_matrices(bool is_second_order) {
  const ChangingNetwork sample(6, PatternKind::sparse, is_second_order);
  const auto list = methods_with_matrices(sample);
  EXPECT_GE(list.size(), 20u);
  for (const MethodEntry* entry : list) {
    if (entry->name == "gsl:bsimp") continue;  // one extrapolated step goes over the whole interval
    SCOPED_TRACE(entry->name);
    const std::unique_ptr<Integrator> method = entry->make({});
    const bool has_fixed_step = method->info().has_fixed_step;
    const StepControl control =
        has_fixed_step ? StepControl{FixedStep{.step = 1.0 / 24.0}}
                       : StepControl{AdaptiveStep{.relative_tolerance = 1e-5, .absolute_tolerance = 1e-7}};
    const auto run = [&](PatternKind kind) {
      return run_over_changes(*method, std::make_shared<ChangingNetwork>(6, kind, is_second_order), control,
                              8);
    };
    const ChangingRun changing = run(PatternKind::sparse), dense = run(PatternKind::dense);
    ASSERT_TRUE(dense.solution.status.ok()) << dense.solution.status.describe();
    ASSERT_TRUE(changing.solution.status.ok()) << changing.solution.status.describe();
    ASSERT_EQ(changing.network->pattern_revision(), 2u) << "the run ended before the second change";
    const double scale = dense.solution.state.lpNorm<Eigen::Infinity>();
    const double difference = (changing.solution.state - dense.solution.state).lpNorm<Eigen::Infinity>();
    EXPECT_LE(difference, (has_fixed_step ? 1e-10 : 1e-6) * scale);
    // Patterns are made anew then and only then.
    EXPECT_EQ(changing.patterns_without_change, 0);
    if (changing.patterns_at_start > 0) {
      EXPECT_GT(changing.patterns_for_change, 0);
    }
    if (!is_foreign(entry->name)) {
      EXPECT_EQ(dense.patterns_for_change, 0);
    }
  }
}

TEST(PatternChange, IsFollowedByEveryImplicitMethodOnSecondOrderSystems) {
  expect_the_same_as_with_dense_matrices(true);
}

TEST(PatternChange, IsFollowedByEveryImplicitMethodOnFirstOrderSystems) {
  expect_the_same_as_with_dense_matrices(false);
}

}  // namespace
}  // namespace fw::catalog
