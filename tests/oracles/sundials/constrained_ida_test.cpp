#include "oracles/sundials/constrained_ida.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "constraints/consistent_state.hpp"
#include "core/error.hpp"
#include "integrators/network.hpp"
#include "oracles/sundials/constrained_form.hpp"
#include "pendulum.hpp"

namespace fw::oracles {
namespace {

using constraints::DistanceConstraints;

constexpr double degree = std::numbers::pi / 180.0;

AdaptiveStep tolerance(double value) {
  return {.relative_tolerance = value, .absolute_tolerance = value};
}

/// Largest deviation from the exact pendulum over all steps.
class Comparison final : public Observer {
 public:
  explicit Comparison(const Pendulum& exact) : exact_(exact) {}
  bool observe(const StepView& view) override {
    const Vector error = view.state - exact_.at(view.time).state;
    largest = std::max(largest, error.lpNorm<Eigen::Infinity>());
    return true;
  }
  double largest = 0.0;

 private:
  const Pendulum& exact_;
};

/// How much the exact motion magnifies a change of its initial angle, at least 1.
double condition(double amplitude, double periods) {
  constexpr double change = 1e-7;
  const Pendulum pendulum(amplitude), other(amplitude + change);
  double largest = 1.0;
  for (int k = 0; k <= 1000; ++k) {
    const double t = pendulum.period() * periods * k * 1e-3;
    const Vector difference = other.at(t).state - pendulum.at(t).state;
    largest = std::max(largest, difference.lpNorm<Eigen::Infinity>() / change);
  }
  return largest;
}

TEST(Pendulum, SolvesItsEquationOfMotion) {
  // The yardstick itself: q̈ from the rod's tension and gravity against differences of the velocity.
  const Pendulum pendulum(150.0 * degree, 0.8, 1.7);
  for (const double t : {0.05, 0.4, 0.9, 2.0}) {
    const double h = 1e-4;
    const Vector slope = (pendulum.at(t + h).state - pendulum.at(t - h).state) / (2.0 * h);
    const auto [state, tension] = pendulum.at(t);
    EXPECT_LE((slope.head(6) - state.tail(6)).lpNorm<Eigen::Infinity>(), 1e-5);
    const Vector acceleration = Vector{{0.0, 0.0, -9.81}} - tension / (0.8 * 1.7) * state.segment(3, 3);
    EXPECT_LE((slope.tail(3) - acceleration).lpNorm<Eigen::Infinity>(), 1e-4);
  }
  EXPECT_LE((pendulum.at(pendulum.period()).state - pendulum.at(0.0).state).lpNorm<Eigen::Infinity>(), 1e-13);
}

TEST(ConstrainedIda, FollowsThePendulumOfEllipticFunctionsToItsTolerance) {
  for (const double degrees : {5.0, 60.0, 120.0, 150.0}) {
    const Pendulum pendulum(degrees * degree);
    const Ivp ivp = pendulum.ivp(3.3);
    const double magnified = condition(degrees * degree, 3.3);
    for (const double asked : {1e-4, 1e-6, 1e-8, 1e-9}) {
      Comparison comparison(pendulum);
      const ConstrainedSolution result =
          solve_constrained(ivp, pendulum.rod(), tolerance(asked), {}, comparison);
      ASSERT_TRUE(result.solution.status.ok()) << result.solution.status.describe();
      EXPECT_EQ(result.solution.time, ivp.t1);
      // Within the error caused by perturbing the initial angle by the tolerance; up to 60 degrees
      // within the tolerance itself.
      EXPECT_LE(comparison.largest, asked * magnified) << degrees << " degrees";
      if (degrees <= 60.0) {
        EXPECT_LE(comparison.largest, asked) << degrees << " degrees";
      }
      RecordProperty(fmt::format("degrees_{}_tolerance_{:g}", degrees, asked),
                     fmt::format("error {:.2g}, drift {:.2g} m and {:.2g} m/s, {} steps, magnified {:.0f}",
                                 comparison.largest, result.position_drift, result.velocity_drift,
                                 result.solution.work.accepted_steps, magnified));
      EXPECT_LE(result.position_drift, asked) << degrees << " degrees";
      EXPECT_LE(result.velocity_drift, asked) << degrees << " degrees";
    }
  }
}

TEST(ConstrainedIda, TellsAPendulumWhoseRodIsTooLongByAPartInAMillion) {
  // Negative control of the comparison above.
  const Pendulum pendulum(60.0 * degree), longer(60.0 * degree, 0.8 * (1.0 + 1e-6));
  Comparison comparison(pendulum);
  const ConstrainedSolution result =
      solve_constrained(longer.ivp(3.3), longer.rod(), tolerance(1e-8), {}, comparison);
  ASSERT_TRUE(result.solution.status.ok()) << result.solution.status.describe();
  EXPECT_GT(comparison.largest, 1e-7);
}

TEST(ConstrainedIda, StartsFromStatesThatAreOffByRounding) {
  // Amplitudes and lengths for which ‖x₀‖ rounds to the length and to its neighbours.
  int off = 0;
  for (const double length : {0.33, 0.7, 0.8000008, 1.1, 1.3}) {
    for (const double degrees : {20.0, 60.0, 77.0}) {
      const Pendulum pendulum(degrees * degree, length);
      Ivp ivp = pendulum.ivp(0.2);
      ivp.y0[9] += 1e-17;
      Vector g(1);
      pendulum.rod().value(ivp.y0.head(6), g);
      off += g[0] != 0.0 ? 1 : 0;
      Comparison comparison(pendulum);
      const Solution solution =
          solve_constrained(ivp, pendulum.rod(), tolerance(1e-9), {}, comparison).solution;
      EXPECT_TRUE(solution.status.ok()) << solution.status.describe();
      EXPECT_LE(comparison.largest, 1e-8);
    }
  }
  EXPECT_GT(off, 0);
}

TEST(ConstrainedIda, HasTheTensionOfTheRodAsMultiplier) {
  const Pendulum pendulum(120.0 * degree);
  double largest = 0.0;
  NullObserver observer;
  const ConstrainedSolution result =
      solve_constrained(pendulum.ivp(2.0), pendulum.rod(), tolerance(1e-9),
                        {.observe_multipliers =
                             [&](double t, ConstVectorRef lambda) {
                               largest = std::max(largest, std::abs(-lambda[0] - pendulum.at(t).tension));
                             }},
                        observer);
  ASSERT_TRUE(result.solution.status.ok()) << result.solution.status.describe();
  EXPECT_LT(largest, 1e-4);  // of up to 50 N; the error test leaves multipliers out
  EXPECT_NEAR(-result.initial_multipliers[0], pendulum.at(0.0).tension, 1e-9);
}

/// Two rods one after the other, let go at right angles.
struct DoublePendulum {
  std::shared_ptr<const mechanics::MassSpringSystem> system;
  Ivp ivp;
  DoublePendulum() {
    mechanics::MassSpringModel model;
    model.mass = {1.0, 1.5, 0.7};
    model.fixed = {0};
    model.gravity = {0.0, 0.0, -9.81};
    system = std::make_shared<const mechanics::MassSpringSystem>(model);
    ivp.system = system;
    ivp.t1 = 4.0;
    ivp.y0 = Vector::Zero(18);
    ivp.y0[3] = 1.0;
    ivp.y0.segment(6, 3) << 1.0, 0.6, 0.0;
    ivp.y0[9 + 8] = 1.3;  // out of the plane of the rods
  }
  DistanceConstraints rods() const { return {*system, {{0, 1, 1.0}, {1, 2, 0.6}}}; }
  double energy(const Vector& y) const { return system->energies(y.head(9), y.tail(9)).total(); }
};

TEST(ConstrainedIda, KeepsTheEnergyAndTheRodsOfADoublePendulum) {
  const DoublePendulum pendulum;
  double previous = 1.0;
  for (const double asked : {1e-5, 1e-7, 1e-9}) {
    class Energy final : public Observer {
     public:
      explicit Energy(const DoublePendulum& system) : system_(system), start_(system.energy(system.ivp.y0)) {}
      bool observe(const StepView& view) override {
        largest = std::max(largest, std::abs(system_.energy(view.state) - start_));
        return true;
      }
      double largest = 0.0;

     private:
      const DoublePendulum& system_;
      double start_;
    } energy(pendulum);
    const ConstrainedSolution result =
        solve_constrained(pendulum.ivp, pendulum.rods(), tolerance(asked), {}, energy);
    ASSERT_TRUE(result.solution.status.ok()) << result.solution.status.describe();
    EXPECT_LT(energy.largest, 10.0 * asked);  // of about 20 J
    EXPECT_LT(energy.largest, previous);
    EXPECT_LT(std::max(result.position_drift, result.velocity_drift), asked);
    previous = energy.largest;
  }
}

TEST(ConstrainedIda, AgreesWithAVeryStiffSpringInPlaceOfTheRod) {
  // The rod as the limit of a spring: the deviation falls with 1/stiffness.
  const Pendulum pendulum(90.0 * degree);
  const Ivp ivp = pendulum.ivp(0.3);
  NullObserver observer;
  const ConstrainedSolution rod = solve_constrained(ivp, pendulum.rod(), tolerance(1e-9), {}, observer);
  ASSERT_TRUE(rod.solution.status.ok());
  const auto deviation = [&](double stiffness) {
    mechanics::MassSpringModel model = dynamic_cast<const mechanics::MassSpringSystem&>(*ivp.system).model();
    model.springs.first = {0};
    model.springs.second = {1};
    model.springs.stiffness = {stiffness};
    model.springs.damping = {0.0};
    model.springs.rest_length = {0.8};
    Ivp sprung = ivp;
    sprung.system = std::make_shared<const mechanics::MassSpringSystem>(model);
    const Solution solution = integrators::run(*integrators::explicit_runge_kutta("rk4"), sprung, 2e-4);
    return (solution.state - rod.solution.state).head(6).lpNorm<Eigen::Infinity>();
  };
  const double soft = deviation(1e5), stiff = deviation(1e6);
  EXPECT_LT(stiff, 1e-4);
  EXPECT_NEAR(soft / stiff, 10.0, 3.0);
}

TEST(ConstrainedIda, HasTheJacobianOfItsResidual) {
  const Ivp network = integrators::random_network(91, {.is_damped = true}, 1.0);
  const SecondOrderSystem& system = *network.system->second_order();
  const DistanceConstraints constraints(system, {{0, 2, 1.1}, {1, 3, 0.9}, {5, 6, 1.4}});
  const auto form = detail::make_constrained_form(system, constraints, {Vector::Zero(3), Vector::Ones(3)});
  const Index size = form->size();
  ASSERT_EQ(size, 48 + 6);
  mechanics::RandomModels random(92);
  Vector y = random.vector(size, 1.0), dydt = random.vector(size, 1.0);
  y.head(48) = network.y0;
  constexpr double cj = 3.7, h = 1e-5;
  const Matrix J = form->jacobian(0.0, cj, y);
  const auto residual = [&](double step, Index k) {
    // Along y + s e_k, ẏ + s cj e_k, whose derivative is a column of cj ∂F/∂ẏ + ∂F/∂y.
    Vector value(size), moved = y, rate = dydt;
    moved[k] += step;
    rate[k] += cj * step;
    form->residual(0.0, moved, rate, value);
    return value;
  };
  for (Index k = 0; k < size; ++k) {
    // What is fixed does not move: its columns in G and H are left out.
    if (k < 48 && system.fixed()[static_cast<std::size_t>(k % 24)]) continue;
    const Vector slope = (residual(h, k) - residual(-h, k)) / (2.0 * h);
    EXPECT_LE((J.col(k) - slope).lpNorm<Eigen::Infinity>(), 1e-6 * J.lpNorm<Eigen::Infinity>())
        << "column " << k;
    EXPECT_GT(J.col(k).lpNorm<Eigen::Infinity>(), 0.1);
  }
}

TEST(ConstrainedIda, FindsMultipliersOfAStateThatMoves) {
  // λ(t₀) depends on the velocity through G(v) v, which only the derivative of G v = 0 knows.
  const DoublePendulum pendulum;
  NullObserver observer;
  const ConstrainedSolution result =
      solve_constrained(pendulum.ivp, pendulum.rods(), tolerance(1e-8), {}, observer);
  const Vector expected = constraints::multipliers(*pendulum.system, pendulum.rods(), 0.0,
                                                   pendulum.ivp.y0.head(9), pendulum.ivp.y0.tail(9));
  ASSERT_EQ(result.initial_multipliers.size(), 2);
  EXPECT_LE((result.initial_multipliers - expected).lpNorm<Eigen::Infinity>(), 1e-8);
  EXPECT_GT(expected.lpNorm<Eigen::Infinity>(), 0.1);
}

TEST(ConstrainedIda, ReportsAStateOffTheConstraintsWithTheLibrarysReasonOrProjectsIt) {
  NullObserver observer;
  const Pendulum pendulum(60.0 * degree);
  Ivp too_long = pendulum.ivp(1.0), too_fast = pendulum.ivp(1.0);
  too_long.y0.segment(3, 3) *= 1.05;
  too_fast.y0[9] += 0.5;
  for (const Ivp& ivp : {too_long, too_fast}) {
    const ConstrainedSolution refused = solve_constrained(ivp, pendulum.rod(), tolerance(1e-6), {}, observer);
    EXPECT_FALSE(refused.solution.status.ok());
    EXPECT_NE(refused.solution.status.message.find("IDA"), std::string::npos);
    EXPECT_NE(refused.solution.status.message.find("at the start |g| ="), std::string::npos)
        << refused.solution.status.describe();
    EXPECT_EQ(refused.solution.time, ivp.t0);
    EXPECT_EQ(refused.solution.state, ivp.y0);
    const ConstrainedSolution projected =
        solve_constrained(ivp, pendulum.rod(), tolerance(1e-6), {.project_initial_state = true}, observer);
    EXPECT_TRUE(projected.solution.status.ok()) << projected.solution.status.describe();
    EXPECT_LT(projected.position_drift, 1e-6);
  }
}

TEST(ConstrainedIda, ReportsRedundantConstraints) {
  const Pendulum pendulum(60.0 * degree);
  const Ivp ivp = pendulum.ivp(1.0);
  const DistanceConstraints twice(*ivp.system->second_order(), {{0, 1, 0.8}, {1, 0, 0.8}});
  NullObserver observer;
  const ConstrainedSolution result = solve_constrained(ivp, twice, tolerance(1e-6), {}, observer);
  EXPECT_EQ(result.solution.status.code, StatusCode::matrix_singular);
  EXPECT_NE(result.solution.status.message.find("1 are independent"), std::string::npos);
}

TEST(ConstrainedIda, StopsWithAStatusWhereTheRodsReachASingularConfiguration) {
  // A particle on two rods of 0.6 m between fixed points whose distance of 1.2 m only just lets them reach:
  // there is no motion, and G loses its rank.
  mechanics::MassSpringModel model;
  model.mass = {1.0, 1.0, 1.0};
  model.fixed = {0, 2};
  const auto system = std::make_shared<const mechanics::MassSpringSystem>(model);
  Ivp ivp;
  ivp.system = system;
  ivp.y0 = Vector::Zero(18);
  ivp.y0[3] = 0.6;
  ivp.y0[6] = 1.2;
  NullObserver observer;
  const ConstrainedSolution result = solve_constrained(
      ivp, DistanceConstraints(*system, {{0, 1, 0.6}, {1, 2, 0.6}}), tolerance(1e-6), {}, observer);
  EXPECT_EQ(result.solution.status.code, StatusCode::matrix_singular);
}

TEST(ConstrainedIda, RefusesWhatMakesNoSense) {
  NullObserver observer;
  const Pendulum pendulum(60.0 * degree);
  const DoublePendulum other;
  EXPECT_THROW(solve_constrained(pendulum.ivp(1.0), other.rods(), tolerance(1e-6), {}, observer), InputError);
  EXPECT_THROW(solve_constrained(pendulum.ivp(1.0), pendulum.rod(), tolerance(0.0), {}, observer),
               InputError);
  const ConstrainedSolution limited = solve_constrained(
      pendulum.ivp(1.0), pendulum.rod(),
      {.relative_tolerance = 1e-6, .absolute_tolerance = 1e-6, .maximum_steps = 5}, {}, observer);
  EXPECT_EQ(limited.solution.status.code, StatusCode::step_limit);
}

}  // namespace
}  // namespace fw::oracles
