#include "ode/first_order_jacobian.hpp"

#include <algorithm>

namespace fw {

FirstOrderJacobian::FirstOrderJacobian(const SparseMatrix& tangent)
    : slots_(static_cast<int>(tangent.cols()), static_cast<int>(tangent.nonZeros())),
      outer_(tangent.outerIndexPtr(), tangent.outerIndexPtr() + tangent.cols() + 1),
      inner_(tangent.innerIndexPtr(), tangent.innerIndexPtr() + tangent.nonZeros()) {}

SparseMatrix FirstOrderJacobian::pattern() const {
  const int n = static_cast<int>(outer_.size()) - 1;
  SparseMatrix matrix(2 * n, 2 * n);
  matrix.resizeNonZeros(slots_.entries());
  int* outer = matrix.outerIndexPtr();
  int* inner = matrix.innerIndexPtr();
  int count = 0;
  *outer++ = 0;
  for (int column = 0; column < 2 * n; ++column) {
    const auto c = static_cast<std::size_t>(column % n);
    inner[count++] = column % n;
    for (int k = outer_[c]; k < outer_[c + 1]; ++k) inner[count++] = n + inner_[static_cast<std::size_t>(k)];
    *outer++ = count;
  }
  matrix.coeffs().setZero();
  return matrix;
}

void FirstOrderJacobian::fill(const SparseMatrix& K, const SparseMatrix& D, ConstVectorRef mass,
                              SparseMatrix& J) const {
  const int n = static_cast<int>(outer_.size()) - 1;
  double* values = J.valuePtr();
  for (int c = 0; c < n; ++c) {
    values[diagonal(c)] = 0.0;
    values[unit(c)] = 1.0;
    for (int k = outer_[static_cast<std::size_t>(c)]; k < outer_[static_cast<std::size_t>(c) + 1]; ++k) {
      const double m = mass[inner_[static_cast<std::size_t>(k)]];
      values[stiffness(k, c)] = K.valuePtr()[k] / m;
      values[damping(k, c)] = D.valuePtr()[k] / m;
    }
  }
}

void first_order_product(const SecondOrderSystem& system, double t, ConstVectorRef y, ConstVectorRef w,
                         VectorRef out) {
  const Index n = system.degrees_of_freedom();
  system.tangent_product(t, y.head(n), y.tail(n), w.head(n), w.tail(n), out.tail(n));
  out.tail(n).array() /= system.mass().array();
  out.head(n) = w.tail(n);
  const std::vector<char>& fixed = system.fixed();
  for (Index i = 0; i < n; ++i) {
    if (fixed[static_cast<std::size_t>(i)] != 0) out[i] = 0.0;
  }
}

}  // namespace fw
