#include "oracles/sundials/cvode_sensitivity.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "core/error.hpp"
#include "integrators/network.hpp"
#include "problems/oscillators.hpp"

namespace fw::oracles {
namespace {

using mechanics::MassSpringModel;
using mechanics::MassSpringSystem;
using mechanics::SpringParameter;
using mechanics::SpringParameterGroup;

constexpr AdaptiveStep tight_sensitivity{.relative_tolerance = 1e-9, .absolute_tolerance = 1e-11};

/// A mass on a spring along x, fixed at the origin.
struct Oscillator {
  double mass = 1.3, stiffness = 40.0, damping = 0.7, rest_length = 0.8;
  double x0 = 1.1, v0 = -0.4, end = 2.3;

  Ivp ivp() const {
    MassSpringModel model;
    model.mass = {1.0, mass};
    model.fixed = {0};
    model.springs = {{0}, {1}, {stiffness}, {damping}, {rest_length}, mechanics::SpringLaw::hooke};
    Ivp problem;
    problem.system = std::make_shared<const MassSpringSystem>(std::move(model));
    problem.y0 = Vector::Zero(12);
    problem.y0[3] = x0;
    problem.y0[9] = v0;
    problem.t1 = end;
    return problem;
  }

  /// (x, v) at the end: a damped harmonic oscillation about l₀.
  std::pair<Complex, Complex> exact(Complex k, Complex c, Complex l0) const {
    const Complex decay = c / (2.0 * mass), omega = std::sqrt(k / mass - decay * decay);
    const Complex a = x0 - l0, b = (v0 + decay * a) / omega;
    const Complex cosine = std::cos(omega * end), sine = std::sin(omega * end);
    const Complex envelope = std::exp(-decay * end);
    return {l0 + envelope * (a * cosine + b * sine),
            envelope * ((b * omega - decay * a) * cosine - (a * omega + decay * b) * sine)};
  }

  /// ∂(x, v)/∂(k_s, k_d, l₀), exact by complex steps in the closed form.
  Eigen::Matrix<double, 2, 3> exact_sensitivity() const {
    Eigen::Matrix<double, 2, 3> s;
    for (int p = 0; p < 3; ++p) {
      const Complex step(0.0, 1e-200);
      const auto [x, v] = exact(stiffness + (p == 0 ? step : 0.0), damping + (p == 1 ? step : 0.0),
                                rest_length + (p == 2 ? step : 0.0));
      s(0, p) = x.imag() / 1e-200;
      s(1, p) = v.imag() / 1e-200;
    }
    return s;
  }
};

const std::vector<SpringParameterGroup> one_of_each = {
    {SpringParameter::stiffness}, {SpringParameter::damping}, {SpringParameter::rest_length}};

std::vector<SensitivityOptions> all_options() {
  std::vector<SensitivityOptions> list;
  for (const auto formula : {CvodeFormula::bdf, CvodeFormula::adams}) {
    for (const auto corrector : {SensitivityCorrector::simultaneous, SensitivityCorrector::staggered}) {
      for (const auto solver : {CvodeLinearSolver::klu, CvodeLinearSolver::spgmr}) {
        for (const auto vector : {VectorOperations::eigen, VectorOperations::serial}) {
          list.push_back({formula,
                          {.iteration = CvodeIteration::newton, .linear_solver = solver, .vector = vector},
                          corrector,
                          true});
        }
      }
    }
  }
  return list;
}

TEST(CvodeSensitivity, AgreesWithTheClosedFormOfTheDampedOscillator) {
  const Oscillator oscillator;
  const Eigen::Matrix<double, 2, 3> exact = oscillator.exact_sensitivity();
  for (const SensitivityOptions& options : all_options()) {
    const auto result =
        solve_with_cvode_sensitivities(oscillator.ivp(), tight_sensitivity, one_of_each, options);
    ASSERT_TRUE(result.solution.status.ok()) << result.solution.status.describe();
    ASSERT_EQ(result.sensitivity.rows(), 12);
    ASSERT_EQ(result.sensitivity.cols(), 3);
    const auto [x, v] = oscillator.exact(oscillator.stiffness, oscillator.damping, oscillator.rest_length);
    EXPECT_NEAR(result.solution.state[3], x.real(), 1e-8);
    EXPECT_NEAR(result.solution.state[9], v.real(), 1e-7);
    for (int p = 0; p < 3; ++p) {
      const double size = exact.col(p).norm();
      EXPECT_NEAR(result.sensitivity(3, p), exact(0, p), 1e-7 * size) << p;
      EXPECT_NEAR(result.sensitivity(9, p), exact(1, p), 1e-7 * size) << p;
      // The fixed particle and the other directions do not move.
      EXPECT_EQ(result.sensitivity.col(p).cwiseAbs().sum(),
                std::abs(result.sensitivity(3, p)) + std::abs(result.sensitivity(9, p)));
    }
  }
}

TEST(CvodeSensitivity, SeesAMissingFactorInTheClosedForm) {
  // Sensitivities are linear in ∂f/∂p: with −r in place of −k_s r they would be these, divided by k_s.
  const Oscillator oscillator;
  const auto result = solve_with_cvode_sensitivities(oscillator.ivp(), tight_sensitivity, one_of_each);
  const double exact = oscillator.exact_sensitivity()(0, 2);
  EXPECT_GT(std::abs(result.sensitivity(3, 2) / oscillator.stiffness - exact), 0.5 * std::abs(exact));
}

Ivp shifted(const Ivp& ivp, const SpringParameterGroup& group, double by) {
  MassSpringModel model = dynamic_cast<const MassSpringSystem&>(*ivp.system).model();
  std::vector<double>& numbers = group.parameter == SpringParameter::stiffness ? model.springs.stiffness
                                 : group.parameter == SpringParameter::damping ? model.springs.damping
                                                                               : model.springs.rest_length;
  if (group.springs.empty()) {
    for (double& number : numbers) number += by;
  }
  for (const int e : group.springs) numbers[static_cast<std::size_t>(e)] += by;
  Ivp other = ivp;
  other.system = std::make_shared<const MassSpringSystem>(std::move(model));
  return other;
}

Vector central_difference(const Ivp& ivp, const SpringParameterGroup& group, double h) {
  NullObserver observer;
  const AdaptiveStep control{.relative_tolerance = 1e-10, .absolute_tolerance = 1e-12};
  const auto end = [&](double by) {
    return make_cvode_adams()->solve(shifted(ivp, group, by), control, observer).state;
  };
  return (end(h) - end(-h)) / (2.0 * h);
}

TEST(CvodeSensitivity, AgreesWithCentralDifferencesThatConvergeToIt) {
  for (const auto law :
       {mechanics::SpringLaw::hooke, mechanics::SpringLaw::strain, mechanics::SpringLaw::tension_only}) {
    const Ivp ivp = integrators::random_network(51 + static_cast<std::uint64_t>(law), {.law = law}, 0.8);
    const std::vector<SpringParameterGroup> parameters = {{SpringParameter::stiffness},
                                                          {SpringParameter::damping},
                                                          {SpringParameter::rest_length},
                                                          {SpringParameter::stiffness, {3}},
                                                          {SpringParameter::rest_length, {0, 5}}};
    const auto result = solve_with_cvode_sensitivities(ivp, tight_sensitivity, parameters);
    ASSERT_TRUE(result.solution.status.ok()) << result.solution.status.describe();
    for (std::size_t k = 0; k < parameters.size(); ++k) {
      const Vector s = result.sensitivity.col(static_cast<Index>(k));
      // A rope that becomes taut makes the end state less smooth in p: differences of first order only.
      const bool is_rope = law == mechanics::SpringLaw::tension_only;
      const double tolerance = is_rope ? 1e-3 : 2e-6;
      const double h =
          (parameters[k].parameter == SpringParameter::rest_length ? 4e-3 : 4e-2) * (is_rope ? 1e-2 : 1.0);
      const Vector coarse = central_difference(ivp, parameters[k], h);
      const Vector fine = central_difference(ivp, parameters[k], 0.5 * h);
      const double size = s.lpNorm<Eigen::Infinity>();
      const Vector richardson = (4.0 * fine - coarse) / 3.0;
      EXPECT_LT((richardson - s).lpNorm<Eigen::Infinity>(), tolerance * size) << "parameter " << k;
      if (is_rope) continue;
      // Errors of order h² where they are above the rounding of the differences.
      const double far = (coarse - s).norm(), near = (fine - s).norm();
      if (far > 1e-6 * size) {
        EXPECT_NEAR(far / near, 4.0, 0.2) << "parameter " << k;
      }
      // Negative control: an error of one part in a thousand is seen.
      EXPECT_GT((richardson - 1.001 * s).lpNorm<Eigen::Infinity>(), 2e-6 * size);
    }
  }
}

TEST(CvodeSensitivity, OfAllSpringsIsTheSumOverSingleOnes) {
  const Ivp ivp = integrators::random_network(61, {}, 0.5);
  const auto springs =
      static_cast<int>(dynamic_cast<const MassSpringSystem&>(*ivp.system).model().springs.size());
  std::vector<SpringParameterGroup> parameters = {{SpringParameter::rest_length}};
  for (int e = 0; e < springs; ++e) parameters.push_back({SpringParameter::rest_length, {e}});
  const auto result = solve_with_cvode_sensitivities(ivp, tight_sensitivity, parameters);
  ASSERT_TRUE(result.solution.status.ok());
  const Vector all = result.sensitivity.col(0);
  EXPECT_LT((all - result.sensitivity.rightCols(springs).rowwise().sum()).lpNorm<Eigen::Infinity>(),
            1e-7 * all.lpNorm<Eigen::Infinity>());
}

TEST(CvodeSensitivity, ControlsTheErrorOfTheSensitivities) {
  // Loose tolerances: with error control the steps are shorter and the sensitivities better.
  const Oscillator oscillator;
  const double exact = oscillator.exact_sensitivity()(0, 0);
  SensitivityOptions options;
  options.cvode.tolerance_factor = 1.0;
  const AdaptiveStep loose{.relative_tolerance = 1e-5, .absolute_tolerance = 1e-7};
  const auto with = solve_with_cvode_sensitivities(oscillator.ivp(), loose, one_of_each, options);
  options.error_control = false;
  const auto without = solve_with_cvode_sensitivities(oscillator.ivp(), loose, one_of_each, options);
  EXPECT_GE(with.solution.work.accepted_steps, without.solution.work.accepted_steps);
  EXPECT_LT(std::abs(with.sensitivity(3, 0) - exact), 1e-3 * std::abs(exact));
}

TEST(CvodeSensitivity, RefusesWhatItCannotDo) {
  const Oscillator oscillator;
  EXPECT_THROW(solve_with_cvode_sensitivities(oscillator.ivp(), tight_sensitivity, {}), InputError);
  EXPECT_THROW(solve_with_cvode_sensitivities(oscillator.ivp(), tight_sensitivity,
                                              {{SpringParameter::stiffness, {1}}}),
               InputError);
  SensitivityOptions adams;
  adams.formula = CvodeFormula::adams;
  EXPECT_THROW(solve_with_cvode_sensitivities(oscillator.ivp(), tight_sensitivity, one_of_each, adams),
               InputError);
  EXPECT_THROW(
      solve_with_cvode_sensitivities(problems::harmonic_oscillator().ivp, tight_sensitivity, one_of_each),
      InputError);
}

TEST(CvodeSensitivity, GivesNoneWhereTheRunFails) {
  AdaptiveStep control = tight_sensitivity;
  control.maximum_steps = 3;
  const auto result = solve_with_cvode_sensitivities(Oscillator{}.ivp(), control, one_of_each);
  EXPECT_EQ(result.solution.status.code, StatusCode::step_limit);
  EXPECT_EQ(result.sensitivity.size(), 0);
}

}  // namespace
}  // namespace fw::oracles
