#pragma once

#include "constraints/distance_constraints.hpp"
#include "core/status.hpp"

namespace fw::constraints {

/// G M⁻¹ Gᵀ, m×m, by which multipliers follow from accelerations; regular where no constraint follows from
/// the others to first order.
Matrix constraint_matrix(const SecondOrderSystem& system, const DistanceConstraints& constraints,
                         ConstVectorRef q);

/// Whether the rows of G(q) are linearly independent: matrix_singular with the rank where constraints are
/// redundant or the configuration is singular (eigenvalues of the scaled G M⁻¹ Gᵀ below 1e-12 of the
/// largest).
Status check_independence(const SecondOrderSystem& system, const DistanceConstraints& constraints,
                          ConstVectorRef q);

/// The multipliers λ [N] of the motion M v̇ = f(t, q, v) + Gᵀλ on g = 0:
///   (G M⁻¹ Gᵀ) λ = −G M⁻¹ f − G(v) v.
Vector multipliers(const SecondOrderSystem& system, const DistanceConstraints& constraints, double t,
                   ConstVectorRef q, ConstVectorRef v);

/// Moves q to g(q) = 0 by Newton's iteration along M⁻¹Gᵀ and then v to G(q) v = 0 by one such step, both the
/// nearest in the norm of M to first order; fixed degrees of freedom stay. newton_failed where the
/// iteration does not converge, matrix_singular as above.
Status project_on_constraints(const SecondOrderSystem& system, const DistanceConstraints& constraints,
                              VectorRef q, VectorRef v);

}  // namespace fw::constraints
