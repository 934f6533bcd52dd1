#pragma once

#include <chrono>
#include <cstddef>
#include <string>

#include "study/runner.hpp"

namespace fw::app {

/// "3:07" or "1:02:03".
std::string duration_text(double seconds);

/// The oldest of the running cases with its time, and its stage with an estimate where it has told of one:
/// "kepler-rk4 for 1:40 (reference in binary128: 34 %, about 2:10 left) and 1 more". Empty: none runs.
std::string running_text(const std::vector<study::RunningCase>& running);

/// How far a command is, on standard error: on a terminal a bar with rate and time left, ten times a second and
/// no wider than the terminal; elsewhere a line a minute, or every so many seconds as the environment variable
/// FEDERWERK_PROGRESS says (0: none).
class ProgressBar {
 public:
  /// `unit` is that of the rate, for example "steps". Throws InputError for a FEDERWERK_PROGRESS that is no number ≥ 0.
  explicit ProgressBar(std::string unit);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// Whether `update` would write now.
  bool is_due() const;
  /// Writes if it is due. `fraction` in [0, 1], `count` in units, `label` at the end of the line.
  void update(double fraction, double count, const std::string& label);
  /// Removes the bar, so that other text can be printed.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  std::string unit_;
  bool is_terminal_;
  double interval_;  ///< [s]; 0: never
  bool drawn_ = false;
  Clock::time_point start_, last_;
};

}  // namespace fw::app
