#pragma once

#include <gtest/gtest.h>
#include <nvector/nvector_serial.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "oracles/sundials/eigen_vector.hpp"

namespace fw::oracles::detail {

inline constexpr double unit_roundoff = std::numeric_limits<double>::epsilon();
/// Around the widths of registers, the length of a chunk of the fused operations, and several chunks.
inline const std::vector<Index> sizes = {1, 2, 3, 4, 5, 7, 8, 9, 63, 511, 512, 513, 2000};

/// A few vectors of ours and of SUNDIALS' serial kind with the same entries. The serial ones are the slow
/// twin that every operation is compared with.
class Twins {
 public:
  Twins(std::uint64_t seed, Index size, std::size_t count)
      : context_(make_context()), size_(size), random_(seed) {
    for (std::size_t k = 0; k < count; ++k) {
      ours_.push_back(new_eigen_vector(size, context_.get()));
      serial_.push_back(own<VectorPointer>(N_VNew_Serial(size, context_.get()), "N_VNew_Serial"));
      for (Index i = 0; i < size; ++i) set(k, i, entry());
    }
  }

  /// In ±[0.1, 2), so that quotients keep their size.
  double entry() {
    const double magnitude = std::uniform_real_distribution<double>(0.1, 2.0)(random_);
    return std::uniform_int_distribution<int>(0, 1)(random_) == 1 ? magnitude : -magnitude;
  }
  void set(std::size_t k, Index i, double value) {
    mutable_view(ours_[k].get(), size_)[i] = value;
    mutable_view(serial_[k].get(), size_)[i] = value;
  }

  SUNContext context() const { return context_.get(); }
  Index size() const { return size_; }
  std::vector<N_Vector> ours() const { return pointers(ours_); }
  std::vector<N_Vector> serial() const { return pointers(serial_); }
  Vector values(std::size_t k) const { return view(ours_[k].get(), size_); }

  /// The largest difference between the kinds, relative to the larger of 1 and the entry.
  double difference() const {
    double largest = 0.0;
    for (std::size_t k = 0; k < ours_.size(); ++k) {
      for (Index i = 0; i < size_; ++i) {
        const double a = view(ours_[k].get(), size_)[i], b = view(serial_[k].get(), size_)[i];
        const double off = std::abs(a - b) / std::max(1.0, std::abs(b));
        largest = std::isnan(off) ? std::numeric_limits<double>::infinity() : std::max(largest, off);
      }
    }
    return largest;
  }

 private:
  static std::vector<N_Vector> pointers(const std::vector<VectorPointer>& owners) {
    std::vector<N_Vector> list;
    for (const VectorPointer& owner : owners) list.push_back(owner.get());
    return list;
  }
  ContextPointer context_;
  Index size_;
  std::mt19937_64 random_;
  std::vector<VectorPointer> ours_, serial_;
};

/// Runs an operation `operation(vectors)` on both kinds and compares all entries of all vectors, inputs
/// included (they must not change unless they are outputs). With equal roundings the results are the same
/// bits; the serial vector rounds in another place where it pulls out a common factor.
template <class Operation>
void compare_entries(const std::string& what, std::size_t count, Operation&& operation,
                     double tolerance = 0.0) {
  for (const Index size : sizes) {
    Twins twins(2026 + static_cast<std::uint64_t>(size), size, count);
    operation(twins.ours());
    operation(twins.serial());
    EXPECT_LE(twins.difference(), tolerance) << what << ", size " << size;
  }
}

/// The same for an operation with a number as its result; its sum has `size` terms.
template <class Operation>
void compare_numbers(const std::string& what, std::size_t count, Operation&& operation) {
  for (const Index size : sizes) {
    const Twins twins(77 + static_cast<std::uint64_t>(size), size, count);
    const double ours = operation(twins.ours()), serial = operation(twins.serial());
    EXPECT_NEAR(ours, serial, static_cast<double>(size) * unit_roundoff * std::max(1.0, std::abs(serial)))
        << what << ", size " << size;
    EXPECT_EQ(twins.difference(), 0.0) << what << ": a reduction changed its input";
  }
}

using V = const std::vector<N_Vector>&;

}  // namespace fw::oracles::detail
