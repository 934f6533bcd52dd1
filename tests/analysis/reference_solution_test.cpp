#include "analysis/reference/reference_solution.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/constants/constants.hpp>
#include <cmath>
#include <stdexcept>

#include "analysis/gauss_collocation.hpp"
#include "core/error.hpp"
#include "ode/functor_system.hpp"
#include "problems/every_problem.hpp"

namespace fw::analysis {
namespace {

using namespace fw::problems;

Float128 largest_difference(const std::vector<Float128>& a, const std::vector<Float128>& b) {
  Float128 largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, Float128(abs(a[i] - b[i])));
  return largest;
}

/// Every component is at most its claimed error away from `truth`.
void expect_within_claim(const ReferenceState& state, const std::vector<Float128>& truth,
                         const std::string& name) {
  ASSERT_EQ(state.value.size(), truth.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_LE(abs(state.value[i] - truth[i]), state.error[i])
        << name << " component " << i << ": true error "
        << static_cast<double>(abs(state.value[i] - truth[i])) << ", claimed "
        << static_cast<double>(state.error[i]);
  }
}

TEST(CertifiedReference, IsWithinItsClaimedErrorOfEveryClosedForm) {
  int checked = 0;
  for (const ProblemEntry& entry : every_problem()) {
    const Problem problem = entry.make({});
    if (!problem.exact) continue;
    checked += 1;
    const std::vector<double> times = {0.3 * problem.ivp.t1, 0.71 * problem.ivp.t1, problem.ivp.t1};
    const auto reference = certified_reference(problem.ivp, times);
    ASSERT_TRUE(reference.status.ok()) << problem.name << ": " << reference.status.describe();
    ASSERT_EQ(reference.states.size(), times.size());
    for (const ReferenceState& state : reference.states) {
      const auto truth = problem.exact(Float128(state.time));
      EXPECT_LT(static_cast<double>(largest_difference(state.value, truth)), 1e-28) << problem.name;
      EXPECT_LT(state.largest_error(), 1e-26) << problem.name;
      // The closed form itself is rounded: allow for that where the two resolutions agree even better.
      auto allowed = state;
      for (Float128& error : allowed.error) error += 1e-31;
      expect_within_claim(allowed, truth, problem.name);
    }
  }
  EXPECT_EQ(checked, 9);
}

TEST(CertifiedReference, AgreesWithGaussCollocationWithinItsClaimedError) {
  struct Case {
    Problem problem;
    double time;
    int steps;
  };
  const Case cases[] = {{kepler(), 2.0, 60},
                        {driven_duffing(), 1.7, 20},
                        {henon_heiles(), 3.1, 20},
                        {spring_pendulum(), 0.3, 40},
                        {pleiades(), 0.2, 20},
                        {fermi_pasta_ulam(), 0.3, 60},
                        {van_der_pol({{"epsilon", 0.1}}), 0.5, 60}};
  const GaussCollocation gauss(12);
  for (const Case& c : cases) {
    const auto reference = certified_reference(c.problem.ivp, c.time);
    ASSERT_TRUE(reference.status.ok()) << c.problem.name << ": " << reference.status.describe();
    auto state = reference.states.at(0);
    const Float128 size = *std::max_element(state.value.begin(), state.value.end());
    for (Float128& error : state.error) error += 1e-30 * abs(size);  // the rounding of the collocation
    expect_within_claim(state, gauss.integrate(c.problem.ivp, c.time, c.steps), c.problem.name);
  }
}

TEST(CertifiedReference, IsCheckedByACollocationThatHasItsOrder) {
  // The checker is checked: two stages have order 4.
  const Problem problem = kepler();
  const auto truth = problem.exact(Float128(1));
  const GaussCollocation gauss(2);
  const auto coarse = largest_difference(gauss.integrate(problem.ivp, 1.0, 100), truth);
  const auto fine = largest_difference(gauss.integrate(problem.ivp, 1.0, 200), truth);
  EXPECT_NEAR(std::log2(static_cast<double>(coarse / fine)), 4.0, 0.02);
}

TEST(CertifiedReference, GivesTheSameStateAmongManyTimesAsAlone) {
  const Problem problem = driven_duffing();
  std::vector<double> times = {0.0};
  for (int i = 1; i <= 40; ++i) times.push_back(0.09 * i);
  times.push_back(times.back());  // twice the same
  const auto many = certified_reference(problem.ivp, times);
  const auto one = certified_reference(problem.ivp, times.back());
  ASSERT_TRUE(many.status.ok() && one.status.ok());
  ASSERT_EQ(many.states.size(), times.size());
  EXPECT_EQ(largest_difference(many.states.front().value, initial_state_extended(problem.ivp)), 0);
  EXPECT_EQ(largest_difference(many.states[41].value, many.states[40].value), 0);
  EXPECT_LT(static_cast<double>(largest_difference(many.states.back().value, one.states[0].value)),
            one.states[0].largest_error() + 1e-31);
}

TEST(CertifiedReference, StartsFromTheExtendedInitialState) {
  Problem problem = henon_heiles();
  const auto extended = certified_reference(problem.ivp, 1.0);
  problem.ivp.y0_extended.clear();
  const auto rounded = certified_reference(problem.ivp, 1.0);
  const auto difference =
      static_cast<double>(largest_difference(extended.states[0].value, rounded.states[0].value));
  EXPECT_GT(difference, 1e-18);  // 1/10 is no double: the difference is 5.6e-18 at the start
  EXPECT_LT(difference, 1e-16);
}

TEST(CertifiedReference, CountsWhatItDoes) {
  const auto reference = certified_reference(kepler().ivp, 1.0);
  EXPECT_GT(reference.work.rhs_evaluations, 10 * reference.work.accepted_steps);
  EXPECT_GT(reference.work.accepted_steps, 50u);
  EXPECT_EQ(reference.source, ReferenceSource::certified);
  EXPECT_FALSE(reference.cached);
}

TEST(CertifiedReference, RefusesTimesOutOfOrder) {
  const Problem problem = kepler();
  const std::vector<double> backwards = {2.0, 1.0}, before = {-1.0}, not_finite = {std::nan("")};
  EXPECT_THROW(certified_reference(problem.ivp, backwards), InputError);
  EXPECT_THROW(certified_reference(problem.ivp, before), InputError);
  EXPECT_THROW(certified_reference(problem.ivp, not_finite), InputError);
}

// --- It never claims more than it has
// ---------------------------------------------------------------------------

TEST(CertifiedReference, SaysSoWhereToleranceLeavesTheSolutionUnresolved) {
  ReferenceOptions loose;
  loose.fine.tolerance = 1e-10;
  loose.coarse.tolerance = 1e-6;
  const Problem problem = kepler();
  const auto reference = certified_reference(problem.ivp, 20.0, loose);
  EXPECT_EQ(reference.status.code, StatusCode::accuracy_not_reached);
  ASSERT_EQ(reference.states.size(), 1u);
  EXPECT_GT(reference.states[0].largest_error(), 1e-13);
  expect_within_claim(reference.states[0], problem.exact(Float128(20)), "kepler");
}

TEST(CertifiedReference, DetectsAWrongExtrapolationWeight) {
  // Each single wrong weight leaves a consistent method of low order: the error test then forces tiny steps
  // and the run fails, or the resolutions disagree. What must not happen is success with a wrong value.
  const Problem problem = kepler();
  for (const auto& [row, column] :
       {std::pair<std::size_t, std::size_t>{1, 1}, {4, 2}, {7, 7}, {9, 9}, {9, 1}}) {
    ReferenceOptions damaged;
    for (ExtrapolationSettings* settings : {&damaged.fine, &damaged.coarse}) {
      settings->step_limit = 2000;
      if (row < settings->tableau.rows()) settings->tableau.divisor[row][column] *= 1.01;
    }
    const auto reference = certified_reference(problem.ivp, 5.0, damaged);
    if (reference.status.ok()) {
      expect_within_claim(reference.states.at(0), problem.exact(Float128(5)), "damaged");
    } else {
      EXPECT_TRUE(reference.status.code == StatusCode::accuracy_not_reached ||
                  reference.status.code == StatusCode::step_limit)
          << reference.status.describe();
    }
  }
}

TEST(CertifiedReference, DetectsAWrongWeightThatTheErrorTestCannotSee) {
  // An error test that passes everything leaves only the second resolution to see the damage. Both runs then
  // end at the same row: it is the different steps that tell.
  const Problem problem = kepler();
  const auto run_with = [&problem](double damage) {
    ReferenceOptions options;
    options.accuracy = 1e-10;
    for (ExtrapolationSettings* settings : {&options.fine, &options.coarse}) {
      settings->tolerance = 1e3;
      settings->tableau.divisor[1][1] *= damage;
    }
    options.fine.least_steps = 29;
    options.coarse.least_steps = 20;
    return certified_reference(problem.ivp, 1.0, options);
  };
  const auto sound = run_with(1.0);
  EXPECT_TRUE(sound.status.ok()) << sound.status.describe();
  const auto damaged = run_with(0.5);
  EXPECT_EQ(damaged.status.code, StatusCode::accuracy_not_reached);
  EXPECT_GT(damaged.states.at(0).largest_error(), 100 * sound.states.at(0).largest_error());
}

TEST(CertifiedReference, NeverTakesTheSameStepsTwice) {
  // Equal steps and rows would make the two runs equal, whatever their error.
  const Problem problem = rotation();
  std::vector<double> times;
  for (int i = 1; i <= 200; ++i) times.push_back(0.01 * i);  // outputs denser than any step
  ReferenceOptions options;
  options.fine.tolerance = options.coarse.tolerance;
  options.fine.tableau = options.coarse.tableau;
  const auto coarse = integrate_by_extrapolation(problem.ivp, times, options.coarse);
  const auto fine = integrate_by_extrapolation(problem.ivp, times, options.fine);
  EXPECT_GE(fine.work.accepted_steps, 2 * coarse.work.accepted_steps - 50);
}

struct Explosion {
  template <class S>
  void operator()(const S&, std::span<const S> y, std::span<S> dydt) const {
    dydt[0] = y[0] * y[0];  // y(0) = 1: y = 1/(1 − t)
  }
};

TEST(CertifiedReference, FailsWithAStatusWhereTheSolutionExplodes) {
  const Ivp ivp{std::make_shared<FunctorSystem<Explosion>>(1, Explosion{}), 0.0, 2.0, Vector::Ones(1), {}};
  const auto before = certified_reference(ivp, 0.875);
  ASSERT_TRUE(before.status.ok()) << before.status.describe();
  EXPECT_LT(static_cast<double>(abs(before.states[0].value[0] - 8)), 1e-29);
  const auto beyond = certified_reference(ivp, 2.0);
  EXPECT_FALSE(beyond.status.ok());
  EXPECT_FALSE(beyond.status.message.empty());
  EXPECT_TRUE(beyond.states.empty());
}

TEST(CertifiedReference, StopsAtItsStepLimitWhereTheProblemIsTooStiff) {
  ReferenceOptions options;
  options.fine.step_limit = options.coarse.step_limit = 500;
  const auto reference = certified_reference(prothero_robinson({{"lambda", -1e6}}).ivp, 1.3, options);
  EXPECT_EQ(reference.status.code, StatusCode::step_limit);
  EXPECT_TRUE(reference.states.empty());
}

// --- Right-hand sides with kinks and jumps
// ----------------------------------------------------------------------

/// q̈ = −k q − c q̇ for q > 0, else 0: a bumper at the origin. c = 0: kink, c > 0: jump at the impact.
struct Bumper {
  double k, c;
  template <class S>
  void operator()(const S&, std::span<const S> q, std::span<const S> v, std::span<S> f) const {
    f[0] = real_part(q[0]) > 0 ? -S(k) * q[0] - S(c) * v[0] : S(0);
  }
};

/// From q = −1 with v = 1 the bumper is reached at t = 1 and left π/ω later with v = −e^{−cπ/(2ω)}.
std::vector<Float128> after_the_bumper(double k, double c, const Float128& t) {
  const Float128 omega = sqrt(Float128(k) - Float128(c) * c / 4);
  const Float128 contact = boost::math::constants::pi<Float128>() / omega;
  const Float128 speed = exp(-Float128(c) / 2 * contact);
  return {-speed * (t - 1 - contact), -speed};
}

TEST(CertifiedReference, ClosesInOnKinksAndJumps) {
  for (const double c : {0.0, 0.5}) {
    const double k = 40.0;
    Ivp ivp{std::make_shared<FunctorSecondOrderSystem<Bumper>>(Vector::Ones(1), ForceClass::velocity,
                                                               Bumper{k, c}),
            0.0,
            3.0,
            Vector(2),
            {}};
    ivp.y0 << -1.0, 1.0;
    const auto reference = certified_reference(ivp, 3.0);
    ASSERT_TRUE(reference.status.ok()) << reference.status.describe();
    EXPECT_GT(reference.work.rejected_steps, 10u);
    EXPECT_LT(reference.work.rhs_evaluations, 200'000u);
    const auto truth = after_the_bumper(k, c, 3.0);
    EXPECT_LT(static_cast<double>(largest_difference(reference.states[0].value, truth)), 1e-27) << c;
    auto state = reference.states[0];
    for (Float128& error : state.error) error += 1e-31;
    expect_within_claim(state, truth, "bumper");
  }
}

struct Chatter {  // from above and from below to y = 0, where neither slope can stay
  template <class S>
  void operator()(const S&, std::span<const S> y, std::span<S> dydt) const {
    dydt[0] = real_part(y[0]) > 0 ? S(-1) : S(2);
  }
};

TEST(CertifiedReference, GivesUpWithAStatusOnARightHandSideThatIsNoFunctionOfTheState) {
  const Ivp ivp{std::make_shared<FunctorSystem<Chatter>>(1, Chatter{}), 0.0, 2.0, Vector::Ones(1), {}};
  ReferenceOptions options;
  options.fine.step_limit = options.coarse.step_limit = 20'000;
  const auto reference = certified_reference(ivp, 2.0, options);
  EXPECT_TRUE(reference.status.code == StatusCode::step_too_small ||
              reference.status.code == StatusCode::step_limit)
      << reference.status.describe();
}

// --- Closed forms
// -----------------------------------------------------------------------------------------------

TEST(Reference, UsesTheClosedFormWhereThereIsOne) {
  const Problem problem = kepler();
  const auto solution = reference(problem, 100.0);
  EXPECT_EQ(solution.source, ReferenceSource::exact);
  EXPECT_EQ(solution.work.accepted_steps, 0u);
  EXPECT_EQ(largest_difference(solution.states.at(0).value, problem.exact(Float128(100))), 0);
  EXPECT_LT(solution.states[0].largest_error(), 1e-29);
  EXPECT_GT(solution.states[0].largest_error(), 1e-32);
  EXPECT_EQ(reference(henon_heiles(), 1.0).source, ReferenceSource::certified);
}

TEST(CertifiedReference, TellsItsProgressWhichChangesNothingAndMayEndIt) {
  const Ivp ivp = henon_heiles().ivp;
  std::vector<double> told;
  ReferenceOptions options;
  options.progress = [&](double fraction) { told.push_back(fraction); };
  const ReferenceSolution with = certified_reference(ivp, 5.0, options),
                          without = certified_reference(ivp, 5.0);
  EXPECT_EQ(largest_difference(with.states.at(0).value, without.states.at(0).value), 0);
  ASSERT_EQ(told.size(), with.work.accepted_steps);
  EXPECT_GT(told.front(), 0.0);
  EXPECT_TRUE(std::ranges::is_sorted(told));
  EXPECT_EQ(std::ranges::count(told, ReferenceOptions::coarse_share), 1);
  EXPECT_DOUBLE_EQ(told.back(), 1.0);
  options.progress = [](double fraction) {
    if (fraction > 0.1) throw std::runtime_error("enough");
  };
  EXPECT_THROW(certified_reference(ivp, 5.0, options), std::runtime_error);
}

}  // namespace
}  // namespace fw::analysis
