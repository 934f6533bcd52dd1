#pragma once

#include <chrono>
#include <string>

namespace fw::app {

/// A progress bar on standard error with rate and time left; silent unless that is a terminal.
class ProgressBar {
 public:
  explicit ProgressBar(std::string unit);  ///< of the rate, for example "steps"
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// Whether `update` would draw now: at most ten times a second, and only on a terminal.
  bool is_due() const;
  /// Draws if it is due. `fraction` in [0, 1], `count` in units, `label` at the end of the
  /// line.
  void update(double fraction, double count, const std::string& label);
  /// Removes the bar, so that other text can be printed.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  std::string unit_;
  bool is_terminal_;
  bool drawn_ = false;
  Clock::time_point start_, last_;
};

}  // namespace fw::app
