#include "ode/observer.hpp"

namespace fw {

bool TrajectoryRecorder::observe(const StepView& view) {
  times_.push_back(view.time);
  states_.emplace_back(view.state);
  return true;
}

}  // namespace fw
