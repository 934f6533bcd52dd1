#pragma once

#include <cstdint>
#include <span>

#include "core/extended_precision.hpp"
#include "core/types.hpp"
#include "ode/second_order_system.hpp"

namespace fw {

class SwitchingSurfaces;

/// The first-order system ẏ = f(t, y), y ∈ ℝᴺ.
///
/// Every right-hand side is written once over the scalar and offered in three arithmetics: double for the
/// schemes, Float128 for certified references, std::complex<double> for the complex-step check of Jacobians.
/// Implementations are immutable while they are being evaluated and safe to share.
class OdeSystem {
 public:
  virtual ~OdeSystem() = default;

  /// N.
  virtual Index size() const = 0;

  /// dydt = f(t, y).
  virtual void rhs(double t, ConstVectorRef y, VectorRef dydt) const = 0;
  /// The same in binary128.
  virtual void rhs(const Float128& t, std::span<const Float128> y, std::span<Float128> dydt) const = 0;
  /// The analytic continuation of f to complex states (branches look at the real part).
  virtual void rhs(double t, std::span<const Complex> y, std::span<Complex> dydt) const = 0;

  /// An N×N matrix of zeros with the pattern of J = ∂f/∂y and a full diagonal. Asked for at the start of a
  /// run and when `pattern_revision` has changed.
  virtual SparseMatrix jacobian_pattern() const = 0;

  /// J(t, y) = ∂f/∂y into a matrix from `jacobian_pattern()`.
  virtual void jacobian(double t, ConstVectorRef y, SparseMatrix& J) const = 0;

  /// out = J(t, y)·w without assembly.
  virtual void jacobian_product(double t, ConstVectorRef y, ConstVectorRef w, VectorRef out) const = 0;

  /// The structure y = (q, v), M v̇ = f(t, q, v), or null where there is none. Then N = 2n, the first n
  /// entries of y are positions and the last n velocities.
  virtual const SecondOrderSystem* second_order() const { return nullptr; }

  /// Where f has kinks or jumps, or null where it has none or does not know of any. Only systems with
  /// `second_order` have them. May change where elements do.
  virtual const SwitchingSurfaces* switching_surfaces() const { return nullptr; }

  /// Changes when `jacobian_pattern` does, which may happen between steps and never during one (contacts that
  /// are found at accepted steps). A system whose pattern is fixed leaves it at 0.
  virtual std::uint64_t pattern_revision() const { return 0; }
};

}  // namespace fw
