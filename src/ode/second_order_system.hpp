#pragma once

#include <cstdint>
#include <vector>

#include "core/types.hpp"
#include "ode/force_splitting.hpp"

namespace fw {

/// What the force depends on; schemes claim their order per class (erratum E6: explicit Verlet schemes fall
/// to order 1 when a damper is evaluated at a lagged velocity).
enum class ForceClass {
  position,  ///< f = f(t, q)
  velocity,  ///< f = f(t, q, v)
};

/// Which tangent stiffness goes into a *matrix*. The force itself is never changed by this choice.
enum class TangentModel {
  exact,                   ///< K = ∂f/∂q
  tensile_geometric_term,  ///< springs keep max(1 − l₀/L, 0) in place of 1 − l₀/L
  psd_projection,          ///< each element's block is projected onto the negative semi-definite cone
};

/// The second-order system M q̈ = f(t, q, q̇) with a constant diagonal mass matrix.
///
/// Arrays have one entry per degree of freedom (particle i owns 3i, 3i+1, 3i+2 in a mass-spring system).
/// A fixed degree of freedom keeps its row: its force is exactly zero and its velocity is zero, so that sizes
/// never change. Implementations are immutable while they are being evaluated and safe to share.
class SecondOrderSystem {
 public:
  virtual ~SecondOrderSystem() = default;

  /// Number of degrees of freedom n.
  virtual Index degrees_of_freedom() const = 0;

  /// Diagonal of M, n entries > 0 [kg].
  virtual const Vector& mass() const = 0;

  /// n flags; nonzero where the degree of freedom never moves.
  virtual const std::vector<char>& fixed() const = 0;

  virtual ForceClass force_class() const = 0;

  /// Whether this is a mass-spring system, for schemes that are made for springs.
  virtual bool has_springs() const { return false; }

  /// f(t, q, v) [N]; rows of fixed degrees of freedom are zero.
  virtual void force(double t, ConstVectorRef q, ConstVectorRef v, VectorRef f) const = 0;

  /// An n×n matrix of zeros with the union of the patterns of M, K and D; symmetric pattern, diagonal
  /// included. Asked for at the start of a run and when `pattern_revision` has changed.
  virtual SparseMatrix tangent_pattern() const = 0;

  /// K = ∂f/∂q [N/m] into a matrix from `tangent_pattern()`. Rows of fixed degrees of freedom are zero (their
  /// columns are not). Throws InputError if `model` is not available for this system.
  virtual void stiffness(double t, ConstVectorRef q, ConstVectorRef v, TangentModel model,
                         SparseMatrix& K) const = 0;

  /// D = ∂f/∂v [N·s/m] into a matrix from `tangent_pattern()`; rows of fixed degrees of freedom are zero.
  virtual void damping(double t, ConstVectorRef q, ConstVectorRef v, SparseMatrix& D) const = 0;

  /// out = K·dq + D·dv with the exact K and D, without assembly.
  virtual void tangent_product(double t, ConstVectorRef q, ConstVectorRef v, ConstVectorRef dq,
                               ConstVectorRef dv, VectorRef out) const = 0;

  /// The forces in a stiff and a soft part, or null where the system knows no such splitting.
  virtual const ForceSplitting* force_splitting() const { return nullptr; }

  /// Changes when `tangent_pattern` does, which may happen between steps and never during one (contacts that
  /// are found at accepted steps). A system whose pattern is fixed leaves it at 0.
  virtual std::uint64_t pattern_revision() const { return 0; }
};

}  // namespace fw
