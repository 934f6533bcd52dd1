#include <nvector/nvector_serial.h>

#include <algorithm>
#include <array>

#include "core/types.hpp"
#include "oracles/sundials/eigen_vector_operations.hpp"

namespace fw::oracles::detail {

namespace {

using ArrayMap = Eigen::Map<Eigen::ArrayXd>;

/// Entries that are worked on at once: their sum stays in the first-level cache while the inputs stream by.
constexpr sunindextype chunk_size = 512;

/// Entries [begin, begin + size) of a vector.
ArrayMap chunk(N_Vector vector, sunindextype begin, sunindextype size) {
  return {NV_DATA_S(vector) + begin, size};
}

/// Calls `work(begin, size)` for every chunk of [0, length).
template <class Work>
void for_each_chunk(sunindextype length, Work&& work) {
  for (sunindextype begin = 0; begin < length; begin += chunk_size) {
    work(begin, std::min(chunk_size, length - begin));
  }
}

/// sum = Σ_j c_j X_j on a chunk, four inputs per pass over the sum, added in their order.
template <class Sum>
void add_up(int count, const double* c, N_Vector* X, sunindextype begin, Sum& sum) {
  const sunindextype size = sum.size();
  const auto term = [&](int j) { return c[j] * chunk(X[j], begin, size); };
  int j = 0;
  switch (count % 4) {
    case 1:
      sum = term(0);
      j = 1;
      break;
    case 2:
      sum = term(0) + term(1);
      j = 2;
      break;
    case 3:
      sum = term(0) + term(1) + term(2);
      j = 3;
      break;
    default:
      sum = term(0) + term(1) + term(2) + term(3);
      j = 4;
  }
  for (; j < count; j += 4) sum = sum + term(j) + term(j + 1) + term(j + 2) + term(j + 3);
}

/// z = Σ_j c_j X_j. The sum is collected aside, so that z may be any of the X_j.
int linear_combination(int count, double* c, N_Vector* X, N_Vector z) {
  if (count < 1) return -1;
  alignas(64) std::array<double, chunk_size> memory;
  for_each_chunk(NV_LENGTH_S(z), [&](sunindextype begin, sunindextype size) {
    if (count <= 4) {
      ArrayMap sum = chunk(z, begin, size);
      add_up(count, c, X, begin, sum);
      return;
    }
    Eigen::Map<Eigen::ArrayXd, Eigen::Aligned64> sum(memory.data(), size);
    add_up(count, c, X, begin, sum);
    chunk(z, begin, size) = sum;
  });
  return 0;
}

/// Z_j = a_j x + Y_j. Z_j may be Y_j.
int scale_add_multi(int count, double* a, N_Vector x, N_Vector* Y, N_Vector* Z) {
  if (count < 1) return -1;
  for_each_chunk(NV_LENGTH_S(x), [&](sunindextype begin, sunindextype size) {
    for (int j = 0; j < count; ++j) {
      chunk(Z[j], begin, size) = a[j] * chunk(x, begin, size) + chunk(Y[j], begin, size);
    }
  });
  return 0;
}

/// d_j = x·Y_j.
int dot_product_multi(int count, N_Vector x, N_Vector* Y, double* d) {
  if (count < 1) return -1;
  std::fill_n(d, count, 0.0);
  for_each_chunk(NV_LENGTH_S(x), [&](sunindextype begin, sunindextype size) {
    for (int j = 0; j < count; ++j) d[j] += (chunk(x, begin, size) * chunk(Y[j], begin, size)).sum();
  });
  return 0;
}

/// Calls a standard operation for each vector of an array; the vectors are too many for a chunk of all of
/// them to stay in cache together, so there is nothing to fuse.
template <class Operation>
int for_each_vector(int count, Operation&& operation) {
  if (count < 1) return -1;
  for (int i = 0; i < count; ++i) operation(i);
  return 0;
}

int linear_sum_array(int count, double a, N_Vector* X, double b, N_Vector* Y, N_Vector* Z) {
  return for_each_vector(count, [&](int i) { N_VLinearSum(a, X[i], b, Y[i], Z[i]); });
}

int scale_array(int count, double* c, N_Vector* X, N_Vector* Z) {
  return for_each_vector(count, [&](int i) { N_VScale(c[i], X[i], Z[i]); });
}

int constant_array(int count, double c, N_Vector* Z) {
  return for_each_vector(count, [&](int i) { N_VConst(c, Z[i]); });
}

int wrms_norm_array(int count, N_Vector* X, N_Vector* W, double* norm) {
  return for_each_vector(count, [&](int i) { norm[i] = N_VWrmsNorm(X[i], W[i]); });
}

int wrms_norm_mask_array(int count, N_Vector* X, N_Vector* W, N_Vector id, double* norm) {
  return for_each_vector(count, [&](int i) { norm[i] = N_VWrmsNormMask(X[i], W[i], id); });
}

/// The arrays of SUNDIALS' two-fold operations are indexed by summand first; the i-th vector's summands are
/// gathered here, a few at a time, since there is no bound on their number.
class Column {
 public:
  static constexpr int capacity = 16;

  N_Vector* gather(N_Vector** arrays, int first, int count, int i) {
    for (int j = 0; j < count; ++j) vectors_[static_cast<std::size_t>(j)] = arrays[first + j][i];
    return vectors_.data();
  }

 private:
  std::array<N_Vector, capacity> vectors_{};
};

/// Z[j][i] = a_j X_i + Y[j][i].
int scale_add_multi_array(int count, int sums, double* a, N_Vector* X, N_Vector** Y, N_Vector** Z) {
  if (sums < 1) return -1;
  Column summands, results;
  return for_each_vector(count, [&](int i) {
    for (int j = 0; j < sums; j += Column::capacity) {
      const int some = std::min(Column::capacity, sums - j);
      scale_add_multi(some, a + j, X[i], summands.gather(Y, j, some, i), results.gather(Z, j, some, i));
    }
  });
}

/// Z_i = Σ_j c_j X[j][i]. Z_i may be X[0][i].
int linear_combination_array(int count, int sums, double* c, N_Vector** X, N_Vector* Z) {
  if (sums < 1) return -1;
  Column summands;
  return for_each_vector(count, [&](int i) {
    int some = std::min(Column::capacity, sums);
    linear_combination(some, c, summands.gather(X, 0, some, i), Z[i]);
    for (int j = some; j < sums; j += some) {
      // Beyond the capacity: the sum so far is the first summand of the next.
      some = std::min(Column::capacity - 1, sums - j);
      std::array<double, Column::capacity> factors{1.0};
      std::array<N_Vector, Column::capacity> vectors{Z[i]};
      std::copy_n(c + j, some, factors.begin() + 1);
      std::copy_n(summands.gather(X, j, some, i), some, vectors.begin() + 1);
      linear_combination(some + 1, factors.data(), vectors.data(), Z[i]);
    }
  });
}

}  // namespace

void set_fused_operations(_generic_N_Vector_Ops& table) {
  table.nvlinearcombination = linear_combination;
  table.nvscaleaddmulti = scale_add_multi;
  table.nvdotprodmulti = table.nvdotprodmultilocal = dot_product_multi;
  table.nvlinearsumvectorarray = linear_sum_array;
  table.nvscalevectorarray = scale_array;
  table.nvconstvectorarray = constant_array;
  table.nvwrmsnormvectorarray = wrms_norm_array;
  table.nvwrmsnormmaskvectorarray = wrms_norm_mask_array;
  table.nvscaleaddmultivectorarray = scale_add_multi_array;
  table.nvlinearcombinationvectorarray = linear_combination_array;
}

}  // namespace fw::oracles::detail
