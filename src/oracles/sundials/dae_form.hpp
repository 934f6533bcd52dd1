#pragma once

#include <memory>

#include "ode/ode_system.hpp"
#include "ode/step_control.hpp"

namespace fw::oracles::detail {

/// An implicit system F(t, y, ẏ) = 0 as IDA solves it, with work space of its own for one run.
class DaeForm {
 public:
  virtual ~DaeForm() = default;

  /// N, the number of unknowns.
  virtual Index size() const = 0;

  /// Whether y is the state [q; v] of particles, nothing else.
  virtual bool is_of_particles() const { return false; }

  /// Of each unknown.
  virtual Vector tolerances(const AdaptiveStep& control) const {
    return Vector::Constant(size(), control.absolute_tolerance);
  }

  /// residual = F(t, y, ẏ).
  virtual void residual(double t, ConstVectorRef y, ConstVectorRef dydt, VectorRef residual) = 0;

  /// A matrix with the pattern of the Jacobian at the start; `jacobian` takes another one when the system's
  /// `pattern_revision` has changed.
  virtual const SparseMatrix& pattern() const = 0;

  /// cj ∂F/∂ẏ + ∂F/∂y.
  virtual const SparseMatrix& jacobian(double t, double cj, ConstVectorRef y) = 0;
};

/// ẏ − f(t, y) = 0, or where the system has second order q̇ − v = 0, M v̇ − f(t, q, v) = 0. The system
/// outlives it.
std::unique_ptr<DaeForm> make_residual_form(const OdeSystem& system);

}  // namespace fw::oracles::detail
