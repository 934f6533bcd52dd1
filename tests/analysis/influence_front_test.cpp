#include "analysis/theory/influence_front.hpp"

#include <gtest/gtest.h>

#include "schemes/explicit_tableaus.hpp"
#include "schemes/implicit_tableaus.hpp"
#include "schemes/nystrom_tableaus.hpp"
#include "schemes/splitting_schemes.hpp"

namespace fw::analysis {
namespace {

constexpr InfluenceFront kick{-1, 0}, pull{0, -1};

template <class List>
PredictedFronts fronts_of(const List& list, const std::string& name, InfluenceFront start,
                          int farthest = 1000) {
  for (const auto& entry : list) {
    if (entry.name == name) return predict_fronts(entry, start, farthest, 40);
  }
  throw std::logic_error("no scheme " + name);
}

TEST(InfluenceFront, OfExplicitEulerMovesOneSpringInTwoSteps) {
  const PredictedFronts predicted = fronts_of(schemes::explicit_tableaus(), "explicit_euler", kick);
  ASSERT_TRUE(predicted.known);
  EXPECT_EQ(predicted.fronts[1], (InfluenceFront{0, 0}));
  EXPECT_EQ(predicted.fronts[2], (InfluenceFront{0, 1}));
  EXPECT_EQ(predicted.fronts[3], (InfluenceFront{1, 1}));
  EXPECT_EQ(predicted.fronts[40].velocity, 20);
}

TEST(InfluenceFront, OfTheLecturesLoopAndOfVerletMovesOneSpringPerStep) {
  const PredictedFronts loop = fronts_of(schemes::splitting_schemes(), "symplectic_euler", kick);
  EXPECT_EQ(loop.fronts[1], (InfluenceFront{0, 0}));  // the kick's own step moves one mass only
  EXPECT_EQ(loop.fronts[2], (InfluenceFront{1, 1}));
  EXPECT_EQ(loop.fronts[40].velocity, 39);
  const PredictedFronts pulled = fronts_of(schemes::splitting_schemes(), "symplectic_euler", pull);
  EXPECT_EQ(pulled.fronts[1], (InfluenceFront{1, 1}));
  const PredictedFronts verlet = fronts_of(schemes::splitting_schemes(), "velocity_verlet", kick);
  EXPECT_EQ(verlet.fronts[1], (InfluenceFront{0, 1}));
  EXPECT_EQ(verlet.fronts[40], (InfluenceFront{39, 40}));
}

TEST(InfluenceFront, OfRungeKuttaMethodsMovesHalfAsManySpringsAsStages) {
  EXPECT_EQ(fronts_of(schemes::explicit_tableaus(), "midpoint", kick).fronts[40].velocity, 40);
  EXPECT_EQ(fronts_of(schemes::explicit_tableaus(), "rk4", kick).fronts[1], (InfluenceFront{1, 2}));
  EXPECT_EQ(fronts_of(schemes::explicit_tableaus(), "rk4", kick).fronts[40].velocity, 80);
  EXPECT_EQ(fronts_of(schemes::explicit_tableaus(), "kutta3", kick).fronts[40].velocity, 60);
}

TEST(InfluenceFront, GoesThroughDampersWithTheVelocitiesOfRungeKuttaMethods) {
  const auto damped = [](const auto& list, const std::string& name) {
    for (const auto& entry : list) {
      if (entry.name == name) return predict_fronts(entry, kick, 1000, 40, true);
    }
    throw std::logic_error("no scheme " + name);
  };
  const PredictedFronts euler = damped(schemes::explicit_tableaus(), "explicit_euler");
  EXPECT_EQ(euler.fronts[1], (InfluenceFront{0, 1}));
  EXPECT_EQ(euler.fronts[40], (InfluenceFront{39, 40}));
  EXPECT_EQ(damped(schemes::explicit_tableaus(), "rk4").fronts[1], (InfluenceFront{3, 4}));
  EXPECT_TRUE(damped(schemes::fully_implicit_tableaus(), "gauss2").whole_system);
  EXPECT_FALSE(damped(schemes::splitting_schemes(), "symplectic_euler").known);
}

TEST(InfluenceFront, StopsAtTheEnd) {
  EXPECT_EQ(fronts_of(schemes::explicit_tableaus(), "rk4", kick, 7).fronts[40], (InfluenceFront{7, 7}));
}

TEST(InfluenceFront, OfImplicitMethodsIsTheWholeSystem) {
  EXPECT_TRUE(fronts_of(schemes::diagonally_implicit_tableaus(), "implicit_euler", kick).whole_system);
  EXPECT_TRUE(fronts_of(schemes::fully_implicit_tableaus(), "gauss2", kick).whole_system);
  EXPECT_FALSE(predict_fronts(schemes::SchemeData{}, kick, 10, 3).known);
}

}  // namespace
}  // namespace fw::analysis
