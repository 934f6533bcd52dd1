#include "analysis/binary64_reference.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "integrators/explicit_runge_kutta.hpp"
#include "schemes/high_order_explicit_tableaus.hpp"

namespace fw::analysis {

namespace {

class StopWhenAsked final : public Observer {
 public:
  explicit StopWhenAsked(const std::function<bool()>& is_interrupted) : is_interrupted_(is_interrupted) {}
  bool observe(const StepView&) override { return !is_interrupted_ || !is_interrupted_(); }

 private:
  const std::function<bool()>& is_interrupted_;
};

Solution solve(const Ivp& ivp, const std::string& name, double tolerance,
               const std::function<bool()>& is_interrupted) {
  for (const schemes::ButcherTableau& tableau : schemes::high_order_explicit_tableaus()) {
    if (tableau.name != name) continue;
    const double size = std::max(ivp.y0.lpNorm<Eigen::Infinity>(), std::numeric_limits<double>::min());
    const AdaptiveStep control{.relative_tolerance = tolerance,
                               .absolute_tolerance = 1e-2 * tolerance * size,
                               .maximum_step = (ivp.t1 - ivp.t0) / 64.0};
    StopWhenAsked observer(is_interrupted);
    return integrators::make_explicit_runge_kutta(tableau)->solve(ivp, control, observer);
  }
  throw std::logic_error("no explicit tableau of the name " + name);
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

ReferenceSolution binary64_reference(const Ivp& ivp, const std::function<bool()>& is_interrupted) {
  ReferenceSolution reference;
  const Solution fine = solve(ivp, "dormand_prince_853", 1e-13, is_interrupted);
  reference.work = fine.work;
  reference.status = fine.status;
  if (!fine.status.ok()) return reference;
  const Solution coarse = solve(ivp, "verner_87", 1e-12, is_interrupted);
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
