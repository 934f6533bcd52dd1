#pragma once

#include "core/types.hpp"

namespace fw::linalg {

/// An orthonormal basis of the rigid body motions of the particles at `coordinates` (x₀, y₀, z₀, x₁, …), one
/// per column: three translations and up to three rotations (two where all lie on a line). Rows of degrees of
/// freedom that `A` does not couple to any other (fixed ones) are zero.
Matrix rigid_body_modes(const Vector& coordinates, const SparseMatrix& A);

}  // namespace fw::linalg
