#include "app/progress_bar.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "core/error.hpp"
#include "system/terminal.hpp"
#include "text/utf8.hpp"

namespace fw::app {

namespace {

constexpr int bar_width = 16;
constexpr double bar_interval = 0.1, line_interval = 60.0;  // [s]

std::string magnitude(double value) {
  if (value >= 1e6) return fmt::format("{:.1f} M", value / 1e6);
  if (value >= 1e3) return fmt::format("{:.1f} k", value / 1e3);
  return fmt::format("{:.1f} ", value);
}

/// [s] between lines where there is no terminal.
double interval_between_lines() {
  const char* variable = std::getenv("FEDERWERK_PROGRESS");
  if (variable == nullptr || *variable == '\0') return line_interval;
  const std::string_view text = variable;
  double interval = -1.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), interval);
  if (error != std::errc() || end != text.data() + text.size() || !(interval >= 0.0)) {
    throw InputError(fmt::format(
        "FEDERWERK_PROGRESS: found \"{}\", expected the seconds between lines of progress, or 0 for none",
        variable));
  }
  return interval;
}

/// What of one line fits, with dots where it is cut.
std::string cut_to(const std::string& text, std::size_t width) {
  if (text::displayed_width(text) <= width) return text;
  if (width < 4) return "";
  std::size_t bytes = 0;
  for (std::size_t points = 0; bytes < text.size(); ++bytes) {
    const bool starts = (static_cast<unsigned char>(text[bytes]) & 0xc0U) != 0x80U;
    if (starts && ++points > width - 3) break;
  }
  return text.substr(0, bytes) + "...";
}

/// [s] that work of which `fraction` took `elapsed` still takes; infinite where nothing is done.
double time_left(double elapsed, double fraction) {
  return elapsed * (1.0 - fraction) / fraction;
}

}  // namespace

std::string duration_text(double seconds) {
  if (!(seconds < 1e9)) return "?";
  const auto whole = static_cast<long>(seconds + 0.5);
  if (whole >= 3600) return fmt::format("{}:{:02d}:{:02d}", whole / 3600, whole / 60 % 60, whole % 60);
  return fmt::format("{}:{:02d}", whole / 60, whole % 60);
}

std::string running_text(const std::vector<study::RunningCase>& running) {
  if (running.empty()) return "";
  const study::RunningCase& first = running.front();
  std::string text = fmt::format("{} for {}", first.id, duration_text(first.seconds));
  if (first.stage) {
    const double fraction = first.stage->fraction;
    text += fmt::format(" ({}: {:.0f} %", first.stage->what, 100.0 * fraction);
    if (fraction >= 0.01 && fraction < 1.0) {  // before, an estimate would be noise
      text += fmt::format(", about {} left", duration_text(time_left(first.stage_seconds, fraction)));
    }
    text += ")";
  }
  return running.size() == 1 ? text : text + fmt::format(" and {} more", running.size() - 1);
}

ProgressBar::ProgressBar(std::string unit)
    : unit_(std::move(unit)),
      is_terminal_(is_terminal(STDERR_FILENO)),
      interval_(is_terminal_ ? bar_interval : interval_between_lines()),
      start_(Clock::now()),
      last_(start_) {}

ProgressBar::~ProgressBar() {
  clear();
}

bool ProgressBar::is_due() const {
  return interval_ > 0.0 && std::chrono::duration<double>(Clock::now() - last_).count() >= interval_;
}

void ProgressBar::update(double fraction, double count, const std::string& label) {
  if (!is_due()) return;
  const Clock::time_point now = Clock::now();
  last_ = now;
  fraction = std::isfinite(fraction) ? std::clamp(fraction, 0.0, 1.0) : 0.0;
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const std::string rate = fmt::format("{}{}/s", magnitude(count / std::max(elapsed, 1e-9)), unit_);
  const std::string left = duration_text(time_left(elapsed, fraction));
  const std::string running = text::printable_line(label);
  if (!is_terminal_) {
    const std::string estimate = fraction > 0.0 ? fmt::format(", about {} left", left) : "";
    fmt::print(stderr, "federwerk: {:.0f} % after {}, {}{}{}{}\n", 100.0 * fraction, duration_text(elapsed),
               rate, estimate, running.empty() ? "" : "; ", running);
    std::fflush(stderr);
    return;
  }
  const int filled = static_cast<int>(fraction * bar_width);
  const std::string line = fmt::format(
      "[{}{}] {:3.0f} %  {}  {} left  {}", std::string(static_cast<std::size_t>(filled), '#'),
      std::string(static_cast<std::size_t>(bar_width - filled), '.'), 100.0 * fraction, rate, left, running);
  // A line that reaches the edge would be broken, and only its last part removed.
  fmt::print(stderr, "\r\033[K{}", cut_to(line, terminal_width(STDERR_FILENO) - 1));
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
