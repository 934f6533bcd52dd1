#pragma once

#include <optional>
#include <string>

#include "core/status.hpp"
#include "core/work.hpp"
#include "ode/ivp.hpp"
#include "ode/observer.hpp"
#include "ode/step_control.hpp"

namespace fw {

/// The end of a run. States on the way are streamed to the observer.
struct Solution {
  double time = 0.0;  ///< the time reached [s]: t₁ on success
  Vector state;       ///< y at that time
  Status status;
  Work work;
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
  bool is_adaptive = false;  ///< chooses its own steps from tolerances
  bool is_symplectic = false;
  bool is_a_stable = false;
  bool is_l_stable = false;
  bool needs_second_order = false;  ///< works on M q̈ = f(t, q, v) only
  std::string formula{};            ///< one step in formula
  std::string reference{};          ///< literature
};

/// A time integrator. It is immutable; all state of a run lives in the run.
class Integrator {
 public:
  virtual ~Integrator() = default;

  virtual const MethodInfo& info() const = 0;

  /// Solves `ivp` and shows every accepted step to `observer`. A numerical failure is a Status of the
  /// returned Solution, whose time and state are the last good ones. Throws InputError where the scheme
  /// cannot do what is asked (wrong kind of step control, structure missing, a multistep scheme with a broken
  /// interval).
  Solution solve(const Ivp& ivp, const StepControl& control, Observer& observer) const;

 private:
  virtual Solution do_solve(const Ivp& ivp, const StepControl& control, Observer& observer) const = 0;
};

}  // namespace fw
