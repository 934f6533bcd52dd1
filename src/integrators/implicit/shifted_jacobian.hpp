#pragma once

#include <memory>

#include "core/work.hpp"
#include "linalg/linear_solver.hpp"
#include "ode/ode_system.hpp"

namespace fw::integrators {

/// The matrix I − ηJ at a state, factorised by a direct solver. On a second-order system it is reduced to
/// half its size:
///   x_q − η x_v = r_q,   (M − ηD − η²K) x_v = M r_v + η K r_q.
class ShiftedJacobian {
 public:
  virtual ~ShiftedJacobian() = default;

  /// Evaluates J at (t, y) and factorises.
  virtual Status factorise(double t, ConstVectorRef y, double eta) = 0;

  /// r ← (I − ηJ)⁻¹ r. Fixed degrees of freedom become exactly zero.
  virtual Status solve(VectorRef r) = 0;

  /// Forgets the factors: the next `factorise` works as the first one did.
  virtual void forget_matrix() = 0;
  /// Visits what the next `factorise` depends on.
  virtual void serialise(StateArchive& archive) = 0;
};

std::unique_ptr<ShiftedJacobian> make_shifted_jacobian(const OdeSystem& system, Work& work);

}  // namespace fw::integrators
