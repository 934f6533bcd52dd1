#pragma once

#include <memory>

#include "linalg/linear_solver.hpp"
#include "ode/integrator.hpp"

namespace fw::integrators {

struct LinearisedOptions {
  linalg::LinearSolverOptions linear_solver;
  TangentModel tangent = TangentModel::exact;
};

/// The lecture's implicit step: one linearisation of implicit Euler at the current state,
///   (M − h D − h² K) v' = M v + h f(t + h, x, v) − h D v,  x' = x + h v'
/// [Zachmann 2011, S25-S31; extended by D as in Baraff, Witkin 1998]. Solved for the increment v' − v:
///   A δ = h (f + h K v).
///
/// Conjugate gradients (warm-started with the last increment) and Cholesky use the symmetric part of A, LU
/// uses A itself; the right-hand side always has the exact K·v by Jacobian–vector products. Order 1 in each
/// case, since the scheme is consistent with any matrix. An indefinite A ends the run with matrix_indefinite;
/// see `TangentModel` for the remedies.
std::unique_ptr<Integrator> make_implicit_euler_linearised(const LinearisedOptions& options);

}  // namespace fw::integrators
