#pragma once

#include <filesystem>

#include "ode/solve_options.hpp"
#include "record/frame_sink.hpp"
#include "store/checkpoint_file.hpp"

namespace fw::app {

/// Writes the checkpoints of a simulation: at the first accepted step whose time has reached the next
/// multiple of `every`, and where the user interrupts. It stands before the sink of the frames and keeps
/// those that have passed, since the result file appears at the end only.
class CheckpointWriter final : public CheckpointSink, public record::FrameSink {
 public:
  /// `run` describes the simulation; its frames, time and state are replaced. `every` in seconds of model
  /// time, > 0.
  CheckpointWriter(std::filesystem::path path, double every, store::Checkpoint run, StopToken stop,
                   record::FrameSink& frames);

  void frame(double time, ConstVectorRef state) override;
  bool is_due(double t) override;
  void take(double t, std::string_view saved) override;

  std::uint64_t written() const { return written_; }

 private:
  std::filesystem::path path_;
  double every_, next_;
  store::Checkpoint run_;
  StopToken stop_;
  record::FrameSink& frames_;
  std::uint64_t written_ = 0;
};

}  // namespace fw::app
