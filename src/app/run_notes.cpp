#include "app/run_notes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

namespace fw::app {

store::RunNotes tell(const Solution& solution, const RunEvents* events, const std::optional<std::string>& stopped_at,
                     bool has_stops) {
  store::RunNotes notes{.warnings = solution.warnings, .stopped_at = stopped_at.value_or("")};
  for (const std::string& warning : notes.warnings) fmt::print(stderr, "federwerk: warning: {}\n", warning);
  if (events == nullptr) return notes;
  notes.has_events = true;
  for (const MetEvent& event : events->events()) {
    notes.event_times.push_back(event.time);
    notes.event_names.push_back(event.what);
  }
  constexpr std::size_t most_lines = 20;
  const std::size_t count = notes.event_times.size();
  for (std::size_t k = 0; k < std::min(count, most_lines); ++k) {
    fmt::print("t = {:.9g} s: {}\n", notes.event_times[k], notes.event_names[k]);
  }
  if (count > most_lines) fmt::print("and {} more events: see /events in the file\n", count - most_lines);
  if (stopped_at) {
    fmt::print("stopped at t = {:.9g} s: {}\n", solution.time, *stopped_at);
  } else if (has_stops) {
    fmt::print(stderr, "federwerk: note: no event of --stop-at was met until t = {:.6g} s\n", solution.time);
  }
  return notes;
}

}  // namespace fw::app
