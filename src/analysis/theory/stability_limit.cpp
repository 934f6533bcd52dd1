#include "analysis/theory/stability_limit.hpp"
#include "core/special_values.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace fw::analysis {

namespace {

/// Small, so that a scheme's own bound on the size of a state is far away.
constexpr double amplitude = 1e-6;
/// Growth beyond this needs no more steps to be seen.
constexpr double clear_growth = 1e20;
/// What has decayed so far is stable; numbers near the smallest ones would lose their digits next.
constexpr double vanishing = 1e-100;

class QuarterMaxima final : public Observer {
 public:
  QuarterMaxima(const Vector& weight, std::int64_t steps)
      : weight_(weight), steps_(static_cast<std::uint64_t>(steps)) {}

  bool observe(const StepView& view) override {
    const double norm = weight_.cwiseProduct(view.state).norm();
    if (view.index == 0) start_ = norm;
    const std::uint64_t quarter = std::min<std::uint64_t>(3, 4 * view.index / (steps_ + 1));
    maximum_[quarter] = std::max(maximum_[quarter], norm);
    last_ = view.index;
    if (norm > clear_growth * start_) has_blown_up_ = true;
    if (norm < vanishing * start_) has_vanished_ = true;
    return !has_blown_up_ && !has_vanished_;
  }

  bool has_blown_up() const { return has_blown_up_; }
  double maximum(int quarter) const { return maximum_[quarter]; }

 private:
  const Vector& weight_;
  std::uint64_t steps_, last_ = 0;
  double start_ = 0.0;
  double maximum_[4] = {0.0, 0.0, 0.0, 0.0};
  bool has_blown_up_ = false, has_vanished_ = false;
};

class SignWatch final : public Observer {
 public:
  bool observe(const StepView& view) override {
    if (view.index == 0) start_ = view.state[0];
    if (view.state[0] * start_ < 0.0) changed_ = true;
    return !changed_ && view.state[0] != 0.0;
  }
  bool changed() const { return changed_; }

 private:
  double start_ = 0.0;
  bool changed_ = false;
};

}  // namespace

double LimitSearch::next(double step) const {
  double factor = ratio;
  if (std::isfinite(watched)) {
    const double place = step / watched;
    constexpr double slack = 1.0 - 1e-9;  // of steps that should lie on the borders
    if (place >= 0.997 * slack && place < 1.004) {
      factor = std::min(factor, 1.0005);
    } else if (place >= 0.98 * slack && place < 1.02) {
      factor = std::min(factor, 1.0025);
    } else if (place >= 0.7 * slack && place < 0.98) {
      factor = std::min({factor, 1.02, 0.98 / place});
    } else if (place < 0.7) {
      factor = std::min(factor, 0.7 / place);
    }
  }
  return std::min(step * factor, farthest);
}

double largest_stable_step(const std::function<bool(double)>& is_stable, const LimitSearch& search) {
  double good = 0.0, bad = 0.0;
  if (is_stable(search.first)) {
    good = search.first;
    for (double step = good;;) {
      if (step >= search.farthest) return infinity;
      step = search.next(step);
      if (!is_stable(step)) {
        bad = step;
        break;
      }
      good = step;
    }
  } else {
    bad = search.first;
    for (double step = 0.5 * bad; step >= search.first / 64.0; step *= 0.5) {
      if (is_stable(step)) {
        good = step;
        break;
      }
      bad = step;
    }
    if (good == 0.0) return 0.0;
  }
  while (bad - good > search.resolution * bad) {
    const double middle = 0.5 * (good + bad);
    (is_stable(middle) ? good : bad) = middle;
  }
  return 0.5 * (good + bad);
}

double resolved_growth(const SchemeGrowth& growth, bool is_of_whole_step, bool is_explicit) {
  if (is_of_whole_step) return 1e-6;
  if (growth.basis() == GrowthBasis::stability_function) return 1e-13;
  if (growth.basis() == GrowthBasis::single_steps) return is_explicit ? 1e-10 : 1e-7;
  return 1e-9;
}

double predicted_limit(const SchemeGrowth& growth, const LinearModes& modes,
                       const std::shared_ptr<const OdeSystem>& system, bool is_explicit, double first,
                       double farthest, const std::function<void()>& check) {
  const auto growth_at = [&](double step) {
    if (check) check();
    return growth.of_system(modes, step, system);
  };
  if (std::isnan(growth_at(first))) return no_value;
  if (modes.is_undamped && growth.grows_at_every_step()) return 0.0;
  const bool is_whole = growth.is_of_whole_step(modes, system);
  const double allowed = 1.0 + resolved_growth(growth, is_whole, is_explicit);
  constexpr double resolution = 1e-5, fine = 1.002;
  const auto is_stable = [&](double step) { return growth_at(step) <= allowed; };
  const double limit =
      largest_stable_step(is_stable, {.first = first,
                                      .ratio = is_whole                                      ? 1.05
                                               : growth.basis() == GrowthBasis::single_steps ? 1.01
                                                                                             : fine,
                                      .farthest = farthest,
                                      .resolution = resolution});
  if (!is_whole || !(limit > 0.0)) return limit;
  // Such steps are too dear to lie closer, and stability of a splitting may end with a narrow gap. With dampers it
  // lies where it does without, if they leave any of it.
  const auto is_stable_undamped = [&](double step) {
    return std::all_of(modes.vibrations.begin(), modes.vibrations.end(), [&](const VibrationMode& mode) {
      return growth.of_vibration(step * step * mode.omega_squared, 0.0) <= allowed;
    });
  };
  const double gap = largest_stable_step(
      is_stable_undamped, {.first = first, .ratio = fine, .farthest = farthest, .resolution = resolution});
  constexpr double before = 0.98, behind = 1.03;
  if (!(gap > 0.0) || !(before * gap < limit)) return limit;
  const double in_gap = largest_stable_step(is_stable, {.first = before * gap,
                                                        .ratio = fine,
                                                        .farthest = std::min(behind * gap, limit),
                                                        .resolution = resolution});
  return std::min(in_gap, limit);
}

GrowthExperiment::GrowthExperiment(std::shared_ptr<const Integrator> integrator,
                                   std::shared_ptr<const OdeSystem> system, double t0, double frequency,
                                   std::uint64_t seed, StopToken stop)
    : integrator_(std::move(integrator)),
      system_(std::move(system)),
      t0_(t0),
      start_(system_->size()),
      weight_(Vector::Ones(system_->size())),
      stop_(stop) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (Index i = 0; i < start_.size(); ++i) start_[i] = amplitude * uniform(random);
  const SecondOrderSystem* second_order = system_->second_order();
  if (second_order == nullptr) return;
  const Index n = second_order->degrees_of_freedom();
  weight_.head(n).setConstant(frequency);
  start_.tail(n) *= frequency;
  for (Index i = 0; i < n; ++i) {
    if (second_order->fixed()[static_cast<std::size_t>(i)]) start_[i] = start_[n + i] = 0.0;
  }
}

GrowthExperiment::GrowthExperiment(std::shared_ptr<const Integrator> integrator,
                                   std::shared_ptr<const OdeSystem> system, double t0, const Vector& shape,
                                   double frequency, StopToken stop)
    : integrator_(std::move(integrator)),
      system_(std::move(system)),
      t0_(t0),
      start_(system_->size()),
      weight_(system_->size()),
      stop_(stop) {
  const Vector root_mass = system_->second_order()->mass().cwiseSqrt();
  weight_ << frequency * root_mass, root_mass;
  constexpr double phase = 1.0;
  start_ << amplitude * std::cos(phase) * shape, amplitude * frequency * std::sin(phase) * shape;
}

GrowthExperiment::Outcome GrowthExperiment::run(double step, std::int64_t steps) const {
  QuarterMaxima observer(weight_, steps);
  const Ivp ivp{system_, t0_, t0_ + step * static_cast<double>(steps), start_, {}};
  const Solution solution = integrator_->solve(ivp, FixedStep{.step = step, .allow_short_last_step = false},
                                               observer, {.stop = stop_});
  Outcome outcome;
  if (observer.has_blown_up() ||
      (!solution.status.ok() && solution.status.code != StatusCode::stopped_by_observer)) {
    outcome.growth = infinity;
    if (!observer.has_blown_up()) outcome.status = solution.status;
    outcome.rate = std::numeric_limits<double>::quiet_NaN();
    return outcome;
  }
  const double first = observer.maximum(0), second = observer.maximum(1), last = observer.maximum(3);
  outcome.growth = first > 0.0 ? last / first : 0.0;
  // The maxima of growing quarters are at their ends.
  outcome.rate = second > 0.0 ? std::log(last / second) / (0.5 * static_cast<double>(steps)) : 0.0;
  return outcome;
}

bool changes_sign(const Integrator& integrator, const std::shared_ptr<const OdeSystem>& system, double step,
                  std::int64_t steps) {
  SignWatch watch;
  const Ivp ivp{system, 0.0, step * static_cast<double>(steps), Vector::Ones(system->size()), {}};
  integrator.solve(ivp, FixedStep{.step = step, .allow_short_last_step = false}, watch);
  return watch.changed();
}

}  // namespace fw::analysis
