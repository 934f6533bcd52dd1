#include <gtest/gtest.h>

#include <cmath>

#include "allocation_counter.hpp"
#include "integrators/tableau/runge_kutta_chebyshev.hpp"
#include "network.hpp"

namespace fw::integrators {
namespace {

/// Largest deviation of linear and angular momentum from the start, over a run.
class MomentumObserver final : public Observer {
 public:
  explicit MomentumObserver(const mechanics::MassSpringSystem& system) : system_(system) {}

  bool observe(const StepView& view) override {
    const Index n = view.state.size() / 2;
    const Vec3<double> p = system_.linear_momentum(view.state.tail(n));
    const Vec3<double> l = system_.angular_momentum(view.state.head(n), view.state.tail(n));
    if (view.index == 0) {
      p0_ = p;
      l0_ = l;
    }
    linear_ = std::max(linear_, norm(p - p0_));
    angular_ = std::max(angular_, norm(l - l0_));
    return true;
  }
  double linear() const { return linear_; }
  double angular() const { return angular_; }

 private:
  const mechanics::MassSpringSystem& system_;
  Vec3<double> p0_, l0_;
  double linear_ = 0.0, angular_ = 0.0;
};

struct Drift {
  double linear, angular;
};

Drift momentum_drift(const Integrator& scheme, const Ivp& ivp, double step) {
  const auto& system = dynamic_cast<const mechanics::MassSpringSystem&>(*ivp.system);
  MomentumObserver observer(system);
  const Solution solution = scheme.solve(ivp, FixedStep{.step = step}, observer);
  EXPECT_TRUE(solution.status.ok()) << scheme.info().name << ": " << solution.status.describe();
  return {observer.linear(), observer.angular()};
}

constexpr int long_run = 100'000;

TEST(FreeNetwork, KeepsItsMomentaToRoundingOverAHundredThousandSteps) {
  const double h = 1e-3;
  for (bool damped : {false, true}) {
    const Ivp ivp = random_network(21, {.is_damped = damped, .is_free = true}, h * long_run);
    for (const auto& scheme : {splitting("symplectic_euler"), splitting("velocity_verlet"),
                               make_verlet(VerletVelocity::central)}) {
      const Drift drift = momentum_drift(*scheme, ivp, h);
      // Momenta are about 1 kg·m/s; √(10⁵) roundings of 1e-16, and the growth of positions as the network
      // flies on.
      EXPECT_LT(drift.linear, 1e-11) << scheme->info().name;
      EXPECT_LT(drift.angular, 1e-10) << scheme->info().name;
    }
  }
}

TEST(FreeNetwork, KeepsItsLinearMomentumUnderEveryScheme) {
  const double h = 1e-3;
  const Ivp ivp = random_network(22, {.is_free = true}, 2.0);
  for (const auto& scheme : all_schemes()) {
    const bool iterates =
        scheme->info().name == "implicit_euler_linearised";  // to the tolerance of its solver
    EXPECT_LT(momentum_drift(*scheme, ivp, h).linear, iterates ? 1e-9 : 1e-12) << scheme->info().name;
  }
}

TEST(FreeNetwork, LosesAngularMomentumUnderImplicitAndExplicitEuler) {
  // Negative control of the observer: these schemes are known not to conserve it.
  const Ivp ivp = random_network(23, {.is_damped = false, .is_free = true}, 2.0);
  EXPECT_GT(momentum_drift(*make_implicit_euler(), ivp, 1e-2).angular, 1e-4);
  EXPECT_GT(momentum_drift(*explicit_runge_kutta("explicit_euler"), ivp, 1e-2).angular, 1e-4);
}

TEST(FixedPoints, AreBitIdenticalToTheirStart) {
  const Ivp ivp = random_network(24, {}, 1.0);
  const auto& fixed = ivp.system->second_order()->fixed();
  const Index n = ivp.y0.size() / 2;
  for (const auto& scheme : all_schemes()) {
    const Solution solution = run(*scheme, ivp, 1.0 / 128.0);
    ASSERT_TRUE(solution.status.ok()) << scheme->info().name << ": " << solution.status.describe();
    int count = 0;
    for (Index i = 0; i < n; ++i) {
      if (!fixed[static_cast<std::size_t>(i)]) continue;
      ++count;
      EXPECT_EQ(solution.state[i], ivp.y0[i]) << scheme->info().name;
      EXPECT_EQ(solution.state[n + i], 0.0) << scheme->info().name;
    }
    EXPECT_EQ(count, 6);
  }
}

TEST(Schemes, GiveTheSameBitsWhenRunTwice) {
  const Ivp ivp = random_network(25, {}, 1.0);
  for (const auto& scheme : all_schemes()) {
    EXPECT_EQ(run(*scheme, ivp, 1.0 / 128.0).state, run(*scheme, ivp, 1.0 / 128.0).state)
        << scheme->info().name;
  }
}

std::size_t allocations_per_run(const Integrator& scheme, int steps, bool damped = true) {
  const Ivp ivp = random_network(26, {.is_damped = damped}, steps / 1024.0);
  return allocations_of([&] { run(scheme, ivp, 1.0 / 1024.0); });
}

TEST(Schemes, AllocateNothingAfterTheFirstStep) {
  auto schemes = all_schemes();
  schemes.erase(schemes.end() - 2);  // Cholesky: Eigen's factorisation takes work space of its own each time
  for (const auto& scheme : schemes) {
    EXPECT_EQ(allocations_per_run(*scheme, 264), allocations_per_run(*scheme, 8)) << scheme->info().name;
  }
  for (const schemes::NystromTableau& tableau : schemes::nystrom_tableaus()) {
    const auto scheme = make_nystrom(tableau);
    EXPECT_EQ(allocations_per_run(*scheme, 264, false), allocations_per_run(*scheme, 8, false))
        << tableau.name;
  }
  for (const int stages : {0, 8}) {
    const auto scheme = make_runge_kutta_chebyshev({.order = 2, .stages = stages});
    EXPECT_EQ(allocations_per_run(*scheme, 264), allocations_per_run(*scheme, 8)) << stages;
  }
}

TEST(AdaptiveSchemes, AllocateNothingAfterTheFirstStep) {
  // Ten times the time means ten times the steps, rejected ones included; the number of allocations stays.
  const auto allocations_over = [](const Integrator& scheme, double time, std::uint64_t& steps) {
    const Ivp ivp = random_network(26, {.is_damped = true}, time);
    NullObserver nobody;
    Solution solution;
    const std::size_t count = allocations_of([&] {
      solution = scheme.solve(ivp, AdaptiveStep{1e-7, 1e-9}, nobody);
    });
    EXPECT_TRUE(solution.status.ok()) << scheme.info().name << ": " << solution.status.describe();
    steps = solution.work.accepted_steps + solution.work.rejected_steps;
    return count;
  };
  for (const char* name :
       {"dormand_prince_54", "bogacki_shampine_32", "cash_karp_54", "dormand_prince_853"}) {
    const auto scheme = explicit_runge_kutta(name);
    std::uint64_t few = 0, many = 0;
    allocations_over(*scheme, 1.0, few);  // what is made once per process is made here
    EXPECT_EQ(allocations_over(*scheme, 10.0, many), allocations_over(*scheme, 1.0, few)) << name;
    EXPECT_GT(many, 5 * few) << name;
  }
}

}  // namespace
}  // namespace fw::integrators
