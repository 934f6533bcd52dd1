#include "app/checkpoint_writer.hpp"

#include <cmath>

namespace fw::app {

CheckpointWriter::CheckpointWriter(std::filesystem::path path, double every, store::Checkpoint run,
                                   StopToken stop, record::FrameSink& frames)
    : path_(std::move(path)),
      every_(every),
      next_(every * (std::floor(run.time / every) + 1.0)),
      run_(std::move(run)),
      stop_(stop),
      frames_(frames) {
  run_.frame_times.clear();
  run_.frame_states.clear();
}

void CheckpointWriter::frame(double time, ConstVectorRef state) {
  run_.frame_times.push_back(time);
  run_.frame_states.insert(run_.frame_states.end(), state.data(), state.data() + state.size());
  frames_.frame(time, state);
}

bool CheckpointWriter::is_due(double t) {
  return t >= next_ || stop_.stop_requested();
}

void CheckpointWriter::take(double t, std::string_view saved) {
  run_.time = t;
  run_.run = saved;
  store::write_checkpoint(path_, run_);
  next_ = every_ * (std::floor(t / every_) + 1.0);
  ++written_;
}

}  // namespace fw::app
