#include "linalg/extreme_eigenvalues.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <numbers>
#include <random>

#include "core/error.hpp"

namespace fw::linalg {
namespace {

using testing::HasSubstr;

constexpr SpectrumEnd ends[] = {SpectrumEnd::largest_magnitude, SpectrumEnd::smallest_magnitude,
                                SpectrumEnd::largest_real, SpectrumEnd::smallest_real};

/// K of N equal masses between fixed walls, joined by springs k.
SparseMatrix chain(int n, double k) {
  SparseMatrix K(n, n);
  for (int i = 0; i < n; ++i) {
    if (i > 0) K.insert(i - 1, i) = -k;
    K.insert(i, i) = 2.0 * k;
    if (i + 1 < n) K.insert(i + 1, i) = -k;
  }
  K.makeCompressed();
  return K;
}

/// Its eigenvalues 4k sin²(jπ/(2(N+1))).
double chain_eigenvalue(int n, double k, int j) {
  const double s = std::sin(j * std::numbers::pi / (2.0 * (n + 1)));
  return 4.0 * k * s * s;
}

TEST(ExtremeEigenvalues, AreThoseOfAChainInClosedForm) {
  for (const SpectrumEnd end : ends) {
    // The small end is dense: found from below without inversion, it takes a Krylov space of the matrix's
    // size.
    const int n = end == SpectrumEnd::smallest_real ? 60 : 300;
    const SparseMatrix K = chain(n, 3.0);
    const bool from_below = end == SpectrumEnd::smallest_magnitude || end == SpectrumEnd::smallest_real;
    const ExtremeEigenvalues found =
        extreme_eigenvalues_symmetric(K, {.end = end, .count = 3, .tolerance = 1e-11});
    ASSERT_TRUE(found.status.ok()) << found.status.describe();
    ASSERT_EQ(found.values.size(), 3u);
    for (int j = 0; j < 3; ++j) {
      const double expected = chain_eigenvalue(n, 3.0, from_below ? j + 1 : n - j);
      const auto k = static_cast<std::size_t>(j);
      EXPECT_NEAR(found.values[k].real(), expected, 1e-9 * (from_below ? expected : 1.0));
      EXPECT_EQ(found.values[k].imag(), 0.0);
      EXPECT_LT(found.residuals[k], 1e-9);
    }
  }
}

TEST(ExtremeEigenvalues, WithMassesAreSquaredFrequencies) {
  const int n = 60;
  const SparseMatrix K = chain(n, 3.0);
  Vector mass(n);
  for (int i = 0; i < n; ++i) mass[i] = 0.5 + 0.25 * (i % 3);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix> dense(Matrix(K), Matrix(mass.asDiagonal()));
  for (const SpectrumEnd end : ends) {
    const bool from_below = end == SpectrumEnd::smallest_magnitude || end == SpectrumEnd::smallest_real;
    const ExtremeEigenvalues found = extreme_eigenvalues_symmetric(K, mass, {.end = end, .count = 2});
    ASSERT_TRUE(found.status.ok()) << found.status.describe();
    for (int j = 0; j < 2; ++j) {
      const double expected = dense.eigenvalues()[from_below ? j : n - 1 - j];
      EXPECT_NEAR(found.values[static_cast<std::size_t>(j)].real(), expected, 1e-9 * expected);
    }
  }
  const ExtremeEigenvalues equal =
      extreme_eigenvalues_symmetric(K, Vector::Constant(n, 2.0), {.end = SpectrumEnd::largest_real});
  ASSERT_TRUE(equal.status.ok());
  EXPECT_NEAR(equal.values[0].real(), chain_eigenvalue(n, 3.0, n) / 2.0, 1e-9);
}

TEST(ExtremeEigenvalues, OfAnUnsymmetricMatrixAreThoseOfADenseSolver) {
  const Index n = 50;
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  Matrix dense = Matrix::Zero(n, n);
  for (Index j = 0; j < n; ++j) {
    for (Index i = 0; i < n; ++i) {
      if ((5 * i + 3 * j) % 4 == 0) dense(i, j) = normal(random);
    }
    dense(j, j) -= 4.0;
  }
  SparseMatrix A = dense.sparseView();
  A.makeCompressed();
  const Eigen::VectorXcd all = Eigen::EigenSolver<Matrix>(dense).eigenvalues();
  const auto key = [](SpectrumEnd end, Complex z) {
    switch (end) {
      case SpectrumEnd::largest_magnitude:
        return -std::abs(z);
      case SpectrumEnd::smallest_magnitude:
        return std::abs(z);
      case SpectrumEnd::largest_real:
        return -z.real();
      default:
        return z.real();
    }
  };
  for (const SpectrumEnd end : ends) {
    std::vector<Complex> expected(all.begin(), all.end());
    std::sort(expected.begin(), expected.end(),
              [&](Complex a, Complex b) { return key(end, a) < key(end, b); });
    const ExtremeEigenvalues found = extreme_eigenvalues(A, {.end = end, .count = 4});
    ASSERT_TRUE(found.status.ok()) << found.status.describe();
    for (std::size_t j = 0; j < 4; ++j) {
      EXPECT_NEAR(key(end, found.values[j]), key(end, expected[j]), 1e-8);
      // Members of a pair come in any order.
      EXPECT_NEAR(std::abs(found.values[j].imag()), std::abs(expected[j].imag()), 1e-7);
      EXPECT_LT(found.residuals[j], 1e-9);
    }
  }
}

TEST(ExtremeEigenvalues, EndWithAStatusWhereTheyCannotBeFound) {
  const ExtremeEigenvalues few = extreme_eigenvalues_symmetric(
      chain(400, 1.0),
      {.end = SpectrumEnd::smallest_real, .count = 4, .tolerance = 1e-12, .max_iterations = 1});
  EXPECT_EQ(few.status.code, StatusCode::linear_solver_failed);
  EXPECT_THAT(few.status.message, HasSubstr("EPS_DIVERGED_ITS"));
  EXPECT_LT(few.values.size(), 4u);
  SparseMatrix singular = chain(20, 1.0);
  for (SparseMatrix::InnerIterator entry(singular, 7); entry; ++entry) entry.valueRef() = 0.0;
  for (int column = 0; column < 20; ++column) {
    for (SparseMatrix::InnerIterator entry(singular, column); entry; ++entry) {
      if (entry.row() == 7) entry.valueRef() = 0.0;
    }
  }
  const ExtremeEigenvalues none =
      extreme_eigenvalues_symmetric(singular, {.end = SpectrumEnd::smallest_magnitude});
  EXPECT_EQ(none.status.code, StatusCode::matrix_singular) << none.status.describe();
  SparseMatrix infinite = chain(20, 1.0);
  infinite.valuePtr()[3] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(extreme_eigenvalues(infinite).status.code, StatusCode::non_finite);
}

TEST(ExtremeEigenvalues, AreFoundFromProductsAlone) {
  const int n = 300;
  const SparseMatrix K = chain(n, 3.0);
  int products = 0;
  const MatrixProduct product = [&](ConstVectorRef x, VectorRef out) {
    ++products;
    out = K * x;
  };
  const EigenvalueOptions options{
      .end = SpectrumEnd::largest_real, .count = 2, .tolerance = 1e-10, .vectors = true};
  const ExtremeEigenvalues found = extreme_eigenvalues_symmetric(n, product, options);
  ASSERT_TRUE(found.status.ok()) << found.status.describe();
  ASSERT_EQ(found.vectors.size(), 2u);
  EXPECT_GT(products, 2);
  for (int j = 0; j < 2; ++j) {
    const auto k = static_cast<std::size_t>(j);
    EXPECT_NEAR(found.values[k].real(), chain_eigenvalue(n, 3.0, n - j), 1e-9);
    EXPECT_NEAR(found.vectors[k].norm(), 1.0, 1e-14);
    EXPECT_LT((K * found.vectors[k] - found.values[k].real() * found.vectors[k]).norm(), 1e-8);
  }
  const MatrixProduct fails = [](ConstVectorRef, VectorRef) { throw SystemError("no product"); };
  EXPECT_THROW(extreme_eigenvalues_symmetric(n, fails, options), SystemError);
  EXPECT_THROW(extreme_eigenvalues_symmetric(n, product, {.end = SpectrumEnd::smallest_magnitude}),
               InputError);
}

TEST(ExtremeEigenvalues, RefuseBadInput) {
  const SparseMatrix K = chain(20, 1.0);
  EXPECT_THROW(extreme_eigenvalues(SparseMatrix(3, 4)), InputError);
  EXPECT_THROW(extreme_eigenvalues(K, {.count = 21}), InputError);
  EXPECT_THROW(extreme_eigenvalues(K, {.tolerance = 0.0}), InputError);
  EXPECT_THROW(extreme_eigenvalues(K, {.petsc = "-eps_nvc 30"}), InputError);
  EXPECT_THROW(extreme_eigenvalues_symmetric(K, Vector::Zero(20)), InputError);
  EXPECT_TRUE(extreme_eigenvalues(K, {.petsc = "-eps_ncv 15"}).status.ok());
}

}  // namespace
}  // namespace fw::linalg
