#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "ode/ivp.hpp"

namespace fw::integrators {

/// One step in binary128: y at t becomes y at t + h.
using ExtendedStep = std::function<void(const Float128& t, const Float128& h, std::vector<Float128>& y)>;

/// The end state of `ivp` after `steps` equal steps.
std::vector<Float128> run_extended_steps(const Ivp& ivp, std::uint64_t steps, const ExtendedStep& step);

/// ∂f/∂y at (t, y), row by row, by central differences in binary128 (error about 1e-22 relative).
std::vector<Float128> extended_jacobian(const OdeSystem& system, const Float128& t,
                                        const std::vector<Float128>& y);

/// A row by row, factorised by elimination with partial pivoting. For the small systems on which orders are
/// measured.
class ExtendedLu {
 public:
  ExtendedLu(std::vector<Float128> A, std::size_t size);

  /// A x = b in place: b becomes x.
  void solve(std::vector<Float128>& b) const;

 private:
  std::size_t size_;
  std::vector<Float128> factors_;    ///< the upper triangle, and below it the factors of the elimination
  std::vector<std::size_t> pivots_;  ///< the row that column k was exchanged with
};

}  // namespace fw::integrators
