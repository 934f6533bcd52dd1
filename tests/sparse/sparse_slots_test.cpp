#include "sparse/sparse_slots.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <stdexcept>
#include <string>

namespace fw::sparse {
namespace {

/// 3×3 with the entries (0,0), (2,0), (1,1), (0,2), (2,2).
SparseMatrix cross() {
  Matrix dense = Matrix::Zero(3, 3);
  dense << 1.0, 0.0, 4.0, 0.0, 3.0, 0.0, 2.0, 0.0, 5.0;
  SparseMatrix A = dense.sparseView();
  A.makeCompressed();
  return A;
}

TEST(SparseSlots, AreWhereTheValuesAre) {
  const SparseMatrix A = cross();
  const Matrix dense(A);
  for (Index column = 0; column < 3; ++column) {
    for (Index row = 0; row < 3; ++row) {
      if (dense(row, column) == 0.0) {
        EXPECT_EQ(find_slot(A, row, column), -1);
      } else {
        EXPECT_EQ(A.valuePtr()[slot_of(A, row, column)], dense(row, column));
      }
    }
  }
  EXPECT_EQ(diagonal_slots(A), (std::vector<int>{0, 2, 4}));
  EXPECT_EQ(transpose_slots(A), (std::vector<int>{0, 3, 2, 1, 4}));
}

TEST(SparseSlots, NameTheEntryThatThePatternLacks) {
  SparseMatrix A = cross();
  try {
    slot_of(A, 1, 2);
    FAIL() << "an entry that is not there was found";
  } catch (const std::logic_error& error) {
    EXPECT_NE(std::string(error.what()).find("(1, 2)"), std::string::npos) << error.what();
  }
  A.coeffRef(1, 2) = 1.0;  // no (2, 1): not symmetric any more
  A.makeCompressed();
  EXPECT_THROW(transpose_slots(A), std::logic_error);
  A.prune([](int row, int column, double) { return row != 1 || column != 1; });
  EXPECT_THROW(diagonal_slots(A), std::logic_error);
  EXPECT_THROW(add_to_diagonal(A, 1.0), std::logic_error);
}

TEST(SparseSlots, AddToTheDiagonalAlone) {
  SparseMatrix A = cross();
  const Matrix expected = Matrix(A) + 0.5 * Matrix::Identity(3, 3);
  add_to_diagonal(A, 0.5);
  EXPECT_EQ(Matrix(A), expected);
}

TEST(SparsePatterns, AreComparedByEntriesNotByTheirNumber) {
  const SparseMatrix A = cross();
  SparseMatrix same = A;
  same.coeffs() *= 2.0;
  EXPECT_TRUE(same_pattern(A, same));
  const SparseMatrix moved = [] {
    Matrix dense = Matrix::Zero(3, 3);
    dense << 1.0, 0.0, 0.0, 2.0, 3.0, 4.0, 0.0, 0.0, 5.0;  // five entries as well
    SparseMatrix other = dense.sparseView();
    other.makeCompressed();
    return other;
  }();
  EXPECT_EQ(moved.nonZeros(), A.nonZeros());
  EXPECT_FALSE(same_pattern(A, moved));
  EXPECT_FALSE(same_pattern(A, SparseMatrix(4, 4)));
}

}  // namespace
}  // namespace fw::sparse
