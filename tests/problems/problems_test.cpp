#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <set>

#include "analysis/reference/reference_solution.hpp"
#include "core/error.hpp"
#include "problems/every_problem.hpp"
#include "problems/parameter.hpp"

namespace fw::problems {
namespace {

using analysis::certified_reference;

class EveryProblem : public testing::TestWithParam<ProblemEntry> {
 protected:
  Problem problem = GetParam().make({});
  const OdeSystem& system = *problem.ivp.system;

  /// A state off the initial one, a third into the interval or less (Robertson's is long).
  Vector state_on_the_way() const {
    const double t = problem.ivp.t0 + std::min(0.3, 0.31 * (problem.ivp.t1 - problem.ivp.t0));
    const auto reference = certified_reference(problem.ivp, t);
    EXPECT_TRUE(reference.status.ok()) << reference.status.describe();
    return reference.states.at(0).rounded();
  }
};

std::string name_of(const testing::TestParamInfo<ProblemEntry>& info) {
  return info.param.name;
}
INSTANTIATE_TEST_SUITE_P(Problems, EveryProblem, testing::ValuesIn(every_problem()), name_of);

TEST_P(EveryProblem, IsDescribedAndWellPosed) {
  EXPECT_EQ(problem.name, GetParam().name);
  EXPECT_FALSE(problem.title.empty());
  EXPECT_FALSE(problem.description.empty());
  EXPECT_FALSE(problem.source.empty());
  EXPECT_EQ(problem.ivp.y0.size(), system.size());
  EXPECT_LT(problem.ivp.t0, problem.ivp.t1);
  EXPECT_GT(problem.stiffness(), 0.0);
  for (const auto& [name, value] : GetParam().defaults) {
    EXPECT_NE(problem.parameters.find(name + "="), std::string::npos) << name;
  }
}

TEST_P(EveryProblem, RoundsItsExtendedInitialStateToItsInitialState) {
  const auto extended = initial_state_extended(problem.ivp);
  ASSERT_EQ(static_cast<Index>(extended.size()), problem.ivp.y0.size());
  for (std::size_t i = 0; i < extended.size(); ++i) {
    EXPECT_EQ(static_cast<double>(extended[i]), problem.ivp.y0[static_cast<Index>(i)]);
  }
}

TEST_P(EveryProblem, RefusesParametersItDoesNotHave) {
  try {
    GetParam().make({{"stifness", 1.0}});
    FAIL() << "accepted";
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("stifness"), std::string::npos) << message;
    EXPECT_NE(message.find(problem.name), std::string::npos) << message;
    for (const auto& [name, value] : GetParam().defaults) {
      EXPECT_NE(message.find(name), std::string::npos) << message;
    }
  }
}

TEST_P(EveryProblem, EvaluatesTheSameSlopeInEveryArithmetic) {
  const Vector y = state_on_the_way();
  const auto n = static_cast<std::size_t>(y.size());
  const double t = 0.3;
  Vector slope(y.size());
  system.rhs(t, y, slope);
  std::vector<Float128> y_extended(y.data(), y.data() + y.size()), slope_extended(n);
  system.rhs(Float128(t), y_extended, std::span<Float128>(slope_extended));
  std::vector<Complex> y_complex(y.data(), y.data() + y.size()), slope_complex(n);
  system.rhs(t, std::span<const Complex>(y_complex), std::span<Complex>(slope_complex));
  const double rounding =
      1e-14 * std::max(slope.cwiseAbs().maxCoeff(), problem.stiffness() * y.cwiseAbs().maxCoeff());
  for (std::size_t i = 0; i < n; ++i) {
    const double value = slope[static_cast<Index>(i)];
    EXPECT_NEAR(value, static_cast<double>(slope_extended[i]), rounding);
    EXPECT_NEAR(value, slope_complex[i].real(), rounding);
    EXPECT_EQ(slope_complex[i].imag(), 0.0);
  }
}

TEST_P(EveryProblem, HasAJacobianThatCentralDifferencesInBinary128Confirm) {
  const Vector y = state_on_the_way();
  const double t = 0.3;
  SparseMatrix J = system.jacobian_pattern();
  system.jacobian(t, y, J);
  const Matrix dense(J);
  const auto n = static_cast<std::size_t>(y.size());
  const Float128 delta = 1e-10;
  double size = 0.0, worst = 0.0;
  for (std::size_t j = 0; j < n; ++j) {
    std::vector<Float128> up(y.data(), y.data() + y.size()), down = up, f_up(n), f_down(n);
    up[j] += delta;
    down[j] -= delta;
    system.rhs(Float128(t), up, std::span<Float128>(f_up));
    system.rhs(Float128(t), down, std::span<Float128>(f_down));
    for (std::size_t i = 0; i < n; ++i) {
      const auto difference = static_cast<double>((f_up[i] - f_down[i]) / (2 * delta));
      worst = std::max(worst, std::abs(difference - dense(static_cast<Index>(i), static_cast<Index>(j))));
      size = std::max(size, std::abs(difference));
    }
  }
  EXPECT_LE(worst, 1e-12 * size);
}

TEST_P(EveryProblem, StartsAndMovesAsItsClosedFormSays) {
  if (!problem.exact) {
    EXPECT_FALSE(problem.exact);
    return;
  }
  const auto start = problem.exact(problem.ivp.t0);
  const auto y0 = initial_state_extended(problem.ivp);
  ASSERT_EQ(start.size(), y0.size());
  for (std::size_t i = 0; i < y0.size(); ++i) {
    EXPECT_LT(static_cast<double>(abs(start[i] - y0[i])), 1e-31);
  }
  // d/dt of the closed form by a central difference of order 8 equals f.
  const Float128 t = 0.37 * problem.ivp.t1, h = 1e-3 / (1 + problem.ivp.t1);
  const Float128 weight[] = {Float128(4) / 5, Float128(-1) / 5, Float128(4) / 105, Float128(-1) / 280};
  std::vector<Float128> slope(y0.size()), derivative(y0.size(), 0);
  system.rhs(t, problem.exact(t), std::span<Float128>(slope));
  for (int k = 1; k <= 4; ++k) {
    const auto ahead = problem.exact(t + k * h), behind = problem.exact(t - k * h);
    for (std::size_t i = 0; i < y0.size(); ++i) derivative[i] += weight[k - 1] * (ahead[i] - behind[i]) / h;
  }
  for (std::size_t i = 0; i < y0.size(); ++i) {
    EXPECT_LT(static_cast<double>(abs(slope[i] - derivative[i])),
              1e-17 * (1 + std::pow(problem.stiffness() / 10, 9)));
  }
}

TEST_P(EveryProblem, KeepsItsInvariantsAlongTheReference) {
  if (problem.invariants.empty()) return;  // none are claimed
  const double t1 = std::min(problem.ivp.t1, 1.3);
  const std::vector<double> times = {0.21 * t1, 0.5 * t1, t1};
  const auto reference = certified_reference(problem.ivp, times);
  ASSERT_TRUE(reference.status.ok()) << reference.status.describe();
  for (const Invariant& invariant : problem.invariants) {
    const double start = invariant.value(problem.ivp.t0, problem.ivp.y0);
    const double size = std::max(std::abs(start), problem.ivp.y0.cwiseAbs().maxCoeff());
    for (const auto& state : reference.states) {
      // The invariants are evaluated in double: rounding grows with the size of their terms only.
      EXPECT_NEAR(invariant.value(state.time, state.rounded()), start, 4e-14 * size) << invariant.name;
    }
    const Vector elsewhere = (1.01 * reference.states.back().rounded().array() + 0.01).matrix();
    EXPECT_GT(std::abs(invariant.value(t1, elsewhere) - start), 1e-6 * size)
        << invariant.name << " sees nothing";
  }
}

TEST(Parameters, AreReadAsTheDecimalsThatPeopleWrite) {
  EXPECT_EQ(Parameter(0.6).decimal(), Float128(3) / 5);
  EXPECT_NE(Parameter(0.6).decimal(), Float128(0.6));
  EXPECT_EQ(Parameter(0.6).as<double>(), 0.6);
  EXPECT_EQ(Parameter(-1e3).decimal(), Float128(-1000));
}

TEST(Parameters, OutOfRangeAreRefused) {
  EXPECT_THROW(kepler({{"eccentricity", 1.0}}), InputError);
  EXPECT_THROW(kepler({{"eccentricity", -0.1}}), InputError);
  EXPECT_NO_THROW(kepler({{"eccentricity", 0.0}}));
  EXPECT_THROW(harmonic_oscillator({{"mass", 0.0}}), InputError);
  EXPECT_THROW(damped_oscillator({{"damping", -1.0}}), InputError);
  EXPECT_THROW(linear_chain({{"count", 2.5}}), InputError);
  EXPECT_THROW(linear_chain({{"count", 0.0}}), InputError);
  EXPECT_THROW(van_der_pol({{"epsilon", std::nan("")}}), InputError);
}

TEST(Parameters, OverrideDefaultsAndAppearInTheText) {
  EXPECT_EQ(harmonic_oscillator({{"stiffness", 0.1}}).parameters, "mass=2, stiffness=0.1");
  EXPECT_EQ(rotation().parameters, "");
}

TEST(EveryProblemName, IsUnique) {
  std::set<std::string> names;
  for (const ProblemEntry& entry : every_problem())
    EXPECT_TRUE(names.insert(entry.name).second) << entry.name;
}

TEST(DampedOscillator, MatchesTheReferenceUnderCriticallyAndOverdamped) {
  for (const double damping : {0.5, 4.0, 9.0}) {  // m = 2, k = 2: critical at c = 4
    const Problem problem = damped_oscillator({{"mass", 2.0}, {"stiffness", 2.0}, {"damping", damping}});
    const auto exact = problem.exact(Float128(3.3));
    const auto reference = certified_reference(problem.ivp, 3.3);
    ASSERT_TRUE(reference.status.ok());
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_LT(static_cast<double>(abs(exact[i] - reference.states[0].value[i])), 1e-29) << damping;
    }
  }
}

TEST(LinearChain, HasTheStiffnessOfItsHighestMode) {
  const Problem problem = linear_chain({{"count", 12.0}, {"mass", 0.3}, {"stiffness", 7.0}});
  SparseMatrix J = problem.ivp.system->jacobian_pattern();
  problem.ivp.system->jacobian(0.0, problem.ivp.y0, J);
  EXPECT_NEAR(Matrix(J).eigenvalues().cwiseAbs().maxCoeff(), problem.stiffness(),
              1e-10 * problem.stiffness());
}

TEST(Stiffness, IsThatOfThePerihelionForKepler) {
  const double e = 0.6;
  EXPECT_NEAR(kepler().stiffness(), std::sqrt(2.0 / std::pow(1.0 - e, 3)), 0.02 * kepler().stiffness());
}

TEST(Stiffness, FollowsTheSolutionWhereItStiffens) {
  // At the start J has the eigenvalues −3/ε and about 0; Robertson starts at 0.04 and stiffens.
  EXPECT_NEAR(van_der_pol({{"epsilon", 1e-6}}).stiffness(), 3e6, 0.05 * 3e6);
  EXPECT_GT(robertson().stiffness(), 2e3);
  EXPECT_LT(robertson().stiffness(), 4e3);
}

}  // namespace
}  // namespace fw::problems
