#include "analysis/reference/reference_solution.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "core/error.hpp"

namespace fw::analysis {
namespace {

void check_input(const Ivp& ivp, std::span<const double> times, const ReferenceOptions& options) {
  if (!ivp.system) throw InputError("reference: initial value problem without a system");
  const std::size_t size = initial_state_extended(ivp).size();
  if (static_cast<Index>(size) != ivp.system->size()) {
    throw InputError(
        fmt::format("reference: initial state has {} values, expected {}", size, ivp.system->size()));
  }
  double previous = ivp.t0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (!std::isfinite(times[i]) || times[i] < previous) {
      throw InputError(
          fmt::format("reference: time[{}] is {}, expected a finite number >= {}", i, times[i], previous));
    }
    previous = times[i];
  }
  for (const ExtrapolationSettings* settings : {&options.fine, &options.coarse}) {
    if (settings->tableau.rows() < 2)
      throw InputError("reference: an extrapolation tableau needs at least 2 rows");
    if (settings->least_steps < 1 || settings->least_steps_per_output < 1) {
      throw InputError("reference: the least number of steps has to be at least 1");
    }
    if (!(settings->tolerance > 0.0)) {
      throw InputError(fmt::format("reference: tolerance is {}, expected a number > 0", settings->tolerance));
    }
  }
}

void add(Work& sum, const Work& work) {
  sum.rhs_evaluations += work.rhs_evaluations;
  sum.accepted_steps += work.accepted_steps;
  sum.rejected_steps += work.rejected_steps;
}

/// Both runs start anew at the same surfaces, and both know the depth in a stiff solid to the rounding of
/// coordinates only: their difference is a sample of the error and not a bound. Ten times that, and no less than what
/// some thousand roundings of the largest value do.
Float128 error_behind_switches(const Float128& fine, const Float128& coarse, const Float128& scale) {
  return std::max(Float128(10 * abs(fine - coarse)), Float128(1e4 * float128_epsilon * scale));
}

/// The first component and time whose error is above what was asked for, as a failure.
Status judge(const std::vector<ReferenceState>& states, const std::vector<Float128>& scale, double accuracy) {
  const Float128 largest = scale.empty() ? Float128(0) : *std::max_element(scale.begin(), scale.end());
  Status status;
  double worst = 1.0;
  for (const ReferenceState& state : states) {
    for (std::size_t i = 0; i < state.value.size(); ++i) {
      const Float128 allowed = accuracy * std::max(scale[i], Float128(1e-9 * largest));
      const double ratio = allowed > 0 ? static_cast<double>(state.error[i] / allowed) : 0.0;
      if (ratio <= worst) continue;
      worst = ratio;
      status = {
          StatusCode::accuracy_not_reached,
          fmt::format("component {} at t = {:.6g}: the two resolutions differ by {:.3g}, asked was {:.3g}", i,
                      state.time, static_cast<double>(state.error[i]), static_cast<double>(allowed))};
    }
  }
  return status;
}

}  // namespace

Vector ReferenceState::rounded() const {
  Vector y(static_cast<Index>(value.size()));
  for (std::size_t i = 0; i < value.size(); ++i) y[static_cast<Index>(i)] = static_cast<double>(value[i]);
  return y;
}

double ReferenceState::largest_error() const {
  return error.empty() ? 0.0 : static_cast<double>(*std::max_element(error.begin(), error.end()));
}

ReferenceSolution certified_reference(const Ivp& ivp, std::span<const double> times,
                                      const ReferenceOptions& options) {
  check_input(ivp, times, options);
  const auto start = std::chrono::steady_clock::now();
  ReferenceSolution reference;
  const ExtrapolationRun coarse = integrate_by_extrapolation(ivp, times, options.coarse);
  add(reference.work, coarse.work);
  ExtrapolationRun fine;
  if (coarse.status.ok()) {
    fine = integrate_by_extrapolation(ivp, times, options.fine);
    add(reference.work, fine.work);
  }
  reference.work.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

  const bool has_switches = ivp.system->switching_surfaces() != nullptr;
  for (std::size_t n = 0; n < std::min(coarse.states.size(), fine.states.size()); ++n) {
    ReferenceState state{times[n], fine.states[n], {}};
    for (std::size_t i = 0; i < state.value.size(); ++i) {
      if (has_switches) {
        state.error.push_back(error_behind_switches(fine.states[n][i], coarse.states[n][i], fine.scale[i]));
        continue;
      }
      // Two runs may agree to the last bit; neither is then better than the rounding of its own result.
      state.error.push_back(std::max(Float128(abs(fine.states[n][i] - coarse.states[n][i])),
                                     Float128(float128_epsilon * abs(state.value[i]))));
    }
    reference.states.push_back(std::move(state));
  }
  if (!coarse.status.ok()) {
    reference.status = coarse.status;
  } else if (!fine.status.ok()) {
    reference.status = fine.status;
  } else {
    reference.status = judge(reference.states, fine.scale, options.accuracy);
  }
  return reference;
}

ReferenceSolution certified_reference(const Ivp& ivp, double time, const ReferenceOptions& options) {
  return certified_reference(ivp, std::span<const double>(&time, 1), options);
}

ReferenceSolution reference(const Problem& problem, std::span<const double> times,
                            const ReferenceOptions& options) {
  if (!problem.exact) return certified_reference(problem.ivp, times, options);
  check_input(problem.ivp, times, options);
  ReferenceSolution solution;
  solution.source = ReferenceSource::exact;
  std::vector<Float128> slope(static_cast<std::size_t>(problem.ivp.system->size()));
  for (const double time : times) {
    ReferenceState state{time, problem.exact(Float128(time)), {}};
    problem.ivp.system->rhs(Float128(time), state.value, std::span<Float128>(slope));
    Float128 state_norm = 0, slope_norm = 0;
    for (std::size_t i = 0; i < slope.size(); ++i) {
      state_norm = std::max(state_norm, Float128(abs(state.value[i])));
      slope_norm = std::max(slope_norm, Float128(abs(slope[i])));
    }
    state.error.assign(slope.size(), 64 * float128_epsilon * (state_norm + std::abs(time) * slope_norm));
    solution.states.push_back(std::move(state));
  }
  return solution;
}

ReferenceSolution reference(const Problem& problem, double time, const ReferenceOptions& options) {
  return reference(problem, std::span<const double>(&time, 1), options);
}

}  // namespace fw::analysis
