#pragma once

#include "ode/observer.hpp"
#include "study/plan.hpp"

namespace fw::study {

/// Ends a run early when the user interrupts; the case then throws `Interrupted`.
class StopWhenInterrupted final : public Observer {
 public:
  explicit StopWhenInterrupted(const RunContext& context) : context_(context) {}
  bool observe(const StepView&) override { return !context_.is_interrupted(); }

 private:
  const RunContext& context_;
};

}  // namespace fw::study
