#include "record/frame_selector.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"

namespace fw::record {

FrameSelector::FrameSelector(double t0, double t1, const StepControl& control, std::uint64_t frames,
                             FrameSink& sink)
    : t0_(t0), t1_(t1), frames_(frames), expected_(frames), sink_(sink) {
  if (frames < 2) throw InputError(fmt::format("frames: found {}, expected at least 2", frames));
  if (const auto* fixed = std::get_if<FixedStep>(&control)) {
    step_ = fixed->step;
    count_ = count_steps(t0, t1, step_);
    expected_ = std::min(frames, count_.total() + 1);
    frames_ = expected_;
  }
}

double FrameSelector::target_time(std::uint64_t frame) const {
  return t0_ + (t1_ - t0_) * (static_cast<double>(frame) / static_cast<double>(frames_ - 1));
}

std::uint64_t FrameSelector::target_step(std::uint64_t frame) const {
  if (frame + 1 == frames_) return count_.total();
  const double steps = (target_time(frame) - t0_) / step_;
  std::uint64_t nearest = static_cast<std::uint64_t>(std::llround(steps));
  // A shorter last step lies between two multiples of h.
  if (nearest >= count_.total()) nearest = count_.total() - 1;
  // Every frame has a step of its own: with as many frames as states, rounding must not skip or repeat one.
  const std::uint64_t frames_after = frames_ - 1 - frame;
  return std::clamp(nearest, frame, count_.total() - frames_after);
}

void FrameSelector::write(double time, ConstVectorRef state) {
  sink_.frame(time, state);
  ++written_;
  ++next_;
}

void FrameSelector::resume(std::uint64_t written) {
  if (written > expected_) {
    throw InputError(
        fmt::format("frames: found {} before the continued run, expected at most {}", written, expected_));
  }
  next_ = written_ = written;
}

bool FrameSelector::observe(const StepView& view) {
  if (step_ > 0.0) {
    observe_fixed(view);
  } else {
    observe_adaptive(view);
  }
  return true;
}

void FrameSelector::observe_fixed(const StepView& view) {
  if (next_ < frames_ && view.index == target_step(next_)) write(view.time, view.state);
}

void FrameSelector::observe_adaptive(const StepView& view) {
  if (view.index == 0) {
    write(view.time, view.state);
    return;
  }
  while (next_ + 1 < frames_ && target_time(next_) <= view.time) {
    const double time = target_time(next_);
    interpolated_.resize(view.state.size());
    view.interpolate(time, interpolated_);
    write(time, interpolated_);
  }
  if (view.last && next_ + 1 == frames_) write(view.time, view.state);
}

}  // namespace fw::record
