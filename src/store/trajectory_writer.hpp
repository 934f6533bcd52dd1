#pragma once

#include <filesystem>
#include <functional>
#include <memory>

#include "core/status.hpp"
#include "core/vec3.hpp"
#include "core/work.hpp"
#include "mechanics/mass_spring_model.hpp"
#include "record/frame_sink.hpp"
#include "store/file_header.hpp"

namespace fw::store {

/// What is stored of a frame besides its state.
struct FrameQuantities {
  double kinetic = 0.0;             ///< [J]
  double elastic = 0.0;             ///< springs and anchors [J]
  double gravitational = 0.0;       ///< [J]
  double obstacle = 0.0;            ///< penalty energy [J]
  Vec3<double> linear_momentum{};   ///< [kg·m/s]
  Vec3<double> angular_momentum{};  ///< about the origin [kg·m²/s]
};

/// The quantities of the state (t, q, v).
using QuantitiesOf = std::function<FrameQuantities(double t, ConstVectorRef q, ConstVectorRef v)>;

/// Streams a trajectory of a mass-spring system into a result file of kind "trajectory". Memory is bounded by
/// a few megabytes whatever the number of frames and particles. The file appears under its name when `finish`
/// has returned and not before; without `finish` nothing remains.
class TrajectoryWriter final : public record::FrameSink {
 public:
  /// `expected_frames` only sets the size of the chunks. `header.kind` is ignored. Throws SystemError.
  TrajectoryWriter(const std::filesystem::path& path, const FileHeader& header,
                   const mechanics::MassSpringModel& model, QuantitiesOf quantities, Index expected_frames);
  ~TrajectoryWriter() override;

  /// Appends a frame; `state` has 6n entries. Throws SystemError (disk full), InputError (wrong size, or the
  /// writer is finished).
  void frame(double time, ConstVectorRef state) override;

  /// Completes and publishes the file: status "complete" if the solver succeeded, else "incomplete" with what
  /// was computed; the attribute `solver_status` says why. Throws SystemError.
  void finish(const Status& status, const Work& work);

 private:
  struct Datasets;
  std::unique_ptr<Datasets> datasets_;
  QuantitiesOf quantities_;
  Index particles_;
};

}  // namespace fw::store
