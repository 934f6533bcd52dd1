#include "ode/first_order_jacobian.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "allocation_counter.hpp"
#include "changing_network.hpp"
#include "ode/functor_system.hpp"

namespace fw {
namespace {

SparseMatrix tangent(const Matrix& dense) {
  SparseMatrix A = dense.sparseView();
  A.makeCompressed();
  return A;
}

/// K and D of three degrees of freedom with one pattern.
struct Tangents {
  SparseMatrix K, D;
  Vector mass = Eigen::Vector3d(2.0, 0.5, 4.0);
  Tangents() {
    Matrix k = Matrix::Zero(3, 3), d = k;
    k << -3.0, 1.0, 0.0, 1.0, -5.0, 2.0, 0.0, 2.0, -7.0;
    d << -0.3, 0.1, 0.0, 0.1, -0.5, 0.2, 0.0, 0.2, -0.7;
    K = tangent(k);
    D = tangent(d);
  }
};

TEST(FirstOrderJacobian, HasTheUnitAndTheTangentsDividedByTheMass) {
  const Tangents t;
  const FirstOrderJacobian blocks(t.K);
  SparseMatrix J = blocks.pattern();
  EXPECT_TRUE(J.isCompressed());
  blocks.fill(t.K, t.D, t.mass, J);
  Matrix expected = Matrix::Zero(6, 6);
  expected.topRightCorner(3, 3).setIdentity();
  expected.bottomLeftCorner(3, 3) = t.mass.cwiseInverse().asDiagonal() * Matrix(t.K);
  expected.bottomRightCorner(3, 3) = t.mass.cwiseInverse().asDiagonal() * Matrix(t.D);
  EXPECT_LT((Matrix(J) - expected).cwiseAbs().maxCoeff(), 1e-16);
}

TEST(FirstOrderJacobian, KnowsTheSlotOfEveryEntry) {
  const Tangents t;
  const FirstOrderJacobian blocks(t.K);
  const SparseMatrix J = blocks.pattern();
  for (int c = 0; c < 3; ++c) {
    EXPECT_EQ(blocks.diagonal(c), sparse::slot_of(J, c, c));
    EXPECT_EQ(blocks.unit(c), sparse::slot_of(J, c, 3 + c));
    for (int k = t.K.outerIndexPtr()[c]; k < t.K.outerIndexPtr()[c + 1]; ++k) {
      const int row = t.K.innerIndexPtr()[k];
      EXPECT_EQ(blocks.stiffness(k, c), sparse::slot_of(J, 3 + row, c));
      EXPECT_EQ(blocks.damping(k, c), sparse::slot_of(J, 3 + row, 3 + c));
    }
  }
  EXPECT_EQ(J.nonZeros(), 2 * (t.K.nonZeros() + 3));
}

TEST(FirstOrderJacobian, IsFilledWithoutAllocation) {
  const Tangents t;
  const FirstOrderJacobian blocks(t.K);
  SparseMatrix J = blocks.pattern();
  EXPECT_EQ(allocations_of([&] { blocks.fill(t.K, t.D, t.mass, J); }), 0u);
}

TEST(FirstOrderJacobian, MultipliesAsTheAssembledOne) {
  ChangingNetwork network(6, PatternKind::sparse);
  network.set_contacts({{0, 4}});
  Vector y(12), w(12), product(12);
  for (Index i = 0; i < 12; ++i) {
    y[i] = 0.1 * static_cast<double>(i % 5);
    w[i] = 0.3 - 0.05 * static_cast<double>(i);
  }
  SparseMatrix J = network.jacobian_pattern();
  network.jacobian(0.0, y, J);
  first_order_product(network, 0.0, y, w, product);
  EXPECT_LT((product - J * w).norm(), 1e-13 * product.norm());
}

/// Two unequal masses, a cubic spring and a damper.
struct Pair {
  template <class S>
  void operator()(const S&, std::span<const S> q, std::span<const S> v, std::span<S> f) const {
    const S d = q[1] - q[0];
    const S pull = S(3) * d + d * d * d + S(0.2) * (v[1] - v[0]);
    f[0] = pull;
    f[1] = -pull;
  }
};

TEST(FirstOrderJacobian, OfAFunctorIsThatOfItsRightHandSide) {
  const FunctorSecondOrderSystem<Pair> system(Eigen::Vector2d(1.0, 3.0), ForceClass::velocity, Pair{});
  Vector y(4);
  y << 0.2, -0.3, 0.5, 0.1;
  SparseMatrix J = system.jacobian_pattern();
  system.jacobian(0.0, y, J);
  Matrix differences(4, 4);
  for (Index j = 0; j < 4; ++j) {
    constexpr double h = 1e-6;
    Vector high = y, low = y, f_high(4), f_low(4);
    high[j] += h;
    low[j] -= h;
    system.rhs(0.0, high, f_high);
    system.rhs(0.0, low, f_low);
    differences.col(j) = (f_high - f_low) / (2.0 * h);
  }
  EXPECT_LT((Matrix(J) - differences).cwiseAbs().maxCoeff(), 1e-8);
}

}  // namespace
}  // namespace fw
