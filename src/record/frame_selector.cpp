#include "record/frame_selector.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"

namespace fw::record {

namespace {

constexpr std::uint64_t usual_intervals = default_frames - 1, fewest_intervals = 50, most_intervals = 200;

/// How many of `steps` steps lie between two frames.
std::uint64_t default_stride(std::uint64_t steps) {
  if (steps <= usual_intervals) return 1;
  const auto distance = [](std::uint64_t intervals) {
    return std::abs(std::log(static_cast<double>(intervals) / static_cast<double>(usual_intervals)));
  };
  std::uint64_t best = 0;
  for (std::uint64_t intervals = fewest_intervals; intervals <= most_intervals; ++intervals) {
    if (steps % intervals == 0 && (best == 0 || distance(intervals) < distance(best))) best = intervals;
  }
  return best != 0 ? steps / best : (steps + usual_intervals / 2) / usual_intervals;
}

}  // namespace

FramePlan::FramePlan(double t0, double t1, const StepControl& control, std::optional<std::uint64_t> frames)
    : t0_(t0), t1_(t1), frames_(frames.value_or(default_frames)) {
  if (frames_ < 2) throw InputError(fmt::format("frames: found {}, expected at least 2", frames_));
  const auto* fixed = std::get_if<FixedStep>(&control);
  if (fixed == nullptr) return;
  step_ = fixed->step;
  steps_ = count_steps(t0, t1, step_);
  if (frames) {
    frames_ = std::min(frames_, steps_.total() + 1);
  } else {
    stride_ = default_stride(steps_.whole);
    frames_ = (steps_.total() + stride_ - 1) / stride_ + 1;
  }
}

double FramePlan::time(std::uint64_t frame) const {
  return t0_ + (t1_ - t0_) * (static_cast<double>(frame) / static_cast<double>(frames_ - 1));
}

std::uint64_t FramePlan::step(std::uint64_t frame) const {
  if (frame + 1 == frames_) return steps_.total();
  if (stride_ > 0) return frame * stride_;
  const double steps = (time(frame) - t0_) / step_;
  std::uint64_t nearest = static_cast<std::uint64_t>(std::llround(steps));
  // A shorter last step lies between two multiples of h.
  if (nearest >= steps_.total()) nearest = steps_.total() - 1;
  // Every frame has a step of its own: with as many frames as states, rounding must not skip or repeat one.
  const std::uint64_t frames_after = frames_ - 1 - frame;
  return std::clamp(nearest, frame, steps_.total() - frames_after);
}

FrameOrigin FramePlan::origin(const MethodInfo& info, const OdeSystem& system) const {
  if (is_fixed()) return {"ends of steps", spacing()};
  const int order = dense_order_on(info, system);
  return {fmt::format("dense output{}: {}", order > 0 ? fmt::format(" of order {}", order) : "",
                      to_string(info.dense_output)),
          "even"};
}

std::string FramePlan::spacing() const {
  const std::uint64_t steps = steps_.total(), intervals = frames_ - 1;
  const bool divides = steps % (stride_ > 0 ? stride_ : intervals) == 0;
  if (divides && steps_.remainder == 0.0) return "even";
  return stride_ > 0 || intervals == steps ? "even but for the last" : "uneven";
}

void FrameSelector::write(double time, ConstVectorRef state) {
  sink_.frame(time, state);
  ++written_;
}

void FrameSelector::resume(std::uint64_t written) {
  if (written > plan_.count()) {
    throw InputError(fmt::format("frames: found {} before the continued run, expected at most {}", written,
                                 plan_.count()));
  }
  written_ = written;
}

bool FrameSelector::observe(const StepView& view) {
  if (plan_.is_fixed()) {
    observe_fixed(view);
  } else {
    observe_adaptive(view);
  }
  return true;
}

void FrameSelector::observe_fixed(const StepView& view) {
  if (written_ < plan_.count() && view.index == plan_.step(written_)) write(view.time, view.state);
}

void FrameSelector::observe_adaptive(const StepView& view) {
  if (view.index == 0) {
    write(view.time, view.state);
    return;
  }
  while (written_ + 1 < plan_.count() && plan_.time(written_) <= view.time) {
    const double time = plan_.time(written_);
    interpolated_.resize(view.state.size());
    view.interpolate(time, interpolated_);
    write(time, interpolated_);
  }
  if (view.last && written_ + 1 == plan_.count()) write(view.time, view.state);
}

}  // namespace fw::record
