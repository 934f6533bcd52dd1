#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "mechanics/assembly/element_assembly.hpp"
#include "mechanics/driving.hpp"
#include "ode/force_splitting.hpp"

namespace fw::mechanics {

/// Which elements are stiff: those whose rate dσ/dL [N/m] exceeds the geometric mean √(k_min k_max) of the
/// smallest and the largest positive rate; where all rates are equal, all of them. An element of rate zero (a
/// mere damper) is soft. A spring's damper goes with it. `rates`, and the result, are batch by batch.
std::vector<std::vector<bool>> stiff_elements(const std::vector<std::vector<double>>& rates);

/// The forces of a system as stiff springs and the rest: soft springs, gravity, drag, anchors, obstacles,
/// forces over time.
class SpringSplitting final : public ForceSplitting {
 public:
  /// Whether the system has a spring of positive stiffness.
  static bool is_possible(const ElementAssembly& elements);

  /// Keeps references to the elements, the positions of their blocks, and the system's count of springs
  /// without a direction, into which it counts. `driving`: what depends on time, or null.
  SpringSplitting(const ElementAssembly& elements, const BlockPattern& pattern,
                  std::atomic<std::uint64_t>& degenerate, std::shared_ptr<const Driving> driving = {});

  /// Splits other elements from now on; who holds this splitting keeps it.
  void split(const ElementAssembly& elements, const BlockPattern& pattern,
             std::shared_ptr<const Driving> driving = {});

  void stiff_force(double t, ConstVectorRef q, ConstVectorRef v, VectorRef f) const override;
  void soft_force(double t, ConstVectorRef q, ConstVectorRef v, VectorRef f) const override;
  void stiff_stiffness(double t, ConstVectorRef q, ConstVectorRef v, SparseMatrix& K) const override;
  void stiff_damping(double t, ConstVectorRef q, ConstVectorRef v, SparseMatrix& D) const override;

 private:
  void count_degenerate(std::uint64_t springs) const {
    if (springs > 0) degenerate_.fetch_add(springs, std::memory_order_relaxed);
  }

  const ElementAssembly* elements_ = nullptr;
  const BlockPattern* pattern_ = nullptr;
  std::shared_ptr<const Driving> driving_;
  ElementChoice stiff_, soft_;
  std::atomic<std::uint64_t>& degenerate_;
};

}  // namespace fw::mechanics
