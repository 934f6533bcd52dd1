#pragma once

#include <memory>

#include "ode/ode_system.hpp"

namespace fw::oracles::detail {

/// A part of a right-hand side ẏ = f_E + f_I as a foreign solver evaluates it, with work space of its own for
/// one run. The system outlives it.
class RightHandPart {
 public:
  virtual ~RightHandPart() = default;

  /// dydt = the part's value.
  virtual void evaluate(double t, ConstVectorRef y, VectorRef dydt) = 0;

  /// A matrix with the pattern of the part's Jacobian and a full diagonal at the start; `jacobian` takes
  /// another one when the system's `pattern_revision` has changed.
  virtual const SparseMatrix& pattern() const = 0;

  /// The part's exact Jacobian.
  virtual const SparseMatrix& jacobian(double t, ConstVectorRef y) = 0;
};

/// f(t, y).
std::unique_ptr<RightHandPart> make_whole_right_hand_side(const OdeSystem& system);

/// (v, M⁻¹ f_stiff) of a second-order system with a force splitting.
std::unique_ptr<RightHandPart> make_stiff_right_hand_part(const SecondOrderSystem& system);

/// (0, M⁻¹ f_soft), which is treated explicitly only: its `jacobian` throws std::logic_error.
std::unique_ptr<RightHandPart> make_soft_right_hand_part(const SecondOrderSystem& system);

}  // namespace fw::oracles::detail
