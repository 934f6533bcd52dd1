#pragma once

#include <cstdint>

#include "ode/observer.hpp"
#include "ode/step_control.hpp"
#include "record/frame_sink.hpp"

namespace fw::record {

/// Passes frames at (nearly) equal spacing from start to end inclusive to a sink, in constant memory.
///
/// With a fixed step a frame is the state at the step time nearest to its target, stored with its true time;
/// where there are fewer steps than frames every state is stored once. With an adaptive method frames are
/// interpolated at their targets by dense output. The last frame is the end state itself.
class FrameSelector final : public Observer {
 public:
  /// `frames` ≥ 2. Throws InputError otherwise.
  FrameSelector(double t0, double t1, const StepControl& control, std::uint64_t frames, FrameSink& sink);

  bool observe(const StepView& view) override;

  /// Goes on after the first `written` frames, which the sink has already: for a run that continues another.
  void resume(std::uint64_t written);

  /// Frames passed on so far.
  std::uint64_t written() const { return written_; }
  /// Frames that a run to the end stores.
  std::uint64_t expected() const { return expected_; }

 private:
  double target_time(std::uint64_t frame) const;
  std::uint64_t target_step(std::uint64_t frame) const;
  void write(double time, ConstVectorRef state);
  void observe_fixed(const StepView& view);
  void observe_adaptive(const StepView& view);

  double t0_, t1_, step_ = 0.0;
  StepCount count_;
  std::uint64_t frames_, expected_, next_ = 0, written_ = 0;
  FrameSink& sink_;
  Vector interpolated_;
};

}  // namespace fw::record
