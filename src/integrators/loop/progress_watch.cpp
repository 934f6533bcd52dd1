#include "integrators/loop/progress_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace fw::integrators {

namespace {

/// Some libraries only warn of steps below the rounding of t and would go on with them for ever.
constexpr std::uint64_t most_standing_steps = 20;
constexpr std::uint64_t window = 1000;      // steps
constexpr double most_windows_left = 1000;  // a million steps
constexpr double growth = 1.5;              // of the pace, in a run that recovers
constexpr int idle_windows = 3;
constexpr double share_of_what_is_needed = 0.01;
constexpr int power_iterations = 30;

/// By power iteration from w; every second product, since those of an oscillation turn.
double spectral_radius(const OdeSystem& system, double t, ConstVectorRef y, Vector w) {
  Vector image(w.size());
  double square = 0.0;
  for (int k = 0; k < power_iterations; ++k) {
    const double norm = w.norm();
    if (!(norm > 0.0) || !std::isfinite(norm)) break;
    w /= norm;
    system.jacobian_product(t, y, w, image);
    system.jacobian_product(t, y, image, w);
    square = w.norm();
  }
  return std::sqrt(square);
}

}  // namespace

ProgressWatch::ProgressWatch(const MethodInfo& info, const Ivp& ivp, const AdaptiveStep* tolerances)
    : ivp_(ivp),
      tolerances_(tolerances),
      estimate_order_(info.embedded_order > 0 ? std::min(info.order, info.embedded_order)
                                              : std::max(1, info.order)),
      window_start_(ivp.t0) {}

Status ProgressWatch::judge(const LoopStep& step, ConstVectorRef y, ConstVectorRef y_new) {
  standing_ = step.end > step.start ? 0 : standing_ + 1;
  if (standing_ >= most_standing_steps) {
    return {StatusCode::step_too_small,
            fmt::format("at t = {:.6g} the step fell below the rounding of t", step.end)};
  }
  if (tolerances_ == nullptr || ++steps_ < window) return {};
  return judge_pace(step, y, y_new);
}

Status ProgressWatch::judge_pace(const LoopStep& step, ConstVectorRef y, ConstVectorRef y_new) {
  const double pace = step.end - window_start_, rest = ivp_.t1 - step.end;
  const double mean = pace / static_cast<double>(window);
  const bool grows = pace > growth * pace_;
  pace_ = pace;
  window_start_ = step.end;
  steps_ = 0;
  const bool is_idle =
      pace > 0.0 && rest > most_windows_left * pace && !grows && mean < 0.5 * tolerances_->maximum_step &&
      change_in_step(step, y, y_new) <
          share_of_what_is_needed * std::pow(smallest_relative_tolerance(y), 1.0 / (estimate_order_ + 1));
  idle_ = is_idle ? idle_ + 1 : 0;
  if (idle_ < idle_windows) return {};
  return {
      StatusCode::no_progress,
      fmt::format("at t = {:.6g} steps of {:.2g} s do not grow, though the solution hardly changes within "
                  "one; {:.1g} more are needed to the end: take another method, or other tolerances",
                  step.end, mean, rest / mean)};
}

double ProgressWatch::change_in_step(const LoopStep& step, ConstVectorRef y, ConstVectorRef y_new) const {
  const OdeSystem& system = *ivp_.system;
  const double h = step.end - step.start;
  Vector before(y.size()), after(y.size());
  system.rhs(step.start, y, before);
  system.rhs(step.end, y_new, after);
  const double size = std::max(before.norm(), after.norm());
  const double turning = size > 0.0 ? (after - before).norm() / size : 0.0;
  // A start with something of every mode: the slope and a vector without a pattern.
  Vector start = before;
  for (Index i = 0; i < start.size(); ++i) start[i] += size * std::sin(1.0 + static_cast<double>(i));
  const double stiffness = h * spectral_radius(system, step.end, y_new, std::move(start));
  // A maximum that keeps NaN, by which nothing is idle.
  return std::isnan(stiffness) || stiffness > turning ? stiffness : turning;
}

double ProgressWatch::smallest_relative_tolerance(ConstVectorRef y) const {
  const double size = y.size() > 0 ? y.lpNorm<Eigen::Infinity>() : 0.0;
  const double absolute = size > 0.0 ? tolerances_->absolute_tolerance / size : 1.0;
  return std::min({tolerances_->relative_tolerance, absolute, 1.0});
}

void ProgressWatch::serialise(StateArchive& archive) {
  archive.visit("steps without progress", standing_);
}

}  // namespace fw::integrators
