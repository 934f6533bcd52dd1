#include "app/progress_bar.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace fw::app {

namespace {

constexpr int bar_width = 30;

std::string duration(double seconds) {
  const auto whole = static_cast<long>(seconds + 0.5);
  if (whole >= 3600) return fmt::format("{}:{:02d}:{:02d}", whole / 3600, whole / 60 % 60, whole % 60);
  return fmt::format("{}:{:02d}", whole / 60, whole % 60);
}

std::string magnitude(double value) {
  if (value >= 1e6) return fmt::format("{:.1f} M", value / 1e6);
  if (value >= 1e3) return fmt::format("{:.1f} k", value / 1e3);
  return fmt::format("{:.1f} ", value);
}

}  // namespace

ProgressBar::ProgressBar(std::string unit)
    : unit_(std::move(unit)), is_terminal_(isatty(STDERR_FILENO) == 1), start_(Clock::now()), last_(start_) {}

ProgressBar::~ProgressBar() {
  clear();
}

bool ProgressBar::is_due() const {
  return is_terminal_ && Clock::now() - last_ >= std::chrono::milliseconds(100);
}

void ProgressBar::update(double fraction, double count, const std::string& label) {
  if (!is_due()) return;
  const Clock::time_point now = Clock::now();
  last_ = now;
  fraction = std::clamp(fraction, 0.0, 1.0);
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const int filled = static_cast<int>(fraction * bar_width);
  const std::string left = fraction > 0.0 ? duration(elapsed * (1.0 - fraction) / fraction) : "?";
  fmt::print(stderr, "\r\033[K[{}{}] {:3.0f} %  {}{}/s  {} left  {}",
             std::string(static_cast<std::size_t>(filled), '#'),
             std::string(static_cast<std::size_t>(bar_width - filled), '.'), 100.0 * fraction,
             magnitude(count / std::max(elapsed, 1e-9)), unit_, left, label);
  std::fflush(stderr);
  drawn_ = true;
}

void ProgressBar::clear() {
  if (!drawn_) return;
  fmt::print(stderr, "\r\033[K");
  std::fflush(stderr);
  drawn_ = false;
}

}  // namespace fw::app
