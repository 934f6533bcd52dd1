#include <vector>

#include "core/error.hpp"
#include "integrators/energy_momentum/average_vector_field.hpp"
#include "integrators/energy_momentum/discrete_gradient.hpp"
#include "order_levels.hpp"

namespace fw::integrators {
namespace {

using mechanics::MassSpringSystem;

/// Largest relative deviation of energy, and deviations of momenta, over a run.
class ConservationObserver final : public Observer {
 public:
  explicit ConservationObserver(const MassSpringSystem& system) : system_(system) {}
  bool observe(const StepView& view) override {
    const Index n = view.state.size() / 2;
    const double energy = system_.energies(view.state.head(n), view.state.tail(n)).total();
    const Vec3<double> p = system_.linear_momentum(view.state.tail(n));
    const Vec3<double> l = system_.angular_momentum(view.state.head(n), view.state.tail(n));
    if (view.index == 0) {
      energy0_ = energy;
      p0_ = p;
      l0_ = l;
    }
    energy_error = std::max(energy_error, std::abs(energy - energy0_) / std::abs(energy0_));
    linear_error = std::max(linear_error, norm(p - p0_));
    angular_error = std::max(angular_error, norm(l - l0_));
    return true;
  }
  double energy_error = 0.0, linear_error = 0.0, angular_error = 0.0;

 private:
  const MassSpringSystem& system_;
  double energy0_ = 0.0;
  Vec3<double> p0_, l0_;
};

ConservationObserver observe(const Integrator& scheme, const Ivp& ivp, double h) {
  ConservationObserver observer(dynamic_cast<const MassSpringSystem&>(*ivp.system));
  const Solution solution = scheme.solve(ivp, FixedStep{.step = h}, observer);
  EXPECT_TRUE(solution.status.ok()) << scheme.info().name << ": " << solution.status.describe();
  return observer;
}

/// A step that is not small: velocity Verlet loses a good part of the energy with it.
constexpr double large_step = 0.04;

TEST(DiscreteGradient, KeepsEnergyAndMomentaOfANonlinearNetworkOverAThousandLargeSteps) {
  for (const auto law :
       {mechanics::SpringLaw::hooke, mechanics::SpringLaw::strain, mechanics::SpringLaw::tension_only}) {
    const Ivp ivp = random_network(51, {.law = law, .is_damped = false, .is_free = true}, 1000 * large_step);
    const ConservationObserver kept = observe(*make_discrete_gradient(), ivp, large_step);
    EXPECT_LT(kept.energy_error, 1e-12) << static_cast<int>(law);
    EXPECT_LT(kept.linear_error, 1e-12) << static_cast<int>(law);
    EXPECT_LT(kept.angular_error, 1e-11) << static_cast<int>(law);
    // Negative control: at this step the energy of velocity Verlet is not constant.
    EXPECT_GT(observe(*splitting("velocity_verlet"), ivp, large_step).energy_error, 1e-4)
        << static_cast<int>(law);
  }
}

TEST(DiscreteGradient, KeepsTheEnergyWithGravityFixedPointsAndAnchors) {
  const Ivp base = random_network(52, {.is_damped = false}, 1000 * large_step);
  mechanics::MassSpringModel model = dynamic_cast<const MassSpringSystem&>(*base.system).model();
  model.anchors.push_back({.particle = 2, .rest_position = {0.1, 0.2, 0.3}, .stiffness = 40.0});
  Ivp ivp = base;
  ivp.system = std::make_shared<const MassSpringSystem>(std::move(model));
  EXPECT_LT(observe(*make_discrete_gradient(), ivp, large_step).energy_error, 1e-12);
}

TEST(DiscreteGradient, LosesEnergyToDampersOnly) {
  const Ivp ivp = random_network(53, {.is_damped = true, .is_free = true}, 200 * large_step);
  const auto& system = dynamic_cast<const MassSpringSystem&>(*ivp.system);
  TrajectoryRecorder recorder;
  ASSERT_TRUE(make_discrete_gradient()->solve(ivp, FixedStep{.step = large_step}, recorder).status.ok());
  double previous = 1e300;
  const Index n = ivp.y0.size() / 2;
  for (const Vector& y : recorder.states()) {
    const double energy = system.energies(y.head(n), y.tail(n)).total();
    EXPECT_LE(energy, previous * (1.0 + 1e-13));
    previous = energy;
  }
  const ConservationObserver kept = observe(*make_discrete_gradient(), ivp, large_step);
  EXPECT_LT(kept.linear_error, 1e-12);
  EXPECT_LT(kept.angular_error, 1e-11);
}

TEST(DiscreteGradient, ConvergesWithOrderTwo) {
  expect_claimed_orders_of_springs(*make_discrete_gradient(), 30, 8);
}

TEST(DiscreteGradient, ConvergesInFewNewtonIterationsSinceItsMatrixIsExact) {
  // A wrong derivative would make Newton's convergence linear.
  const Ivp base = random_network(54, {}, 50 * large_step);
  mechanics::MassSpringModel model = dynamic_cast<const MassSpringSystem&>(*base.system).model();
  model.anchors.push_back(
      {.particle = 2, .rest_position = {0.1, 0.2, 0.3}, .stiffness = 40.0, .damping = 3.0});
  Ivp ivp = base;
  ivp.system = std::make_shared<const MassSpringSystem>(std::move(model));
  const Solution solution = run(*make_discrete_gradient(), ivp, large_step);
  ASSERT_TRUE(solution.status.ok());
  EXPECT_LE(solution.work.newton_iterations, 6u * 50u);
}

TEST(AverageVectorField, ConvergesWithOrderTwo) {
  expect_claimed_orders(*make_average_vector_field(), 40, 8);
}

TEST(AverageVectorField, ConvergesWithOrderTwoForAnyQuadrature) {
  for (const int points : {1, 2, 3, 8}) {
    expect_claimed_orders(*make_average_vector_field({.quadrature_points = points}), 40, 8);
  }
}

/// A particle in the potential q⁴/4 + q²/2 + q⁶/6.
struct SexticWell {
  template <class S>
  void operator()(const S&, std::span<const S> q, std::span<const S>, std::span<S> f) const {
    const S q2 = q[0] * q[0];
    f[0] = -q[0] * (S(1) + q2 + q2 * q2);
  }
};

TEST(AverageVectorField, KeepsPolynomialEnergiesToRoundingWhereTheQuadratureIsExact) {
  Ivp ivp;
  ivp.system = std::make_shared<FunctorSecondOrderSystem<SexticWell>>(Vector{{1.5}}, ForceClass::position,
                                                                      SexticWell{});
  ivp.y0 = Vector{{1.2, 0.4}};
  ivp.t1 = 200.0;
  const auto energy = [](const Vector& y) {
    const double q2 = y[0] * y[0];
    return 0.75 * y[1] * y[1] + q2 / 2.0 + q2 * q2 / 4.0 + q2 * q2 * q2 / 6.0;
  };
  const auto drift = [&](int points) {
    TrajectoryRecorder recorder;
    EXPECT_TRUE(make_average_vector_field({.quadrature_points = points})
                    ->solve(ivp, FixedStep{.step = 0.2}, recorder)
                    .status.ok());
    double largest = 0.0;
    for (const Vector& y : recorder.states())
      largest = std::max(largest, std::abs(energy(y) - energy(ivp.y0)));
    return largest / energy(ivp.y0);
  };
  EXPECT_LT(drift(3), 1e-12);  // the force has degree 5 = 2·3 − 1
  EXPECT_LT(drift(4), 1e-12);
  EXPECT_GT(drift(2), 1e-7);  // negative control
  EXPECT_THROW(make_average_vector_field({.quadrature_points = 0}), InputError);
}

TEST(AverageVectorField, KeepsTheEnergyOfSpringsUpToItsQuadrature) {
  const Ivp ivp = random_network(55, {.is_damped = false, .is_free = true}, 200 * large_step);
  const double two =
      observe(*make_average_vector_field({.quadrature_points = 2}), ivp, large_step).energy_error;
  const double eight =
      observe(*make_average_vector_field({.quadrature_points = 8}), ivp, large_step).energy_error;
  EXPECT_LT(eight, 1e-10);
  EXPECT_GT(two, 10.0 * eight);
}

}  // namespace
}  // namespace fw::integrators
