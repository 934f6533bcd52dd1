#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>

#include "catalog/methods.hpp"
#include "mechanics/mass_spring_system.hpp"

namespace fw::catalog {
namespace {

class Nobody final : public Observer {
 public:
  bool observe(const StepView&) override { return true; }
};

/// Two masses on a stretched spring, which turn about each other, and `others` at rest, free.
Ivp motion_of_few(int others) {
  mechanics::MassSpringModel model;
  const auto particles = static_cast<std::size_t>(2 + others);
  model.mass.assign(particles, 0.5);
  model.springs.first = {0};
  model.springs.second = {1};
  model.springs.rest_length = {1.0};
  model.springs.stiffness = {20.0};
  model.springs.damping = {0.0};
  const Index n = 3 * static_cast<Index>(particles);
  Ivp ivp;
  ivp.y0 = Vector::Zero(2 * n);
  ivp.y0[3] = 1.2;
  for (Index i = 2; i < 2 + others; ++i) ivp.y0[3 * i] = 0.1 * static_cast<double>(i % 7);
  ivp.y0[n + 1] = -0.5;
  ivp.y0[n + 4] = 0.5;
  ivp.t1 = 2.0;
  ivp.system = std::make_shared<const mechanics::MassSpringSystem>(std::move(model));
  return ivp;
}

/// Of the two masses: positions, then velocities.
Vector pair_of(const Vector& state) {
  Vector pair(12);
  pair << state.head(6), state.segment(state.size() / 2, 6);
  return pair;
}

/// Every method with tolerances, own and foreign: what is at rest beside a motion does not spoil it.
TEST(LocalMotion, IsAsAccurateBesideManyAtRestAsAlone) {
  const Ivp alone = motion_of_few(0), among_many = motion_of_few(12);
  Nobody nobody;
  const Vector exact = [&] {
    const AdaptiveStep fine{.relative_tolerance = 1e-13, .absolute_tolerance = 1e-13};
    return make_method("dormand_prince_853")->solve(alone, fine, nobody).state;
  }();
  int seen = 0;
  for (const MethodEntry& entry : methods()) {
    if (!entry.info().is_adaptive) continue;
    const std::unique_ptr<Integrator> method = entry.make({});
    if (!why_not_applicable(method->info(), *alone.system).empty()) continue;
    ++seen;
    const AdaptiveStep control{.relative_tolerance = 1e-5, .absolute_tolerance = 1e-5};
    const Solution one = method->solve(alone, control, nobody);
    const Solution many = method->solve(among_many, control, nobody);
    ASSERT_TRUE(one.status.ok() && many.status.ok()) << entry.name << ": " << many.status.describe();
    const double error = (one.state - exact).norm(), error_among = (pair_of(many.state) - exact).norm();
    EXPECT_LE(error_among, 1.5 * error) << entry.name;
  }
  EXPECT_GE(seen, 40);
}

TEST(LocalMotion, IsDilutedByTheRootMeanSquare) {
  const Ivp alone = motion_of_few(0), among_many = motion_of_few(2000);
  Nobody nobody;
  const AdaptiveStep control{.relative_tolerance = 1e-6, .absolute_tolerance = 1e-6};
  const auto steps = [&](const std::string& call, const Ivp& ivp) {
    return static_cast<double>(make_method(call)->solve(ivp, control, nobody).work.accepted_steps);
  };
  EXPECT_EQ(steps("dormand_prince_54", among_many), steps("dormand_prince_54", alone));
  EXPECT_LT(2 * steps("dormand_prince_54[norm=rms]", among_many),
            steps("dormand_prince_54[norm=rms]", alone));
  // The library's own vector averages; ours does not.
  EXPECT_EQ(steps("sundials:cvode_adams", among_many), steps("sundials:cvode_adams", alone));
  EXPECT_LT(1.2 * steps("sundials:cvode_adams[vector=serial]", among_many),
            steps("sundials:cvode_adams", alone));
}

TEST(LocalMotion, VelocitiesHaveATolerance) {
  const Ivp ivp = motion_of_few(3);
  Nobody nobody;
  for (const char* call : {"dormand_prince_54", "sundials:cvode_bdf", "sundials:ida", "sundials:arkode_erk",
                           "petsc:ts_rk", "gsl:rk8pd"}) {
    const std::shared_ptr<const Integrator> method = make_method(call);
    const auto steps = [&](double positions, double velocities) {
      const Solution solution = method->solve(ivp,
                                              AdaptiveStep{.relative_tolerance = 1e-12,
                                                           .absolute_tolerance = positions,
                                                           .absolute_velocity_tolerance = velocities},
                                              nobody);
      EXPECT_TRUE(solution.status.ok()) << call << ": " << solution.status.describe();
      return solution.work.accepted_steps;
    };
    const auto loose = steps(1e-3, 0.0);
    EXPECT_EQ(steps(1e-3, 1e-3), loose) << call;
    EXPECT_GT(steps(1e-3, 1e-8), 1.5 * static_cast<double>(loose)) << call;
    EXPECT_GT(steps(1e-8, 1e-3), 1.5 * static_cast<double>(loose)) << call;
  }
}

/// A chain at rest on its way out of it: GSL's extrapolation takes steps of a nanosecond for ever.
TEST(Progress, AMethodThatGetsNowhereEndsWithAStatus) {
  mechanics::MassSpringModel model;
  constexpr int count = 4;
  for (int i = 0; i < count; ++i) model.mass.push_back(0.7);
  model.fixed = {0};
  model.gravity = {0.0, 0.0, -9.81};
  for (int i = 0; i + 1 < count; ++i) {
    model.springs.first.push_back(i);
    model.springs.second.push_back(i + 1);
    model.springs.rest_length.push_back(0.1);
    model.springs.stiffness.push_back(55.0);
    model.springs.damping.push_back(0.0);
  }
  Ivp ivp;
  ivp.y0 = Vector::Zero(6 * count);
  for (int i = 0; i < count; ++i) ivp.y0[3 * i] = 0.1 * i;
  ivp.t1 = 1.0;
  ivp.system = std::make_shared<const mechanics::MassSpringSystem>(std::move(model));
  Nobody nobody;
  const AdaptiveStep control{.relative_tolerance = 1e-8, .absolute_tolerance = 1e-10};
  const Solution creeps = make_method("gsl:bsimp")->solve(ivp, control, nobody);
  EXPECT_EQ(creeps.status.code, StatusCode::no_progress) << creeps.status.describe();
  EXPECT_LT(creeps.time, 1e-3);
  for (const char* call : {"dormand_prince_54", "bogacki_shampine_32", "sundials:cvode_bdf"}) {
    const Solution arrives = make_method(call)->solve(ivp, control, nobody);
    EXPECT_TRUE(arrives.status.ok()) << call << ": " << arrives.status.describe();
  }
}

}  // namespace
}  // namespace fw::catalog
