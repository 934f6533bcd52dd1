#pragma once

#include <cstring>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "ode/integrator.hpp"

namespace fw::integrators {

/// Every step of a run: time, state, and what dense output says two thirds into the step.
class StepRecord final : public Observer {
 public:
  StepRecord() = default;
  /// Of a run that continues another, saved at time `from`.
  explicit StepRecord(double from) : before_(from) {}

  bool observe(const StepView& view) override {
    if (view.index > 0 && view.interpolate) {
      Vector inside(view.state.size());
      view.interpolate(before_ + (view.time - before_) * 2.0 / 3.0, inside);
      insides.push_back(std::move(inside));
    }
    before_ = view.time;
    times.push_back(view.time);
    states.emplace_back(view.state);
    return true;
  }

  std::vector<double> times;
  std::vector<Vector> states, insides;

 private:
  double before_ = 0.0;
};

/// Keeps the saved state of a run after every step, by the time of the step.
class EveryStep final : public CheckpointSink {
 public:
  bool is_due(double) override { return true; }
  void take(double t, std::string_view bytes) override { saved.emplace_back(t, bytes); }

  std::vector<std::pair<double, std::string>> saved;
};

inline bool same_bits(double a, double b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

inline bool same_bits(const Vector& a, const Vector& b) {
  return a.size() == b.size() &&
         std::memcmp(a.data(), b.data(), static_cast<std::size_t>(a.size()) * sizeof(double)) == 0;
}

/// Whether `part` is the end of `whole`, bit for bit: times, states and, but for its first entry, what was
/// interpolated. Empty, or what differs.
inline std::string difference_from_end(const StepRecord& whole, const StepRecord& part) {
  if (part.times.size() > whole.times.size()) return "more steps";
  const std::size_t from = whole.times.size() - part.times.size();
  for (std::size_t k = 0; k < part.times.size(); ++k) {
    if (!same_bits(part.times[k], whole.times[from + k])) return "time of step " + std::to_string(from + k);
    if (!same_bits(part.states[k], whole.states[from + k]))
      return "state of step " + std::to_string(from + k);
  }
  const std::size_t lost = whole.insides.size() - part.insides.size();
  for (std::size_t k = 0; k < part.insides.size(); ++k) {
    if (!same_bits(part.insides[k], whole.insides[lost + k]))
      return "dense output of step " + std::to_string(lost + k + 1);
  }
  return {};
}

/// Empty, or the counter that differs.
inline std::string difference(const Work& a, const Work& b) {
  if (a.rhs_evaluations != b.rhs_evaluations) return "right-hand sides";
  if (a.jacobian_evaluations != b.jacobian_evaluations) return "Jacobians";
  if (a.jacobian_products != b.jacobian_products) return "Jacobian products";
  if (a.factorisations != b.factorisations) return "factorisations";
  if (a.linear_solves != b.linear_solves) return "linear solves";
  if (a.linear_iterations != b.linear_iterations) return "linear iterations";
  if (a.newton_iterations != b.newton_iterations) return "Newton iterations";
  if (a.accepted_steps != b.accepted_steps) return "accepted steps";
  if (a.rejected_steps != b.rejected_steps) return "rejected steps";
  return {};
}

/// An item of a saved state: its name and where its entries are.
struct SavedItem {
  std::string name;
  std::size_t begin = 0, size = 0;
};

/// The items of a saved state, read without the archive.
inline std::vector<SavedItem> items_of(const std::string& saved) {
  const std::map<char, std::size_t> entry_size{{'d', 8}, {'b', 1}, {'u', 8}, {'t', 1}, {'v', 8}, {'i', 4}};
  std::vector<SavedItem> items;
  for (std::size_t place = 0; place < saved.size();) {
    const char type = saved[place];
    const auto length = static_cast<unsigned char>(saved[place + 1]);
    SavedItem item{saved.substr(place + 2, length)};
    std::uint64_t entries = 0;
    std::memcpy(&entries, saved.data() + place + 2 + length, sizeof entries);
    item.begin = place + 2 + length + sizeof entries;
    item.size = entries * entry_size.at(type);
    place = item.begin + item.size;
    items.push_back(std::move(item));
  }
  return items;
}

}  // namespace fw::integrators
