#pragma once

#include "core/work.hpp"

namespace fw {

/// A counter of `Work` under the names that it has outside.
struct WorkCounter {
  const char* name;   ///< in result files
  const char* words;  ///< in checkpoints
  std::uint64_t Work::*count;
};

/// All of them, in the order of files.
inline constexpr WorkCounter work_counters[] = {
    {"rhs_evaluations", "right-hand sides", &Work::rhs_evaluations},
    {"jacobian_evaluations", "Jacobians", &Work::jacobian_evaluations},
    {"jacobian_products", "Jacobian products", &Work::jacobian_products},
    {"factorisations", "factorisations", &Work::factorisations},
    {"linear_solves", "linear solves", &Work::linear_solves},
    {"linear_iterations", "linear iterations", &Work::linear_iterations},
    {"newton_iterations", "Newton iterations", &Work::newton_iterations},
    {"accepted_steps", "accepted steps", &Work::accepted_steps},
    {"rejected_steps", "rejected steps", &Work::rejected_steps},
};

}  // namespace fw
