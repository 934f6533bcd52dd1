#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "ode/integrator.hpp"
#include "ode/observer.hpp"
#include "ode/step_control.hpp"
#include "record/frame_sink.hpp"

namespace fw::record {

/// How the frames of a trajectory came about, as its file says it.
struct FrameOrigin {
  /// "ends of steps", or "dense output of order 5: polynomials through side steps of the scheme".
  std::string states;
  /// "even"; "even but for the last", whose distance is shorter; "uneven": the step ends nearest to an equal
  /// spacing.
  std::string spacing;
};

/// Frames of a run with chosen steps where none are asked for.
inline constexpr std::uint64_t default_frames = 101;

/// Which frames of a run are stored, from start to end inclusive.
///
/// With a fixed step every frame is the state at the end of a step. Where no number of frames is asked for,
/// there are as many steps between any two: that divisor of the number of steps which leaves nearest to 100
/// intervals, if one leaves 50 to 200, else the number of steps nearest to that, and a shorter last interval.
/// A number that is asked for is met by the steps nearest to an equal spacing, uneven if it does not divide
/// the steps; where there are fewer steps than frames every state is stored once.
///
/// With chosen steps frames are at equal spacing by dense output.
class FramePlan {
 public:
  /// `frames` ≥ 2, or nothing for the default. Throws InputError otherwise.
  FramePlan(double t0, double t1, const StepControl& control, std::optional<std::uint64_t> frames);

  /// Frames of a run to the end.
  std::uint64_t count() const { return frames_; }
  bool is_fixed() const { return step_ > 0.0; }
  /// When a frame is wanted, from 0 [s]; of a run with chosen steps exactly then.
  double time(std::uint64_t frame) const;
  /// The step at whose end a frame of a run with a fixed step is, 0 for the start.
  std::uint64_t step(std::uint64_t frame) const;
  /// How the frames of a run of this method on this system come about.
  FrameOrigin origin(const MethodInfo& info, const OdeSystem& system) const;

 private:
  std::string spacing() const;

  double t0_, t1_, step_ = 0.0;
  StepCount steps_;
  std::uint64_t stride_ = 0;  ///< steps between frames; 0: those nearest to an equal spacing
  std::uint64_t frames_;
};

/// Passes the frames of a plan to a sink, in constant memory. The last one is the end state itself.
class FrameSelector final : public Observer {
 public:
  FrameSelector(const FramePlan& plan, FrameSink& sink) : plan_(plan), sink_(sink) {}

  bool observe(const StepView& view) override;

  /// Goes on after the first `written` frames, which the sink has already: for a run that continues another.
  void resume(std::uint64_t written);

  /// Frames passed on so far.
  std::uint64_t written() const { return written_; }
  const FramePlan& plan() const { return plan_; }

 private:
  void write(double time, ConstVectorRef state);
  void observe_fixed(const StepView& view);
  void observe_adaptive(const StepView& view);

  FramePlan plan_;
  std::uint64_t written_ = 0;
  FrameSink& sink_;
  Vector interpolated_;
};

}  // namespace fw::record
