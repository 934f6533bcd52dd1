#pragma once

#include <initializer_list>
#include <memory>
#include <optional>
#include <vector>

#include "analysis/reference/reference_solution.hpp"
#include "ode/integrator.hpp"
#include "ode/ivp.hpp"

namespace fw::analysis {

/// The problems on which schemes are verified. All are smooth, nonlinear, with masses other than 1 and
/// several degrees of freedom, on intervals whose ends are no special points.

/// M q̈ = f(t, q), 3 degrees of freedom, driven and anharmonic, on [0.3, 2.1].
const Ivp& driven_oscillators();
/// The same with nonlinear damping and a velocity coupling: M q̈ = f(t, q, q̇).
const Ivp& damped_oscillators();
/// ẏ = f(t, y), 3 unknowns, not of second order, on [0.2, 1.7].
const Ivp& first_order_flow();
/// M q̈ = −∇V(q): the Hamiltonian part of `driven_oscillators` on [0, 1.6]; its energy below.
const Ivp& conservative_oscillators();
double conservative_energy(ConstVectorRef y);
/// A spring network of 6 particles with masses other than 1, gravity, undamped, pinned at one corner.
const Ivp& spring_network();
/// The same with dampers and drag.
const Ivp& damped_spring_network();
/// Free of gravity, drag and fixed particles: momentum is conserved.
const Ivp& free_spring_network();

using ProblemFunction = const Ivp& (*)();

/// The first of these that the scheme can run on; null if there is none.
ProblemFunction first_applicable(const MethodInfo& info, std::initializer_list<ProblemFunction> problems);

/// All of these that the scheme can run on.
std::vector<ProblemFunction> applicable_problems(const MethodInfo& info,
                                                 std::initializer_list<ProblemFunction> problems);

/// max_i |y_i − exact_i| / max_i |exact_i|.
double relative_error(ConstVectorRef y, const std::vector<Float128>& exact);

/// The order of values at falling steps; coarse single steps may do anything.
std::optional<double> local_slope(const std::vector<double>& steps, const std::vector<double>& values,
                                  double floor);

/// Least squares slope of log y over log x of all points.
double logarithmic_slope(const std::vector<double>& x, const std::vector<double>& y);

/// A problem from several initial states: in one of them an error coefficient may happen to vanish, hardly in
/// all.
inline constexpr int ensemble_size = 3;
const Ivp& ensemble_member(ProblemFunction problem, int member);
/// The same without a certified end.
Ivp ensemble_start(ProblemFunction problem, int member);
/// The certified end state of a member, computed once per process.
const ReferenceState& certified_end(ProblemFunction problem, int member);

/// The problem on an interval of `length`, for adaptive runs, and its certified end state.
const Ivp& lengthened(ProblemFunction problem, double length);
const ReferenceState& certified_end_of_lengthened(ProblemFunction problem, double length);

/// A problem on an interval long enough for some steps of a high order, and its states at evenly spaced times
/// to 1e-18, the end being the last; computed once per process.
struct FrameReference {
  Ivp ivp;
  std::vector<double> times;  ///< [s]
  std::vector<std::vector<Float128>> states;
};
const FrameReference& certified_frames(ProblemFunction problem);

}  // namespace fw::analysis
