#pragma once

#include <cstdint>
#include <limits>
#include <string_view>
#include <variant>

#include "ode/ode_system.hpp"

namespace fw {

/// Constant steps, t_n = t₀ + n·h computed from the index. Where t₁ − t₀ is not a whole number of steps, a
/// one-step scheme takes one shorter last step if `allow_short_last_step`; a multistep scheme refuses.
struct FixedStep {
  double step = 0.0;  ///< h [s], > 0
  bool allow_short_last_step = true;
};

/// Steps chosen by an error estimate: |error_i| ≲ relative·|y_i| + absolute.
struct AdaptiveStep {
  double relative_tolerance = 1e-6;
  double absolute_tolerance = 1e-9;
  /// Of the velocities of a second-order system, in m/s where `absolute_tolerance` is in metres; 0: the same
  /// number.
  double absolute_velocity_tolerance = 0.0;
  double initial_step = 0.0;                                      ///< [s]; 0: chosen by the scheme
  double minimum_step = 0.0;                                      ///< [s]
  double maximum_step = std::numeric_limits<double>::infinity();  ///< [s]
  std::uint64_t maximum_steps = 100'000'000;

  /// Whether velocities have an absolute tolerance of their own on this system.
  bool has_velocity_tolerance(const OdeSystem& system) const;
};

/// The absolute tolerance of each of `size` components, of which those from `first_velocity` on, n of them, are
/// velocities.
Vector absolute_tolerances(const AdaptiveStep& control, Index size, Index first_velocity, Index n);
/// The same of the state of a system.
Vector absolute_tolerances(const AdaptiveStep& control, const OdeSystem& system);

/// Throws InputError that names `method` and the value unless both tolerances are finite and > 0, the first
/// step is finite and >= 0, 0 <= minimum < maximum, and the first step, if given, is at least the minimum.
void check_tolerances(std::string_view method, const AdaptiveStep& control);

using StepControl = std::variant<FixedStep, AdaptiveStep>;

/// How an interval divides into steps.
struct StepCount {
  std::uint64_t whole = 0;  ///< number of steps of length h
  double remainder = 0.0;   ///< length of a shorter last step [s], 0 if none
  std::uint64_t total() const { return whole + (remainder > 0.0 ? 1 : 0); }
};

/// Divides t₁ − t₀ by h. A quotient within a relative 1e-9 of a whole number counts as whole. Throws
/// InputError unless h > 0, t₁ > t₀, both finite, and there are fewer than 2⁵³ steps.
StepCount count_steps(double t0, double t1, double step);

/// The same where no shorter last step is possible, as for multistep schemes: throws InputError that names
/// `method` and the nearest steps that divide the interval if h does not.
StepCount count_whole_steps(std::string_view method, double t0, double t1, double step);

}  // namespace fw
