#pragma once

#include <array>
#include <cstdint>

namespace fw::analysis {

/// ∫ f dt from values at equal distances that come in one by one: the trapezoidal rule with Gregory's end
/// corrections by differences of order 1 to 6, of order of accuracy 8 [Hildebrand 1974, 5.9]. The integral so
/// far is known at any time; nothing but the first and last seven values is kept.
class GregoryQuadrature {
 public:
  void add(double value);
  /// From the first value to the last at distances `step`; with fewer than eight values fewer differences
  /// enter. 0 for fewer than two.
  double integral(double step) const;

 private:
  static constexpr std::size_t kept = 7;
  std::array<double, kept> first_{}, last_{};  ///< last_[0] is the newest
  std::uint64_t count_ = 0;
  double sum_ = 0.0, compensation_ = 0.0;  ///< compensated summation [Neumaier 1974]
};

}  // namespace fw::analysis
