#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mechanics/block_pattern.hpp"
#include "mechanics/mass_spring_model.hpp"
#include "ode/force_splitting.hpp"

namespace fw::mechanics {

/// Which springs are stiff: those whose rate dσ/dL [N/m] exceeds the geometric mean √(k_min k_max) of the
/// smallest and the largest positive rate; where all rates are equal, all of them. A spring of rate zero (a
/// mere damper) is soft. A spring's damper goes with it.
std::vector<bool> stiff_springs(const Springs& springs);

/// The forces of a mass-spring model as stiff springs and the rest: soft springs, gravity, drag, anchors,
/// obstacles.
class SpringSplitting final : public ForceSplitting {
 public:
  /// Whether the model has a spring of positive stiffness.
  static bool is_possible(const MassSpringModel& model);

  /// Keeps references to the positions of the blocks, the flags of fixed degrees of freedom and the system's
  /// count of springs without a direction, into which it counts.
  SpringSplitting(const MassSpringModel& model, const BlockPattern& pattern, const std::vector<char>& fixed,
                  std::atomic<std::uint64_t>& degenerate);

  void stiff_force(double t, ConstVectorRef q, ConstVectorRef v, VectorRef f) const override;
  void soft_force(double t, ConstVectorRef q, ConstVectorRef v, VectorRef f) const override;
  void stiff_stiffness(double t, ConstVectorRef q, ConstVectorRef v, SparseMatrix& K) const override;
  void stiff_damping(double t, ConstVectorRef q, ConstVectorRef v, SparseMatrix& D) const override;

 private:
  template <class Block>
  void fill(ConstVectorRef q, ConstVectorRef v, SparseMatrix& matrix, const char* name, Block block) const;
  void count_degenerate(std::uint64_t springs) const {
    if (springs > 0) degenerate_.fetch_add(springs, std::memory_order_relaxed);
  }

  MassSpringModel stiff_, soft_;
  std::vector<std::size_t> stiff_index_;  ///< number in the whole model of each spring of `stiff_`
  const BlockPattern& pattern_;
  const std::vector<char>& fixed_;
  std::atomic<std::uint64_t>& degenerate_;
};

}  // namespace fw::mechanics
