#include "oracles/sundials/eigen_vector.hpp"

#include <gtest/gtest.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_klu.h>
#include <sunmatrix/sunmatrix_sparse.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "eigen_vector_twins.hpp"

namespace fw::oracles::detail {
namespace {

TEST(EigenVector, SaysWhatItIs) {
  const ContextPointer context = make_context();
  const VectorPointer vector = new_eigen_vector(37, context.get());
  EXPECT_EQ(N_VGetVectorID(vector.get()), SUNDIALS_NVEC_SERIAL);
  EXPECT_EQ(N_VGetLength(vector.get()), 37);
  EXPECT_EQ(N_VGetCommunicator(vector.get()), nullptr);
  sunindextype reals = 0, integers = 0;
  N_VSpace(vector.get(), &reals, &integers);
  EXPECT_EQ(reals, 37);
  EXPECT_EQ(integers, 1);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(N_VGetArrayPointer(vector.get())) % 64, 0u);
}

TEST(EigenVector, WrapsMemoryWithoutCopyingOrFreeingIt) {
  const ContextPointer context = make_context();
  Vector entries = Vector::LinSpaced(9, 1.0, 9.0);
  {
    const VectorPointer vector = wrap_eigen_vector(entries, context.get());
    EXPECT_EQ(N_VGetArrayPointer(vector.get()), entries.data());
    N_VScale(2.0, vector.get(), vector.get());
  }
  EXPECT_EQ(entries[8], 18.0);
  // A segment that begins at no even address.
  const VectorPointer part = wrap_eigen_vector(entries.segment(1, 7), context.get());
  N_VConst(-1.0, part.get());
  EXPECT_EQ(entries[0], 2.0);
  EXPECT_EQ(entries[1], -1.0);
  EXPECT_EQ(entries[7], -1.0);
  EXPECT_EQ(entries[8], 18.0);
}

TEST(EigenVector, ClonesItsKindWithMemoryOfItsOwn) {
  const ContextPointer context = make_context();
  Vector entries = Vector::Constant(5, 3.0);
  const VectorPointer original = wrap_eigen_vector(entries, context.get());
  const VectorPointer clone(N_VClone(original.get()));
  ASSERT_NE(clone, nullptr);
  EXPECT_NE(N_VGetArrayPointer(clone.get()), entries.data());
  EXPECT_EQ(N_VGetLength(clone.get()), 5);
  EXPECT_EQ(clone->ops->nvlinearsum, original->ops->nvlinearsum);
  EXPECT_EQ(clone->ops->nvlinearcombination, original->ops->nvlinearcombination);
  N_VConst(1.0, clone.get());
  EXPECT_EQ(entries[0], 3.0);

  const VectorPointer empty(N_VCloneEmpty(original.get()));
  ASSERT_NE(empty, nullptr);
  EXPECT_EQ(N_VGetArrayPointer(empty.get()), nullptr);
  EXPECT_EQ(N_VGetLength(empty.get()), 5);
  N_VSetArrayPointer(entries.data(), empty.get());
  EXPECT_EQ(N_VGetArrayPointer(empty.get()), entries.data());

  // Arrays of vectors, as CVODES and ARKODE clone them.
  N_Vector* several = N_VCloneVectorArray(3, original.get());
  ASSERT_NE(several, nullptr);
  N_VConst(7.0, several[2]);
  EXPECT_EQ(view(several[2], 5)[4], 7.0);
  N_VDestroyVectorArray(several, 3);
}

TEST(EigenVector, PacksAndUnpacksItsEntries) {
  const Twins twins(5, 11, 2);
  sunindextype bytes = 0;
  ASSERT_EQ(N_VBufSize(twins.ours()[0], &bytes), 0);
  ASSERT_EQ(bytes, 88);
  std::vector<std::byte> buffer(88);
  ASSERT_EQ(N_VBufPack(twins.ours()[0], buffer.data()), 0);
  ASSERT_EQ(N_VBufUnpack(twins.ours()[1], buffer.data()), 0);
  EXPECT_EQ(twins.values(0), twins.values(1));
}

TEST(EigenVector, AddsLinearlyInAllSpecialAndAliasedCases) {
  const std::vector<std::pair<double, double>> factors = {
      {1, 1},  {-1, 1}, {1, -1}, {-1, -1}, {0.5, 1}, {1, 0.5},  {-2, 1},     {1, -2},
      {-1, 3}, {3, -1}, {2, 2},  {2, -2},  {0, 1},   {0, 0.25}, {0.7, -0.3}, {0, 0}};
  for (const auto& [a, b] : factors) {
    // A common factor is pulled out by the serial vector: one rounding less.
    const double tolerance = std::abs(a) == std::abs(b) ? 3.0 * unit_roundoff : 0.0;
    const std::string what = "linear sum " + std::to_string(a) + ", " + std::to_string(b);
    compare_entries(
        what, 3, [&](V v) { N_VLinearSum(a, v[0], b, v[1], v[2]); }, tolerance);
    compare_entries(
        what + ", z = x", 2, [&](V v) { N_VLinearSum(a, v[0], b, v[1], v[0]); }, tolerance);
    compare_entries(
        what + ", z = y", 2, [&](V v) { N_VLinearSum(a, v[0], b, v[1], v[1]); }, tolerance);
    compare_entries(
        what + ", x = y", 2, [&](V v) { N_VLinearSum(a, v[0], b, v[0], v[1]); }, tolerance);
    compare_entries(
        what + ", x = y = z", 1, [&](V v) { N_VLinearSum(a, v[0], b, v[0], v[0]); }, tolerance);
  }
}

TEST(EigenVector, WorksEntryByEntry) {
  for (const double c : {0.0, 1.0, -1.0, 0.5, -2.5}) {
    const std::string of = " " + std::to_string(c);
    compare_entries("constant" + of, 1, [&](V v) { N_VConst(c, v[0]); });
    compare_entries("scale" + of, 2, [&](V v) { N_VScale(c, v[0], v[1]); });
    compare_entries("scale in place" + of, 1, [&](V v) { N_VScale(c, v[0], v[0]); });
    compare_entries("add constant" + of, 2, [&](V v) { N_VAddConst(v[0], c, v[1]); });
    compare_entries("add constant in place" + of, 1, [&](V v) { N_VAddConst(v[0], c, v[0]); });
    compare_entries("compare" + of, 2, [&](V v) { N_VCompare(c, v[0], v[1]); });
  }
  compare_entries("product", 3, [](V v) { N_VProd(v[0], v[1], v[2]); });
  compare_entries("product, z = x", 2, [](V v) { N_VProd(v[0], v[1], v[0]); });
  compare_entries("product, z = y", 2, [](V v) { N_VProd(v[0], v[1], v[1]); });
  compare_entries("square in place", 1, [](V v) { N_VProd(v[0], v[0], v[0]); });
  compare_entries("quotient", 3, [](V v) { N_VDiv(v[0], v[1], v[2]); });
  compare_entries("quotient, z = x", 2, [](V v) { N_VDiv(v[0], v[1], v[0]); });
  compare_entries("quotient, z = y", 2, [](V v) { N_VDiv(v[0], v[1], v[1]); });
  compare_entries("absolute value", 2, [](V v) { N_VAbs(v[0], v[1]); });
  compare_entries("absolute value in place", 1, [](V v) { N_VAbs(v[0], v[0]); });
  compare_entries("inverse", 2, [](V v) { N_VInv(v[0], v[1]); });
  compare_entries("inverse in place", 1, [](V v) { N_VInv(v[0], v[0]); });
}

TEST(EigenVector, ReducesToNumbers) {
  compare_numbers("dot product", 2, [](V v) { return N_VDotProd(v[0], v[1]); });
  compare_numbers("square", 1, [](V v) { return N_VDotProd(v[0], v[0]); });
  compare_numbers("maximum norm", 1, [](V v) { return N_VMaxNorm(v[0]); });
  compare_numbers("wrms norm", 2, [](V v) { return N_VWrmsNorm(v[0], v[1]); });
  compare_numbers("masked wrms norm", 3, [](V v) { return N_VWrmsNormMask(v[0], v[1], v[2]); });
  compare_numbers("minimum", 1, [](V v) { return N_VMin(v[0]); });
  compare_numbers("weighted 2-norm", 2, [](V v) { return N_VWL2Norm(v[0], v[1]); });
  compare_numbers("1-norm", 1, [](V v) { return N_VL1Norm(v[0]); });
  compare_numbers("minimum quotient", 2, [](V v) { return N_VMinQuotient(v[0], v[1]); });
  compare_numbers("local dot product", 2, [](V v) { return N_VDotProdLocal(v[0], v[1]); });
  compare_numbers("local maximum norm", 1, [](V v) { return N_VMaxNormLocal(v[0]); });
  compare_numbers("local minimum", 1, [](V v) { return N_VMinLocal(v[0]); });
  compare_numbers("local 1-norm", 1, [](V v) { return N_VL1NormLocal(v[0]); });
  compare_numbers("local square sum", 2, [](V v) { return N_VWSqrSumLocal(v[0], v[1]); });
  compare_numbers("local masked square sum", 3, [](V v) { return N_VWSqrSumMaskLocal(v[0], v[1], v[2]); });
  compare_numbers("local minimum quotient", 2, [](V v) { return N_VMinQuotientLocal(v[0], v[1]); });
}

TEST(EigenVector, GivesNormsInClosedForm) {
  const ContextPointer context = make_context();
  Vector x{{3.0, -4.0, 12.0, 0.0}}, w{{1.0, 0.5, -0.25, 9.0}}, id{{1.0, 0.0, -1.0, 2.0}};
  const VectorPointer X = wrap_eigen_vector(x, context.get()), W = wrap_eigen_vector(w, context.get()),
                      I = wrap_eigen_vector(id, context.get());
  EXPECT_EQ(N_VMaxNorm(X.get()), 12.0);
  EXPECT_EQ(N_VMin(X.get()), -4.0);
  EXPECT_EQ(N_VL1Norm(X.get()), 19.0);
  EXPECT_EQ(N_VDotProd(X.get(), W.get()), 3.0 - 2.0 - 3.0);
  EXPECT_EQ(N_VWL2Norm(X.get(), W.get()), std::sqrt(9.0 + 4.0 + 9.0));
  EXPECT_EQ(N_VWrmsNorm(X.get(), W.get()), std::sqrt(22.0 / 4.0));
  // Only entries with id > 0 count, but the mean is over all of them.
  EXPECT_EQ(N_VWrmsNormMask(X.get(), W.get(), I.get()), std::sqrt(9.0 / 4.0));
  EXPECT_EQ(N_VWSqrSumMaskLocal(X.get(), W.get(), I.get()), 9.0);
}

TEST(EigenVector, ComparesMagnitudesWithAThreshold) {
  const ContextPointer context = make_context();
  Vector x{{0.0, -1.0, 1.0, -1.0 + 1e-15, 2.0}}, z = Vector::Constant(5, -9.0);
  const VectorPointer X = wrap_eigen_vector(x, context.get()), Z = wrap_eigen_vector(z, context.get());
  N_VCompare(1.0, X.get(), Z.get());
  EXPECT_EQ(z, (Vector{{0.0, 1.0, 1.0, 0.0, 1.0}}));
}

TEST(EigenVector, InvertsWhatIsNotZeroAndLeavesTheRest) {
  for (const bool has_zero : {false, true}) {
    for (const Index size : sizes) {
      Twins twins(9, size, 2);
      if (has_zero) twins.set(0, size / 2, 0.0);
      for (const auto& list : {twins.ours(), twins.serial()}) {
        EXPECT_EQ(N_VInvTest(list[0], list[1]) == SUNTRUE, !has_zero);
      }
      EXPECT_EQ(twins.difference(), 0.0);
      for (const auto& list : {twins.ours(), twins.serial()}) {
        EXPECT_EQ(N_VInvTestLocal(list[0], list[0]) == SUNTRUE, !has_zero);
      }
      EXPECT_EQ(twins.difference(), 0.0);
    }
  }
}

TEST(EigenVector, MarksViolatedConstraints) {
  // Every kind of constraint with every sign of the value: c, x, whether it is violated.
  const std::vector<std::tuple<double, double, bool>> cases = {
      {2, 1, false},  {2, 0, true},    {2, -1, true}, {1, 1, false},  {1, 0, false},
      {1, -1, true},  {0, 1, false},   {0, 0, false}, {0, -1, false}, {-1, 1, true},
      {-1, 0, false}, {-1, -1, false}, {-2, 1, true}, {-2, 0, true},  {-2, -1, false}};
  const ContextPointer context = make_context();
  const auto size = static_cast<Index>(cases.size());
  Vector c(size), x(size), m(size), expected(size);
  for (Index i = 0; i < size; ++i) {
    const auto& [kind, value, violated] = cases[static_cast<std::size_t>(i)];
    c[i] = kind;
    x[i] = value;
    expected[i] = violated ? 1.0 : 0.0;
    Vector one_c{{kind}}, one_x{{value}}, one_m{{0.5}};
    const VectorPointer C = wrap_eigen_vector(one_c, context.get()),
                        X = wrap_eigen_vector(one_x, context.get()),
                        M = wrap_eigen_vector(one_m, context.get());
    EXPECT_EQ(N_VConstrMask(C.get(), X.get(), M.get()) == SUNTRUE, !violated) << kind << " " << value;
    EXPECT_EQ(one_m[0], expected[i]);
  }
  const VectorPointer C = wrap_eigen_vector(c, context.get()), X = wrap_eigen_vector(x, context.get()),
                      M = wrap_eigen_vector(m, context.get());
  EXPECT_EQ(N_VConstrMask(C.get(), X.get(), M.get()), SUNFALSE);
  EXPECT_EQ(m, expected);
  m.setConstant(5.0);
  EXPECT_EQ(N_VConstrMaskLocal(C.get(), X.get(), M.get()), SUNFALSE);
  EXPECT_EQ(m, expected);
}

TEST(EigenVector, TakesTheLeastQuotientOverDenominatorsThatAreNotZero) {
  const ContextPointer context = make_context();
  Vector x{{2.0, -8.0, 5.0}}, y{{4.0, 0.0, -1.0}}, zero = Vector::Zero(3);
  const VectorPointer X = wrap_eigen_vector(x, context.get()), Y = wrap_eigen_vector(y, context.get()),
                      Zero = wrap_eigen_vector(zero, context.get());
  EXPECT_EQ(N_VMinQuotient(X.get(), Y.get()), -5.0);
  EXPECT_EQ(N_VMinQuotient(X.get(), Zero.get()), BIG_REAL);
}

TEST(EigenVector, SumsTheSameBitsWhereverItLies) {
  const ContextPointer context = make_context();
  std::mt19937_64 random(12);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Vector memory(2 * 1009);
  Vector x(1001), w(1001);
  for (Index i = 0; i < x.size(); ++i) {
    x[i] = uniform(random);
    w[i] = uniform(random);
  }
  std::vector<double> dot, norm, one, several;
  for (Index offset = 0; offset < 8; ++offset) {
    memory.segment(offset, 1001) = x;
    memory.segment(1009, 1001) = w;
    const VectorPointer X = wrap_eigen_vector(memory.segment(offset, 1001), context.get()),
                        W = wrap_eigen_vector(memory.segment(1009, 1001), context.get());
    dot.push_back(N_VDotProd(X.get(), W.get()));
    norm.push_back(N_VWrmsNorm(X.get(), W.get()));
    one.push_back(N_VL1Norm(X.get()));
    N_Vector list[] = {W.get()};
    several.emplace_back();
    N_VDotProdMulti(1, X.get(), list, &several.back());
  }
  for (std::size_t k = 1; k < dot.size(); ++k) {
    EXPECT_EQ(dot[k], dot[0]);
    EXPECT_EQ(norm[k], norm[0]);
    EXPECT_EQ(one[k], one[0]);
    EXPECT_EQ(several[k], several[0]);
  }
}

TEST(EigenVector, HidesNoNan) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Index size : sizes) {
    Twins twins(3, size, 2);
    twins.set(0, size / 2, nan);
    const std::vector<N_Vector> v = twins.ours();
    EXPECT_TRUE(std::isnan(N_VMaxNorm(v[0]))) << size;
    EXPECT_TRUE(std::isnan(N_VMin(v[0]))) << size;
    EXPECT_TRUE(std::isnan(N_VWrmsNorm(v[0], v[1]))) << size;
    EXPECT_TRUE(std::isnan(N_VL1Norm(v[0]))) << size;
    // What a mask takes out may be anything.
    Twins mask(4, size, 1);
    for (Index i = 0; i < size; ++i) mask.set(0, i, i == size / 2 ? 0.0 : 1.0);
    EXPECT_TRUE(std::isfinite(N_VWrmsNormMask(v[0], v[1], mask.ours()[0]))) << size;
  }
}

TEST(EigenVector, HasEveryOperationOfTheSerialVectorAndMore) {
  const ContextPointer context = make_context();
  const VectorPointer ours = new_eigen_vector(3, context.get());
  const VectorPointer serial = new_vector(3, VectorOperations::serial, context.get());
  N_VEnableFusedOps_Serial(serial.get(), SUNTRUE);
  // The table is a struct of function pointers: read it as an array of them.
  constexpr std::size_t count = sizeof(_generic_N_Vector_Ops) / sizeof(void*);
  const auto* mine = reinterpret_cast<void* const*>(ours->ops);
  const auto* theirs = reinterpret_cast<void* const*>(serial->ops);
  for (std::size_t k = 0; k < count; ++k) {
    EXPECT_TRUE(theirs[k] == nullptr || mine[k] != nullptr) << "entry " << k;
  }
}

TEST(EigenVector, IsAcceptedByKlu) {
  const ContextPointer context = make_context();
  Vector b{{2.0, 9.0}}, x = Vector::Zero(2);
  const VectorPointer B = wrap_eigen_vector(b, context.get()), X = wrap_eigen_vector(x, context.get());
  const MatrixPointer A(SUNSparseMatrix(2, 2, 2, CSC_MAT, context.get()));
  const std::array<sunindextype, 3> columns = {0, 1, 2};
  const std::array<sunindextype, 2> rows = {0, 1};
  std::copy(columns.begin(), columns.end(), SUNSparseMatrix_IndexPointers(A.get()));
  std::copy(rows.begin(), rows.end(), SUNSparseMatrix_IndexValues(A.get()));
  SUNSparseMatrix_Data(A.get())[0] = 2.0;
  SUNSparseMatrix_Data(A.get())[1] = 3.0;
  const LinearSolverPointer klu(SUNLinSol_KLU(X.get(), A.get(), context.get()));
  ASSERT_NE(klu, nullptr);
  ASSERT_EQ(SUNLinSolInitialize(klu.get()), 0);
  ASSERT_EQ(SUNLinSolSetup(klu.get(), A.get()), 0);
  ASSERT_EQ(SUNLinSolSolve(klu.get(), A.get(), X.get(), B.get(), 0.0), 0);
  EXPECT_EQ(x, (Vector{{1.0, 3.0}}));
  ASSERT_EQ(SUNMatMatvec(A.get(), X.get(), B.get()), 0);
  EXPECT_EQ(b, (Vector{{2.0, 9.0}}));
}

}  // namespace
}  // namespace fw::oracles::detail
