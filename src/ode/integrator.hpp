#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/status.hpp"
#include "core/work.hpp"
#include "ode/capabilities.hpp"
#include "ode/ivp.hpp"
#include "ode/observer.hpp"
#include "ode/solve_options.hpp"
#include "ode/step_control.hpp"

namespace fw {

/// The end of a run. States on the way are streamed to the observer.
struct Solution {
  double time = 0.0;  ///< the time reached [s]: t₁ on success
  Vector state;       ///< y at that time
  Status status;
  Work work;
  std::uint64_t switches = 0;  ///< kinks and jumps of the right-hand side that steps were cut at
  /// What makes the numbers doubtful although the run ended well, sentences for people: contacts shorter than
  /// the steps, solids crossed within one.
  std::vector<std::string> warnings{};
};

/// What is known of a scheme, for lists, claims and checks.
struct MethodInfo {
  std::string name{};    ///< as it is called on the command line, for example "velocity_verlet"
  std::string title{};   ///< for people, for example "Velocity Verlet"
  std::string family{};  ///< for example "explicit Runge-Kutta"
  int order = 0;  ///< order of accuracy for forces that depend on position (and for any ẏ = f); 0: variable
  int order_with_velocity_forces = 0;  ///< order where forces depend on velocity
  int stages = 1;                      ///< right-hand sides per step, first-same-as-last not counted twice
  bool is_explicit = true;
  bool is_multistep = false;
  bool is_adaptive = false;    ///< can choose its own steps from tolerances
  bool has_fixed_step = true;  ///< can run with a constant step
  /// A step depends on more than (t, y), an acceleration for example: a single step says little of the
  /// scheme.
  bool carries_more_than_state = false;
  int embedded_order = 0;         ///< order of the solution that the error estimate compares with; 0: none
  bool is_symplectic = false;     ///< for forces f(t, q) that have a potential
  bool is_symmetric = false;      ///< equal to its adjoint: reversible in time where the problem is
  bool conserves_energy = false;  ///< of systems without damping, exactly
  bool is_a_stable = false;
  bool is_l_stable = false;
  Capabilities needs{};  ///< what the system must have; none: any ẏ = f(t, y)
  /// What iterative solvers leave of their equations, relative: conservation holds to it. 0: rounding.
  double iteration_tolerance = 0.0;
  std::string formula{};    ///< one step in formula
  std::string reference{};  ///< literature
};

/// Why a scheme cannot run on this system, as a clause for people ("the method needs ..."); empty if it can.
std::string why_not_applicable(const MethodInfo& info, const OdeSystem& system);

/// The order that a scheme claims on this system: `order_with_velocity_forces` where forces depend on
/// velocity, else `order`.
int order_on(const MethodInfo& info, const OdeSystem& system);

/// Solves `ivp` in binary128 with `steps` constant steps and gives the end state. For orders that double
/// cannot show.
using ExtendedSolver = std::function<std::vector<Float128>(const Ivp& ivp, std::uint64_t steps)>;

/// A time integrator. It is immutable; all state of a run lives in the run.
class Integrator {
 public:
  virtual ~Integrator() = default;

  virtual const MethodInfo& info() const = 0;

  /// The same scheme in binary128; an empty function where there is none.
  virtual const ExtendedSolver& extended_solver() const = 0;

  /// Solves `ivp` and shows every accepted step to `observer`. A numerical failure is a Status of the
  /// returned Solution, whose time and state are the last good ones. Throws InputError where the scheme
  /// cannot do what is asked (wrong kind of step control, structure missing, a multistep scheme with a broken
  /// interval, a foreign scheme that is to be saved). A run that was asked to stop has the status
  /// interrupted.
  Solution solve(const Ivp& ivp, const StepControl& control, Observer& observer,
                 const SolveOptions& options = {}) const;

 private:
  virtual Solution do_solve(const Ivp& ivp, const StepControl& control, Observer& observer,
                            const SolveOptions& options) const = 0;
};

}  // namespace fw
