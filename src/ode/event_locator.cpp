#include "ode/event_locator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"

namespace fw {

namespace {

/// The far end of a bracket of a sign change of g in [a, b], not wider than `tolerance`; ITP with the
/// constants of its authors, κ₁ = 0.2/(b − a), κ₂ = 2, n₀ = 1. `ga` and `gb` have opposite signs, `gb` may be
/// zero.
template <class Function>
double far_end_of_crossing(Function g, double a, double ga, double b, double gb, double tolerance) {
  const double half = 0.5 * tolerance;
  const double kappa = 0.2 / (b - a);
  const double most_steps = std::max(0.0, std::ceil(std::log2((b - a) / tolerance))) + 1.0;
  const bool rises = ga < 0.0;
  for (double j = 0.0; b - a > tolerance && gb != 0.0; ++j) {
    const double width = b - a;
    const double middle = a + 0.5 * width;
    const double secant = (gb * a - ga * b) / (gb - ga);
    // Truncate towards the middle, then project into the interval that bisection's worst case allows.
    const double towards = std::copysign(1.0, middle - secant);
    const double truncation = kappa * width * width;
    double trial = truncation <= std::abs(middle - secant) ? secant + towards * truncation : middle;
    const double radius = std::max(0.0, half * std::exp2(most_steps - j) - 0.5 * width);
    if (std::abs(trial - middle) > radius) trial = middle - towards * radius;
    if (!(trial > a && trial < b)) trial = middle;
    if (!(trial > a && trial < b)) break;  // neighbouring doubles
    const double value = g(trial);
    if (value == 0.0 || (value > 0.0) == rises) {
      b = trial;
      gb = value;
    } else {
      a = trial;
      ga = value;
    }
  }
  return b;
}

}  // namespace

EventLocator::EventLocator(std::vector<EventFunction> functions, Observer& inner, EventOptions options)
    : functions_(std::move(functions)), inner_(inner), options_(options), values_(functions_.size()) {
  if (!(options_.time_tolerance > 0.0) || !std::isfinite(options_.time_tolerance)) {
    throw InputError(fmt::format("events: time tolerance: found {}, expected a finite number > 0",
                                 options_.time_tolerance));
  }
  if (options_.samples_per_step < 1) {
    throw InputError(
        fmt::format("events: samples per step: found {}, expected >= 1", options_.samples_per_step));
  }
  for (std::size_t k = 0; k < functions_.size(); ++k) {
    if (!functions_[k].value) {
      throw InputError(fmt::format("events: function {} (\"{}\") is empty", k, functions_[k].name));
    }
  }
}

double EventLocator::value(std::size_t k, double t, ConstVectorRef y) const {
  const double result = functions_[k].value(t, y);
  if (!std::isfinite(result)) {
    throw InputError(
        fmt::format("event function {} (\"{}\"): found {} at t = {:.6g}, expected a finite number", k,
                    functions_[k].name, result, t));
  }
  return result;
}

void EventLocator::start(const StepView& view) {
  for (std::size_t k = 0; k < functions_.size(); ++k) values_[k] = value(k, view.time, view.state);
  events_.clear();
  terminated_ = false;
  sample_time_ = view.time;
  sample_.resize(view.state.size());
  trial_.resize(view.state.size());
}

std::optional<double> EventLocator::crossing(const StepView& view, std::size_t k, double from, double to,
                                             double end_value) {
  const double start_value = values_[k];
  // What starts at zero has no sign yet: leaving zero is no event.
  const bool crosses = start_value != 0.0 && (end_value == 0.0 || (start_value < 0.0) != (end_value < 0.0));
  if (!crosses) return {};
  const bool rises = start_value < 0.0;
  const EventDirection direction = functions_[k].direction;
  if (direction != EventDirection::both && (direction == EventDirection::rising) != rises) return {};
  const auto g = [&](double t) {
    view.interpolate(t, trial_);
    return value(k, t, trial_);
  };
  return far_end_of_crossing(g, from, start_value, to, end_value, options_.time_tolerance);
}

void EventLocator::search(const StepView& view, double from, double to, ConstVectorRef end_state) {
  struct Crossing {
    double time;
    std::size_t function;
  };
  std::vector<Crossing> crossings;  // stays empty, without memory, in nearly all steps
  for (std::size_t k = 0; k < functions_.size(); ++k) {
    const double end_value = value(k, to, end_state);
    if (const auto time = crossing(view, k, from, to, end_value)) crossings.push_back({*time, k});
    values_[k] = end_value;
  }
  std::ranges::stable_sort(crossings, {}, &Crossing::time);
  for (const Crossing& found : crossings) {
    Event event{found.time, end_state, found.function};
    if (found.time < to) view.interpolate(found.time, event.state);
    events_.push_back(std::move(event));
    if (functions_[found.function].terminal) {
      terminated_ = true;
      return;
    }
  }
}

bool EventLocator::observe(const StepView& view) {
  if (view.index == 0) {
    start(view);
    return inner_.observe(view);
  }
  if (!view.interpolate) {
    throw InputError(
        "events: the method offers no interpolation inside its steps, so events cannot be located");
  }
  const double begin = sample_time_, length = view.time - begin;
  double from = begin;
  for (int j = 1; j <= options_.samples_per_step && !terminated_; ++j) {
    if (j == options_.samples_per_step) {
      search(view, from, view.time, view.state);
    } else {
      const double to = begin + length * j / options_.samples_per_step;
      view.interpolate(to, sample_);
      search(view, from, to, sample_);
      from = to;
    }
  }
  sample_time_ = view.time;
  if (!terminated_) return inner_.observe(view);
  const Event& event = events_.back();
  inner_.observe({view.index, event.time, event.state, false, view.interpolate});
  return false;
}

Solution solve_with_events(const Integrator& integrator, const Ivp& ivp, const StepControl& control,
                           EventLocator& locator, const SolveOptions& options) {
  Solution solution = integrator.solve(ivp, control, locator, options);
  if (const Event* event = locator.terminal_event()) {
    const std::string& name = locator.functions()[event->function].name;
    solution.time = event->time;
    solution.state = event->state;
    solution.status = {StatusCode::stopped_by_observer,
                       fmt::format("event \"{}\" at t = {:.6g}", name, event->time)};
  }
  return solution;
}

}  // namespace fw
