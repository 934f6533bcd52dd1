#include "sparse/block_matrix3.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>
#include <stdexcept>

#include "allocation_counter.hpp"

namespace fw::sparse {
namespace {

/// A sparse symmetric 3n×3n matrix of full blocks, a third of them there.
SparseMatrix of_blocks(int n, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  Matrix dense = Matrix::Zero(3 * n, 3 * n);
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i <= j; ++i) {
      if (i != j && uniform(random) > 0.3) continue;
      for (int a = 0; a < 3; ++a) {
        for (int b = 0; b < 3; ++b) dense(3 * i + a, 3 * j + b) = normal(random);
      }
    }
  }
  const Matrix symmetric = dense + dense.transpose();
  SparseMatrix A = symmetric.sparseView();
  A.makeCompressed();
  return A;
}

Vector numbers(Index n, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Vector v(n);
  for (Index i = 0; i < n; ++i) v[i] = normal(random);
  return v;
}

TEST(BlockMatrix3, MultipliesAsTheDenseMatrixAndAsEigenToTheLastBit) {
  for (const int n : {1, 2, 13}) {
    const SparseMatrix A = of_blocks(n, 5);
    BlockMatrix3 blocks(A);
    blocks.take_values(A);
    const Vector x = numbers(3 * n, 6);
    Vector y(3 * n), eigen(3 * n);
    blocks.transposed_product(x, y);
    eigen.noalias() = A.transpose() * x;
    EXPECT_EQ(y, eigen);
    EXPECT_LT((y - Matrix(A) * x).norm(), 1e-13 * y.norm());
    for (Index i = 0; i < n; ++i) {
      EXPECT_EQ(Matrix(blocks.diagonal(i)), Matrix(Matrix(A).block(3 * i, 3 * i, 3, 3)));
    }
  }
}

TEST(BlockMatrix3, TransposesWhereTheMatrixIsNotSymmetric) {
  Matrix dense = Matrix::Zero(6, 6);
  dense(0, 4) = 2.0;
  dense(5, 1) = -3.0;
  dense.diagonal().setConstant(1.0);
  SparseMatrix A = dense.sparseView();
  A.makeCompressed();
  BlockMatrix3 blocks(A);
  EXPECT_EQ(blocks.block_count(), 4);
  blocks.take_values(A);
  const Vector x = numbers(6, 1);
  Vector y(6);
  blocks.transposed_product(x, y);
  EXPECT_LT((y - dense.transpose() * x).norm(), 1e-15);
  EXPECT_GT((y - dense * x).norm(), 1e-3);
}

TEST(BlockMatrix3, FillsBlocksOfWhichSomeEntriesAreMissingWithZeros) {
  Matrix dense = Matrix::Zero(6, 6);
  dense(1, 5) = dense(5, 1) = 2.0;  // no diagonal at all
  SparseMatrix A = dense.sparseView();
  A.makeCompressed();
  BlockMatrix3 blocks(A);
  EXPECT_EQ(blocks.block_rows(), 2);
  EXPECT_EQ(blocks.block_count(), 4);  // the diagonal ones are there
  blocks.take_values(A);
  EXPECT_EQ(Matrix(blocks.diagonal(1)), Matrix(Matrix::Zero(3, 3)));
  const Vector x = numbers(6, 2);
  Vector y(6);
  blocks.transposed_product(x, y);
  EXPECT_EQ(y, Vector(dense * x));
}

TEST(BlockMatrix3, TakesNewValuesAndMultipliesWithoutAllocation) {
  SparseMatrix A = of_blocks(10, 8);
  BlockMatrix3 blocks(A);
  const Vector x = numbers(30, 9);
  Vector y(30);
  const std::size_t allocations = allocations_of([&] {
    for (int k = 0; k < 5; ++k) {
      A.coeffs() *= 1.5;
      blocks.take_values(A);
      blocks.transposed_product(x, y);
    }
  });
  EXPECT_EQ(allocations, 0u);
  EXPECT_LT((y - Matrix(A) * x).norm(), 1e-13 * y.norm());
}

TEST(BlockMatrix3, RefusesSizesThatHaveNoBlocks) {
  EXPECT_THROW(BlockMatrix3(SparseMatrix(4, 4)), std::logic_error);
  EXPECT_THROW(BlockMatrix3(SparseMatrix(3, 6)), std::logic_error);
}

}  // namespace
}  // namespace fw::sparse
