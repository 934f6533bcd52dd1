#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "eigen_vector_twins.hpp"

// Operations on several vectors at once, and what the twins see of wrong ones.

namespace fw::oracles::detail {
namespace {

TEST(EigenVector, FusesWhatItWouldDoOneByOne) {
  std::vector<double> c = {1.0, -0.5, 2.0,  0.25, -1.0, 3.0,  1.5,  -0.75, 0.125, 1.0,  -2.0, 0.3,
                           0.7, -0.2, 1.1,  0.9,  -1.3, 0.4,  0.6,  -0.8,  1.7,   2.2,  -0.1, 0.05,
                           1.9, -2.6, 0.55, 0.45, 1.2,  -1.4, 0.35, 0.65,  -0.95, 1.05, 0.15};
  for (const std::size_t count : {1, 2, 3, 4, 5, 6, 7, 8, 9, 12, 13, 17, 35}) {
    const int n = static_cast<int>(count);
    const std::string of = " of " + std::to_string(count);
    // The sum of many terms has other intermediate roundings than a chain of linear sums.
    const double tolerance = 8.0 * static_cast<double>(count) * unit_roundoff;
    compare_entries(
        "linear combination" + of, count + 1,
        [&](std::vector<N_Vector> v) { EXPECT_EQ(N_VLinearCombination(n, c.data(), v.data(), v.back()), 0); },
        tolerance);
    compare_entries(
        "linear combination into its first" + of, count,
        [&](std::vector<N_Vector> v) {
          EXPECT_EQ(N_VLinearCombination(n, c.data(), v.data(), v.front()), 0);
        },
        tolerance);
    compare_entries("scale, add, multi" + of, 2 * count + 1, [&](std::vector<N_Vector> v) {
      EXPECT_EQ(N_VScaleAddMulti(n, c.data(), v.back(), v.data(), v.data() + n), 0);
    });
    compare_entries("scale, add, multi in place" + of, count + 1, [&](std::vector<N_Vector> v) {
      EXPECT_EQ(N_VScaleAddMulti(n, c.data(), v.back(), v.data(), v.data()), 0);
    });
    for (int k = 0; k < n; k += 3) {
      const auto dot = [&](std::vector<N_Vector> v) {
        std::vector<double> d(count, -1.0);
        EXPECT_EQ(N_VDotProdMulti(n, v.back(), v.data(), d.data()), 0);
        return d[static_cast<std::size_t>(k)];
      };
      compare_numbers("dot products" + of, count + 1, dot);
    }
  }
}

TEST(EigenVector, CombinesIntoAnyOfItsInputs) {
  // SUNDIALS asks for the first input only; ours keeps its promise for all of them.
  std::vector<double> c = {0.5, 1.5, -2.0, 0.25, 1.0, -0.125, 3.0};
  for (std::size_t k = 0; k < c.size(); ++k) {
    Twins twins(4, 1300, c.size());
    Vector expected = Vector::Zero(1300);
    for (std::size_t j = 0; j < c.size(); ++j) expected += c[j] * twins.values(j);
    std::vector<N_Vector> v = twins.ours();
    N_VLinearCombination(static_cast<int>(c.size()), c.data(), v.data(), v[k]);
    EXPECT_LT((twins.values(k) - expected).lpNorm<Eigen::Infinity>(), 1e-14) << k;
  }
}

TEST(EigenVector, WorksOnArraysOfVectors) {
  std::vector<double> c = {1.0, -0.5, 2.0, 0.25};
  for (int n = 1; n <= 4; ++n) {
    const auto count = static_cast<std::size_t>(n);
    for (const double b : {1.0, -1.0, 0.4}) {
      compare_entries("linear sums", 3 * count, [&](std::vector<N_Vector> v) {
        N_VLinearSumVectorArray(n, 0.3, v.data(), b, v.data() + n, v.data() + 2 * n);
      });
      compare_entries("linear sums in place", 2 * count, [&](std::vector<N_Vector> v) {
        N_VLinearSumVectorArray(n, 0.3, v.data(), b, v.data() + n, v.data());
      });
    }
    compare_entries("scales", 2 * count, [&](std::vector<N_Vector> v) {
      N_VScaleVectorArray(n, c.data(), v.data(), v.data() + n);
    });
    compare_entries("scales in place", count,
                    [&](std::vector<N_Vector> v) { N_VScaleVectorArray(n, c.data(), v.data(), v.data()); });
    compare_entries("constants", count,
                    [&](std::vector<N_Vector> v) { N_VConstVectorArray(n, -3.0, v.data()); });
    for (int k = 0; k < n; ++k) {
      const auto at = static_cast<std::size_t>(k);
      compare_numbers("wrms norms", 2 * count, [&](std::vector<N_Vector> v) {
        std::vector<double> norm(count);
        N_VWrmsNormVectorArray(n, v.data(), v.data() + n, norm.data());
        return norm[at];
      });
      compare_numbers("masked wrms norms", 2 * count + 1, [&](std::vector<N_Vector> v) {
        std::vector<double> norm(count);
        N_VWrmsNormMaskVectorArray(n, v.data(), v.data() + n, v.back(), norm.data());
        return norm[at];
      });
    }
  }
}

TEST(EigenVector, WorksOnArraysOfArrays) {
  const int vectors = 3;
  std::vector<double> c;
  for (int j = 0; j < 35; ++j) c.push_back(0.1 * j - 1.0 + 0.01 * j * j);
  for (const int sums : {1, 2, 3, 5, 16, 17, 35}) {
    const auto count = static_cast<std::size_t>(vectors * sums);
    const std::string of = " of " + std::to_string(sums);
    // Row j of an array of arrays begins at vector j·vectors.
    const auto rows = [&](std::vector<N_Vector>& v, std::size_t begin) {
      std::vector<N_Vector*> list;
      for (int j = 0; j < sums; ++j) list.push_back(v.data() + begin + static_cast<std::size_t>(j * vectors));
      return list;
    };
    const double tolerance = 20.0 * sums * unit_roundoff;
    compare_entries(
        "combinations" + of, count + vectors,
        [&](std::vector<N_Vector> v) {
          std::vector<N_Vector*> X = rows(v, 0);
          N_VLinearCombinationVectorArray(vectors, sums, c.data(), X.data(), v.data() + count);
        },
        tolerance);
    compare_entries(
        "combinations into the first" + of, count,
        [&](std::vector<N_Vector> v) {
          std::vector<N_Vector*> X = rows(v, 0);
          N_VLinearCombinationVectorArray(vectors, sums, c.data(), X.data(), v.data());
        },
        tolerance);
    compare_entries("scale, add, multi" + of, 2 * count + vectors, [&](std::vector<N_Vector> v) {
      std::vector<N_Vector*> Y = rows(v, 0), Z = rows(v, count);
      N_VScaleAddMultiVectorArray(vectors, sums, c.data(), v.data() + 2 * count, Y.data(), Z.data());
    });
    compare_entries("scale, add, multi in place" + of, count + vectors, [&](std::vector<N_Vector> v) {
      std::vector<N_Vector*> Y = rows(v, 0);
      N_VScaleAddMultiVectorArray(vectors, sums, c.data(), v.data() + count, Y.data(), Y.data());
    });
  }
}

// Negative controls: an operation that is wrong as such operations are wrong in practice is seen.

void forgets_the_tail(double a, N_Vector x, double b, N_Vector y, N_Vector z) {
  const Index whole = N_VGetLength(x) / 4 * 4;
  mutable_view(z, whole) = a * view(x, whole) + b * view(y, whole);
}

int writes_before_it_reads(int count, double* c, N_Vector* X, N_Vector z) {
  const Index n = N_VGetLength(z);
  mutable_view(z, n).setZero();
  for (int j = 0; j < count; ++j) mutable_view(z, n) += c[j] * view(X[j], n);
  return 0;
}

TEST(EigenVector, SeesWrongOperations) {
  Twins tail(1, 7, 3);
  for (const N_Vector vector : tail.ours()) vector->ops->nvlinearsum = forgets_the_tail;
  for (const auto& v : {tail.ours(), tail.serial()}) N_VLinearSum(0.5, v[0], 2.0, v[1], v[2]);
  EXPECT_GT(tail.difference(), 1e-3);

  Twins aliased(1, 7, 2);
  for (const N_Vector vector : aliased.ours()) vector->ops->nvlinearcombination = writes_before_it_reads;
  std::vector<double> c = {0.5, 2.0};
  for (auto v : {aliased.ours(), aliased.serial()}) N_VLinearCombination(2, c.data(), v.data(), v[0]);
  EXPECT_GT(aliased.difference(), 1e-3);
}

}  // namespace
}  // namespace fw::oracles::detail
