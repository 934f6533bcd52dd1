#include "integrators/butcher_tableau.hpp"

#include <cmath>
#include <stdexcept>
#include <vector>

namespace fw::integrators {

namespace {

constexpr double rounding = 1e-14;

}  // namespace

bool ButcherTableau::is_explicit() const {
  for (Index i = 0; i < A.rows(); ++i) {
    for (Index j = i; j < A.cols(); ++j) {
      if (A(i, j) != 0.0) return false;
    }
  }
  return true;
}

void check_tableau(const ButcherTableau& tableau) {
  const Index s = tableau.b.size();
  const auto fail = [&](const char* what) {
    throw std::logic_error("tableau \"" + tableau.name + "\": " + what);
  };
  if (s == 0 || tableau.A.rows() != s || tableau.A.cols() != s || tableau.c.size() != s) {
    fail("A must be s x s, b and c of length s");
  }
  if (std::abs(tableau.b.sum() - 1.0) > rounding) fail("the weights b must sum to 1");
  if ((tableau.A.rowwise().sum() - tableau.c).cwiseAbs().maxCoeff() > rounding) {
    fail("each c_i must be the sum of row i of A");
  }
}

int order_of_accuracy(const ButcherTableau& tableau) {
  const Vector& b = tableau.b;
  const Vector& c = tableau.c;
  const Matrix& A = tableau.A;
  const Vector c2 = c.cwiseProduct(c);
  // One condition Σ b_i φ_i(τ) = 1/γ(τ) per rooted tree τ, grouped by order.
  struct Condition {
    int order;
    double value;
    double expected;
  };
  const std::vector<Condition> conditions = {
      {1, b.sum(), 1.0},
      {2, b.dot(c), 1.0 / 2.0},
      {3, b.dot(c2), 1.0 / 3.0},
      {3, b.dot(A * c), 1.0 / 6.0},
      {4, b.dot(c.cwiseProduct(c2)), 1.0 / 4.0},
      {4, b.dot(c.cwiseProduct(A * c)), 1.0 / 8.0},
      {4, b.dot(A * c2), 1.0 / 12.0},
      {4, b.dot(A * (A * c)), 1.0 / 24.0},
  };
  int order = 4;
  for (const Condition& condition : conditions) {
    if (std::abs(condition.value - condition.expected) > rounding)
      order = std::min(order, condition.order - 1);
  }
  return order;
}

}  // namespace fw::integrators
