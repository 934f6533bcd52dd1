#pragma once

#include <optional>
#include <string>

#include "app/run_events.hpp"
#include "record/frame_sink.hpp"
#include "store/trajectory_writer.hpp"

namespace fw::app {

/// Passes frames on and keeps the time of the last one.
class FrameClock final : public record::FrameSink {
 public:
  explicit FrameClock(record::FrameSink& next) : next_(next) {}
  void frame(double time, ConstVectorRef state) override {
    time_ = time;
    next_.frame(time, state);
  }
  double time() const { return time_; }

 private:
  record::FrameSink& next_;
  double time_ = 0.0;
};

/// What the file of a run says besides its numbers; told on the terminal as well: warnings, the events that were met,
/// and the one that stopped it. `events` null: none were asked for; `has_stops`: one was to stop it.
store::RunNotes tell(const Solution& solution, const RunEvents* events, const std::optional<std::string>& stopped_at,
                     bool has_stops);

}  // namespace fw::app
