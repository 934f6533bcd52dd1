// Our tableaus in our engine and in ARKODE's.
#include <gtest/gtest.h>

#include <cmath>

#include "integrators/network.hpp"
#include "integrators/tableau/additive_runge_kutta.hpp"
#include "ode/functor_system.hpp"
#include "oracles/sundials/ark_step_memory.hpp"
#include "oracles/sundials/arkode.hpp"
#include "schemes/additive_tableaus.hpp"
#include "schemes/order_conditions.hpp"

namespace fw::oracles {
namespace {

using integrators::random_network;
using schemes::ButcherTableau;

constexpr double same_step = 1e-13;
constexpr int highest_order = 6;

/// Nonlinear, coupled and dependent on time.
struct Driven {
  template <class S>
  void operator()(const S& t, std::span<const S> y, std::span<S> dydt) const {
    using std::cos, std::sin;
    dydt[0] = y[1] * y[2] + S(0.5) * cos(S(3.0) * t);
    dydt[1] = -y[0] * y[2] - sin(y[1]) + t * t;
    dydt[2] = S(0.3) * y[0] * y[1] - S(2.0) * y[2] * y[2] + sin(t) * y[0];
  }
};

Ivp driven_problem() {
  Ivp ivp;
  ivp.system = std::make_shared<FunctorSystem<Driven>>(3, Driven{});
  ivp.t0 = 0.3;
  ivp.t1 = 1.3;
  ivp.y0 = Vector{{1.1, -0.7, 0.4}};
  return ivp;
}

std::vector<Ivp> problems() {
  return {driven_problem(), random_network(71, {.is_damped = true}, 0.4)};
}

/// Steps of a length that divides nothing.
double step_of(const Ivp& ivp) {
  return (ivp.t1 - ivp.t0) / 17.3;
}

/// max_n ‖y_n − z_n‖_∞ / max_n ‖y_n‖_∞ over all steps of both runs.
double largest_difference(const Integrator& first, const Integrator& second, const Ivp& ivp) {
  TrajectoryRecorder a, b;
  const FixedStep control{.step = step_of(ivp)};
  EXPECT_TRUE(first.solve(ivp, control, a).status.ok()) << first.info().title;
  const Solution solution = second.solve(ivp, control, b);
  EXPECT_TRUE(solution.status.ok()) << second.info().title << solution.status.describe();
  EXPECT_EQ(a.times(), b.times());
  double largest = 0.0, scale = 0.0;
  for (std::size_t n = 0; n < std::min(a.states().size(), b.states().size()); ++n) {
    largest = std::max(largest, (a.states()[n] - b.states()[n]).lpNorm<Eigen::Infinity>());
    scale = std::max(scale, a.states()[n].lpNorm<Eigen::Infinity>());
  }
  return largest / scale;
}

std::vector<ButcherTableau> up_to_highest_order(const std::vector<ButcherTableau>& list) {
  std::vector<ButcherTableau> result;
  for (const ButcherTableau& tableau : list) {
    if (order_of_accuracy(tableau) <= highest_order) result.push_back(tableau);
  }
  return result;
}

TEST(SameTableau, GivesTheSameStepsInArkodeForEveryExplicitTableau) {
  const auto list = up_to_highest_order(schemes::explicit_tableaus());
  EXPECT_GE(list.size(), 17u);
  for (const ButcherTableau& tableau : list) {
    for (const Ivp& ivp : problems()) {
      const double difference = largest_difference(*integrators::make_explicit_runge_kutta(tableau),
                                                   *make_arkode_erk(tableau), ivp);
      EXPECT_LE(difference, same_step) << tableau.name;
      RecordProperty(tableau.name + "_" + std::to_string(ivp.y0.size()), std::to_string(difference * 1e16));
    }
  }
}

TEST(SameTableau, GivesTheSameStepsInArkodeForEveryDiagonallyImplicitTableau) {
  const auto list = up_to_highest_order(schemes::diagonally_implicit_tableaus());
  EXPECT_GE(list.size(), 11u);
  for (const ButcherTableau& tableau : list) {
    for (const Ivp& ivp : problems()) {
      const double difference = largest_difference(
          *integrators::make_diagonally_implicit_runge_kutta(tableau), *make_arkode_dirk(tableau), ivp);
      EXPECT_LE(difference, same_step) << tableau.name;
      RecordProperty(tableau.name + "_" + std::to_string(ivp.y0.size()), std::to_string(difference * 1e16));
    }
  }
}

TEST(SameTableau, GivesTheSameStepsInArkodeForEveryAdditiveTableau) {
  for (const schemes::AdditiveTableau& tableau : schemes::additive_tableaus()) {
    const double difference =
        largest_difference(*integrators::make_additive_runge_kutta(tableau), *make_arkode_imex(tableau),
                           random_network(71, {.is_damped = true}, 0.4));
    EXPECT_LE(difference, same_step) << tableau.name;
    RecordProperty(tableau.name, std::to_string(difference * 1e16));
  }
}

TEST(SameTableau, IsToldFromOneWithACoefficientThatIsOffByAPartInTenThousandMillions) {
  // Negative control, one coefficient after the other. (Of Dormand and Prince's method, stage 2 has no weight
  // and enters the others in a combination that is small: its coefficient alone would not be seen.)
  for (const Ivp& ivp : problems()) {
    const ButcherTableau& right = integrators::named(schemes::explicit_tableaus(), "dormand_prince_54");
    const auto ours = integrators::make_explicit_runge_kutta(right);
    for (std::size_t i = 2; i < right.A.size() - 1; ++i) {
      ButcherTableau wrong = right;
      wrong.A[i][0] = schemes::Coefficient(right.A[i][0].value() + Float128(1e-10));
      EXPECT_GT(largest_difference(*ours, *make_arkode_erk(wrong), ivp), same_step) << "row " << i;
    }
    const ButcherTableau& implicit = integrators::named(schemes::diagonally_implicit_tableaus(), "sdirk4");
    const auto our_implicit = integrators::make_diagonally_implicit_runge_kutta(implicit);
    for (std::size_t i = 0; i < implicit.A.size(); ++i) {
      ButcherTableau wrong = implicit;
      wrong.A[i][i] = schemes::Coefficient(implicit.A[i][i].value() + Float128(1e-10));
      EXPECT_GT(largest_difference(*our_implicit, *make_arkode_dirk(wrong), ivp), same_step) << "row " << i;
    }
  }
}

/// ARKODE's estimate of the error of one step of length h, y' − ŷ', from ARKStepGetEstLocalErrors. Its
/// tolerance is so wide that it takes the step, and Newton's so small that it solves the stages.
Vector arkode_error_estimate(const detail::ArkodeTables& tables, const Ivp& ivp, double h) {
  using namespace detail;
  constexpr double tolerance = 1e3;
  Vector state = ivp.y0, estimate(ivp.y0.size());
  RunReport report;
  Work work;
  const ContextPointer context = make_context();
  const VectorPointer y = wrap_eigen_vector(state, context.get());
  const VectorPointer e = wrap_eigen_vector(estimate, context.get());
  auto whole = make_whole_right_hand_side(*ivp.system);
  const bool is_explicit = tables.explicit_part != nullptr;
  ArkStepMemory ark(ivp.t0, y.get(), is_explicit ? std::move(whole) : nullptr,
                    is_explicit ? nullptr : std::move(whole), tables, report, work, context.get());
  ark.choose_steps({.relative_tolerance = 1e-10, .absolute_tolerance = tolerance, .initial_step = h},
                   Vector::Constant(ivp.y0.size(), tolerance), {.newton_coefficient = 1e-15 / tolerance});
  if (!is_explicit) {
    EXPECT_EQ(ARKStepSetMaxNonlinIters(ark.get(), 30), 0);
  }
  double t = ivp.t0;
  EXPECT_EQ(ARKStepEvolve(ark.get(), ivp.t1, y.get(), &t, ARK_ONE_STEP), ARK_SUCCESS) << report.message;
  EXPECT_EQ(t, ivp.t0 + h);
  EXPECT_EQ(ARKStepGetEstLocalErrors(ark.get(), e.get()), 0);
  return estimate;
}

/// The same by our engine: one step with the weights b and one with b̂.
Vector our_error_estimate(const ButcherTableau& tableau, Ivp ivp, double h) {
  ivp.t1 = ivp.t0 + h;
  ButcherTableau embedded = tableau;
  embedded.b = tableau.b_embedded;
  embedded.b_embedded.clear();
  embedded.dense.clear();
  NullObserver observer;
  const auto end = [&](const ButcherTableau& data) {
    const auto scheme = shape(data) == schemes::TableauShape::explicit_stages
                            ? integrators::make_explicit_runge_kutta(data)
                            : integrators::make_diagonally_implicit_runge_kutta(data);
    return scheme->solve(ivp, FixedStep{.step = h}, observer).state;
  };
  return end(tableau) - end(embedded);
}

TEST(SameTableau, GivesTheSameErrorEstimateInArkode) {
  int explicit_count = 0, implicit_count = 0;
  for (const Ivp& ivp : problems()) {
    const double h = 2.0 * step_of(ivp), scale = ivp.y0.lpNorm<Eigen::Infinity>();
    const auto check = [&](const ButcherTableau& tableau, const detail::ArkodeTables& tables) {
      const Vector ours = our_error_estimate(tableau, ivp, h);
      const Vector theirs = arkode_error_estimate(tables, ivp, h);
      EXPECT_LE((ours - theirs).lpNorm<Eigen::Infinity>(), same_step * scale) << tableau.name;
      // The estimates are no mere rounding, or nothing would have been compared.
      EXPECT_GT(ours.lpNorm<Eigen::Infinity>(), 1e4 * same_step * scale) << tableau.name;
    };
    for (const ButcherTableau& tableau : up_to_highest_order(schemes::explicit_tableaus())) {
      if (tableau.b_embedded.empty()) continue;
      check(tableau, detail::explicit_tables(tableau));
      ++explicit_count;
    }
    for (const ButcherTableau& tableau : up_to_highest_order(schemes::diagonally_implicit_tableaus())) {
      if (tableau.b_embedded.empty()) continue;
      check(tableau, detail::diagonally_implicit_tables(tableau));
      ++implicit_count;
    }
  }
  EXPECT_GE(explicit_count, 12);
  EXPECT_GE(implicit_count, 8);
}

}  // namespace
}  // namespace fw::oracles
