#pragma once

#include "core/types.hpp"

namespace fw {

/// A splitting of the forces of a second-order system, f(t, q, v) = f_stiff + f_soft, for schemes that treat
/// fast and slow forces differently: additive (implicit–explicit) Runge–Kutta and multiple time steps.
///
/// Sizes, units and fixed degrees of freedom are as in `SecondOrderSystem`: both forces are zero on fixed
/// rows. Implementations are immutable while they are being evaluated and safe to share.
class ForceSplitting {
 public:
  virtual ~ForceSplitting() = default;

  /// f_stiff(t, q, v) [N].
  virtual void stiff_force(double t, ConstVectorRef q, ConstVectorRef v, VectorRef f) const = 0;

  /// f_soft(t, q, v) [N].
  virtual void soft_force(double t, ConstVectorRef q, ConstVectorRef v, VectorRef f) const = 0;

  /// ∂f_stiff/∂q [N/m] into a matrix of the system's `tangent_pattern()`; exact.
  virtual void stiff_stiffness(double t, ConstVectorRef q, ConstVectorRef v, SparseMatrix& K) const = 0;

  /// ∂f_stiff/∂v [N·s/m] into a matrix of the system's `tangent_pattern()`.
  virtual void stiff_damping(double t, ConstVectorRef q, ConstVectorRef v, SparseMatrix& D) const = 0;
};

}  // namespace fw
