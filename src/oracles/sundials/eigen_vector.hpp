#pragma once

#include "oracles/sundials/sundials_objects.hpp"
#include "oracles/sundials/vector_operations.hpp"

namespace fw::oracles::detail {

/// An N_Vector of `size` entries over Eigen maps, in memory of its own, aligned to 64 bytes, not initialised.
///
/// All standard, fused, vector-array, local-reduction and buffer operations of SUNDIALS 6.4 are there; the
/// fused ones are on. Its content is laid out as that of the serial vector and it answers to that name: KLU
/// and the sparse matrix accept only vectors they know to be plain arrays in memory, which ours is. Vectors
/// that SUNDIALS clones are of the same kind.
///
/// Elementwise operations allow z to be any of their inputs. Sums are taken in an order that depends on the
/// size only, so that results do not depend on where in memory a vector lies. Maximum and minimum are NaN
/// where an entry is (the serial vector passes over NaN).
VectorPointer new_eigen_vector(Index size, SUNContext context);

/// The same over `entries`, which are not copied and have to outlive the vector.
VectorPointer wrap_eigen_vector(VectorRef entries, SUNContext context);

/// A new vector of either kind.
VectorPointer new_vector(Index size, VectorOperations operations, SUNContext context);
/// The state of a system over `entries`, without a copy, as a vector of either kind. N_VWrmsNorm of one of ours
/// and of all cloned from it is `integrators::largest_particle_norm` where it is [q; v] of particles.
VectorPointer wrap_state(VectorRef entries, bool is_of_particles, VectorOperations operations,
                         SUNContext context);
/// The same of a vector of either kind that is no state.
VectorPointer wrap_vector(VectorRef entries, VectorOperations operations, SUNContext context);

}  // namespace fw::oracles::detail
