#include "analysis/reference/binary64_reference.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "analysis/theory/stiffness_measures.hpp"
#include "problems/celestial.hpp"
#include "problems/linear_chain.hpp"

namespace fw::analysis {
namespace {

TEST(Binary64Reference, IsAsGoodAsItSays) {
  for (const Problem& problem : {problems::linear_chain({{"stiffness", 1e4}}), problems::kepler()}) {
    const ReferenceSolution found = binary64_reference(problem.ivp);
    ASSERT_TRUE(found.status.ok()) << found.status.describe();
    const std::vector<Float128> exact = problem.exact(Float128(problem.ivp.t1));
    ASSERT_EQ(found.states.size(), 1u);
    for (std::size_t i = 0; i < exact.size(); ++i) {
      EXPECT_LE(abs(found.states[0].value[i] - exact[i]), 2 * found.states[0].error[i]) << problem.name << i;
    }
    EXPECT_LE(found.states[0].largest_error(), 1e-7) << problem.name;
  }
}

TEST(Binary64Reference, EndsWhenAsked) {
  const std::atomic<bool> asked{true};
  const ReferenceSolution found = binary64_reference(problems::kepler().ivp, StopToken(asked));
  EXPECT_EQ(found.status.code, StatusCode::interrupted);
  EXPECT_TRUE(found.states.empty());
}

TEST(StiffnessMeasures, OfAChainAreItsFrequencies) {
  const int count = 8;
  const Problem chain = problems::linear_chain({{"count", count}, {"mass", 0.5}, {"stiffness", 20.0}});
  const auto frequency = [](int j) {
    return 2.0 * std::sqrt(40.0) * std::sin(j * M_PI / (2.0 * (count + 1)));
  };
  const StiffnessMeasures found = stiffness_measures(*chain.ivp.system, 0.0, chain.ivp.y0);
  EXPECT_NEAR(found.largest_eigenvalue, frequency(count), 1e-10);
  EXPECT_NEAR(found.eigenvalue_ratio, frequency(count) / frequency(1), 1e-8);
  EXPECT_TRUE(std::isnan(found.stiffness_ratio)) << "nothing decays";
}

TEST(StiffnessMeasures, TheKrylovIterationFindsWhatTheDenseSolverFinds) {
  const Problem chain = problems::linear_chain({{"count", 150.0}});
  const double dense = stiffness_measures(*chain.ivp.system, 0.0, chain.ivp.y0).largest_eigenvalue;
  EXPECT_NEAR(spectral_radius(*chain.ivp.system, 0.0, chain.ivp.y0), dense, 1e-3 * dense);
}

}  // namespace
}  // namespace fw::analysis
