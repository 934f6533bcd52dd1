#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/status.hpp"
#include "core/work.hpp"
#include "mechanics/mass_spring_model.hpp"
#include "record/frame_sink.hpp"
#include "store/file_header.hpp"

namespace fw::store {

/// A number or vector that is stored of each frame besides its state.
struct FrameQuantity {
  std::string name;  ///< of the dataset
  std::string unit;
  int components = 1;  ///< 1 for a number
};

/// The quantities of a frame, in the order of the datasets.
struct FrameQuantities {
  std::vector<FrameQuantity> list;
  /// Writes their components at (t, q, v), one quantity after the other.
  std::function<void(double t, ConstVectorRef q, ConstVectorRef v, std::span<double> values)> evaluate;
};

/// What is told of a run besides its numbers.
struct RunNotes {
  std::vector<std::string> warnings{};     ///< sentences, see `Solution::warnings`
  std::string stopped_at{};                ///< the event that ended it; empty: none
  bool has_events = false;                 ///< events were looked for
  std::vector<double> event_times{};       ///< [s], in their order
  std::vector<std::string> event_names{};  ///< as many
};

/// Streams a trajectory of a mass-spring system into a result file of kind "trajectory". Memory is bounded by
/// a few megabytes whatever the number of frames and particles. The file appears under its name when `finish`
/// has returned and not before; without `finish` nothing remains.
class TrajectoryWriter final : public record::FrameSink {
 public:
  /// `expected_frames` only sets the size of the chunks. `header.kind` is ignored. Throws SystemError.
  TrajectoryWriter(const std::filesystem::path& path, const FileHeader& header,
                   const mechanics::MassSpringModel& model, FrameQuantities quantities,
                   Index expected_frames);
  ~TrajectoryWriter() override;

  /// Appends a frame; `state` has 6n entries. Throws SystemError (disk full), InputError (wrong size, or the
  /// writer is finished).
  void frame(double time, ConstVectorRef state) override;

  /// Completes and publishes the file: status "complete" if the solver succeeded, else "incomplete" with what
  /// was computed; the attribute `solver_status` says why. Throws SystemError.
  void finish(const Status& status, const Work& work, const RunNotes& notes = {});

 private:
  struct Datasets;
  std::unique_ptr<Datasets> datasets_;
  FrameQuantities quantities_;
  std::vector<double> values_;  ///< of the quantities of a frame
  Index particles_;
};

}  // namespace fw::store
