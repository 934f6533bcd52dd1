#include "analysis/reference/binary64_reference.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>

#include "integrators/tableau/explicit_runge_kutta.hpp"
#include "schemes/high_order_explicit_tableaus.hpp"

namespace fw::analysis {

namespace {

std::unique_ptr<Integrator> make(const std::string& name) {
  for (const schemes::ButcherTableau& tableau : schemes::high_order_explicit_tableaus()) {
    if (tableau.name == name) return integrators::make_explicit_runge_kutta(tableau);
  }
  throw std::logic_error("no explicit tableau of the name " + name);
}

Solution solve(const Ivp& ivp, const Integrator& integrator, double tolerance, StopToken stop) {
  const double size = std::max(ivp.y0.lpNorm<Eigen::Infinity>(), std::numeric_limits<double>::min());
  const AdaptiveStep control{.relative_tolerance = tolerance,
                             .absolute_tolerance = 1e-1 * tolerance * size,
                             .maximum_step = (ivp.t1 - ivp.t0) / 64.0};
  NullObserver observer;
  return integrator.solve(ivp, control, observer, {.stop = stop});
}

/// Writes the largest entry of |difference| into all of `error`, at least the rounding of the state.
void bound(const Vector& difference, const Vector& state, Index first, Index count,
           std::vector<Float128>& error) {
  if (count == 0) return;
  const double rounding =
      4.0 * std::numeric_limits<double>::epsilon() * state.segment(first, count).lpNorm<Eigen::Infinity>();
  const double largest = std::max(difference.segment(first, count).lpNorm<Eigen::Infinity>(), rounding);
  std::fill_n(error.begin() + first, count, Float128(largest));
}

}  // namespace

ReferenceSolution binary64_reference(const Ivp& ivp, StopToken stop) {
  // Tighter tolerances drown in rounding where springs are stiff: h (k/m) x eps is the noise of a step.
  // Their order conditions take longer than many a run.
  static const std::unique_ptr<Integrator> fine_method = make("dormand_prince_853");
  static const std::unique_ptr<Integrator> coarse_method = make("verner_87");
  ReferenceSolution reference;
  const Solution fine = solve(ivp, *fine_method, 1e-11, stop);
  reference.work = fine.work;
  reference.status = fine.status;
  if (!fine.status.ok()) return reference;
  const Solution coarse = solve(ivp, *coarse_method, 1e-10, stop);
  reference.work.rhs_evaluations += coarse.work.rhs_evaluations;
  reference.work.seconds += coarse.work.seconds;
  reference.status = coarse.status;
  if (!coarse.status.ok()) return reference;
  const Vector difference = fine.state - coarse.state;
  ReferenceState state;
  state.time = ivp.t1;
  state.value.assign(fine.state.begin(), fine.state.end());
  state.error.resize(state.value.size());
  const Index n = fine.state.size();
  const Index positions = ivp.system->second_order() != nullptr ? n / 2 : n;
  bound(difference, fine.state, 0, positions, state.error);
  bound(difference, fine.state, positions, n - positions, state.error);
  reference.states.push_back(std::move(state));
  return reference;
}

}  // namespace fw::analysis
