#pragma once

#include <functional>

#include "core/status.hpp"
#include "core/types.hpp"

namespace fw::integrators {

/// φ₁(A) b by Arnoldi's process, φ₁(z) = (e^z − 1)/z [Saad 1992].
class KrylovPhi {
 public:
  /// Writes A w.
  using Apply = std::function<void(ConstVectorRef w, VectorRef out)>;

  KrylovPhi(Index size, int largest_dimension);

  /// out = φ₁(A) b with an estimated error of at most `tolerance` in the Euclidean norm; `dimension` receives
  /// the number of products that it took. Fails with linear_solver_failed where the largest dimension does
  /// not suffice, and with non_finite.
  Status multiply(const Apply& apply, ConstVectorRef b, double tolerance, VectorRef out, int& dimension);

 private:
  int largest_dimension_;
  Matrix basis_;       ///< orthonormal columns
  Matrix hessenberg_;  ///< Vᵀ A V
  Vector next_;
};

}  // namespace fw::integrators
