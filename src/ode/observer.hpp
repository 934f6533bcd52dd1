#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/types.hpp"

namespace fw {

/// A state as it is passed to an observer: valid only during the call.
struct StepView {
  std::uint64_t index = 0;  ///< 0 at the start, then the number of accepted steps
  double time = 0.0;        ///< t_n [s]
  ConstVectorRef state;     ///< y_n
  bool last = false;        ///< the end time is reached
  /// Dense output (`MethodInfo::dense_output`): writes y(t) for t in [t_{n−1}, t_n], NaN where the scheme
  /// cannot reach t; empty at the start. May cost right-hand sides, which `Work` counts.
  const std::function<void(double t, VectorRef out)>& interpolate;
};

/// Watches a run step by step, so that a million steps need not be a million stored states.
class Observer {
 public:
  virtual ~Observer() = default;

  /// Called once with the initial state (index 0) and after every accepted step. Returns false to stop the
  /// run.
  virtual bool observe(const StepView& view) = 0;
};

/// Observes nothing.
class NullObserver final : public Observer {
 public:
  bool observe(const StepView&) override { return true; }
};

/// Keeps every state, for short runs and tests.
class TrajectoryRecorder final : public Observer {
 public:
  bool observe(const StepView& view) override;

  const std::vector<double>& times() const { return times_; }
  const std::vector<Vector>& states() const { return states_; }

 private:
  std::vector<double> times_;
  std::vector<Vector> states_;
};

}  // namespace fw
