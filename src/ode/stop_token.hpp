#pragma once

#include <atomic>

namespace fw {

/// Asks a run, or a sequence of them, to stop: the user's interrupt as the run loop sees it. A copy asks the
/// same flag, which outlives it. Without a flag nobody ever asks.
class StopToken {
 public:
  StopToken() = default;
  explicit StopToken(const std::atomic<bool>& flag) : flag_(&flag) {}

  bool stop_requested() const { return flag_ != nullptr && flag_->load(std::memory_order_relaxed); }

 private:
  const std::atomic<bool>* flag_ = nullptr;
};

}  // namespace fw
