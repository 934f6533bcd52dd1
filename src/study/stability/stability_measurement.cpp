#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include "analysis/theory/stability_limit.hpp"
#include "core/special_values.hpp"
#include "study/stability/stability_cases.hpp"

namespace fw::study {

namespace {

using analysis::GrowthExperiment;
using analysis::LinearModes;
using analysis::SchemeGrowth;

/// The smallest step of a search, in units of 1/|λ|: below the limit of every scheme that has one.
constexpr double first_step = 0.05;

class LimitMeasurement {
 public:
  LimitMeasurement(const StabilityProblem& problem, const StabilityMethod& method, const SchemeGrowth& growth,
                   const LimitSettings& settings, const RunContext& context)
      : ivp_(problem.ivp()),
        method_(method),
        growth_(growth),
        settings_(settings),
        context_(context),
        spectrum_(problem.spectrum(settings, context)),
        system_(spectrum_.system),
        original_has_springs_(has_springs(*problem.entry().problem.ivp.system)) {}

  StabilityLimit run() {
    StabilityLimit limit;
    limit.failure = why_lacking_springs();
    if (limit.failure.empty()) limit.failure = why_not_applicable(method_.integrator->info(), *system_);
    if (limit.failure.empty()) limit.failure = spectrum_.failure;
    if (limit.failure.empty() && !(spectrum_.spectral_radius > 0.0))
      limit.failure = "J has no eigenvalue other than 0";
    if (limit.failure.empty() && spectrum_.is_linear && spectrum_.modes.front().growing > 0)
      limit.failure =
          "J has eigenvalues with Re λ > 0: the exact solution grows, so a growing numerical solution says "
          "nothing about the step size";
    if (!limit.failure.empty()) return limit;
    limit.predicted = predict();
    if (spectrum_.is_linear) {
      observe_linear(limit);
    } else {
      observe_trajectory(limit);
    }
    if (spectrum_.is_linear && system_->size() == 1) find_monotone(limit);
    return limit;
  }

 private:
  static bool has_springs(const OdeSystem& system) {
    return system.second_order() != nullptr && system.second_order()->has_springs();
  }

  /// Springs are lost where the problem is replaced by its linear part, which the method cannot know.
  std::string why_lacking_springs() const {
    if (!method_.integrator->info().needs.has(Capability::springs) || !original_has_springs_) return {};
    if (has_springs(*system_)) return {};
    return "the method needs the springs of the problem, the limit is taken from its linear part M q'' = K q "
           "+ D q', which has none";
  }

  double unit() const { return 1.0 / spectrum_.spectral_radius; }
  double farthest() const { return settings_.farthest * unit(); }

  std::shared_ptr<const OdeSystem> exact_system() const { return spectrum_.is_linear ? system_ : nullptr; }

  double growth_at(const LinearModes& modes, double step) const {
    context_.check();
    return growth_.of_system(modes, step, exact_system());
  }

  double predict() const {
    double smallest = infinity;
    for (const LinearModes& modes : spectrum_.modes) {
      const double limit = predict(modes);
      if (std::isnan(limit)) return no_value;
      smallest = std::min(smallest, limit);
    }
    return smallest;
  }

  double predict(const LinearModes& modes) const {
    return analysis::predicted_limit(growth_, modes, exact_system(), method_.integrator->info().is_explicit,
                                     first_step * unit(), farthest(), [this] { context_.check(); });
  }

  bool is_by_steps() const { return growth_.basis() == analysis::GrowthBasis::single_steps; }

  /// So many steps that 1 % beyond the predicted limit grows clearly; 0: not with as many as are allowed.
  std::int64_t steps_for(double predicted) const {
    constexpr double clear = 18.0;  // ln of the growth
    if (!(predicted > 0.0)) return 0;
    if (std::isinf(predicted)) return settings_.fewest_steps / 4;
    double strongest = 1.0;
    for (const double excess : {5e-4, 1e-3, 2e-3, 4e-3, 7e-3, 1e-2})
      strongest = std::max(strongest, growth_at(spectrum_.modes.front(), (1.0 + excess) * predicted));
    const double steps = clear / std::log(strongest);
    if (!(steps <= static_cast<double>(settings_.most_steps))) return 0;
    return std::max(settings_.fewest_steps, static_cast<std::int64_t>(std::ceil(steps)));
  }

  void observe_linear(StabilityLimit& limit) {
    const GrowthExperiment experiment(method_.integrator, system_, ivp_.t0, spectrum_.spectral_radius,
                                      static_cast<std::uint64_t>(settings_.seed), context_.stop);
    limit.steps = steps_for(limit.predicted);
    if (limit.steps > 0 || std::isnan(limit.predicted)) {
      if (limit.steps == 0) limit.steps = settings_.fewest_steps;
      limit.observed = analysis::largest_stable_step(
          [&](double step) {
            const GrowthExperiment::Outcome outcome = experiment.run(step, limit.steps);
            context_.check();
            if (!outcome.status.ok() && outcome.status.code != StatusCode::blow_up)
              limit.failed_run = outcome.status.describe();
            return outcome.growth < settings_.growth;
          },
          search_near(limit.predicted));
      return;
    }
    confirm_growth(experiment, limit);
    if (limit.predicted > 0.0) observe_critical_mode(limit);
  }

  analysis::LimitSearch search_near(double predicted) const {
    return {.first = std::min(first_step * unit(), 0.5 * predicted),
            .ratio = 1.25,
            .farthest = farthest(),
            .watched = predicted > 0.0 ? predicted : infinity};
  }

  /// From the mode that grows most with this step; empty where modes are damped or unknown.
  std::optional<GrowthExperiment> critical_mode(double step) const {
    const LinearModes& modes = spectrum_.modes.front();
    if (modes.shapes.empty() || modes.coupling > 0.0) return std::nullopt;
    std::size_t critical = 0;
    double strongest = 0.0;
    for (std::size_t k = 0; k < modes.vibrations.size(); ++k) {
      const analysis::VibrationMode& mode = modes.vibrations[k];
      if (mode.damping != 0.0) return std::nullopt;
      const double growth = growth_.of_vibration(step * step * mode.omega_squared, 0.0);
      if (growth > strongest) {
        strongest = growth;
        critical = k;
      }
    }
    return GrowthExperiment(method_.integrator, system_, ivp_.t0, modes.shapes[critical],
                            std::sqrt(modes.vibrations[critical].omega_squared), context_.stop);
  }

  /// Growth that is too weak to be told from the beat of many modes is seen where only the mode that grows is
  /// excited: of R(z) to rounding, of others (whose norm is not that of the mode) by a fifth.
  void observe_critical_mode(StabilityLimit& limit) const {
    const std::optional<GrowthExperiment> experiment = critical_mode(1.01 * limit.predicted);
    if (!experiment) return;
    const MethodInfo& info = method_.integrator->info();
    const bool is_rational = growth_.basis() == analysis::GrowthBasis::stability_function ||
                             (growth_.basis() == analysis::GrowthBasis::single_steps && !info.is_multistep &&
                              !info.carries_more_than_state && !info.needs.has(Capability::second_order));
    const double resolved =
        is_by_steps() ? analysis::resolved_growth(growth_, false, method_.integrator->info().is_explicit)
                      : 1e-14;
    const double bound =
        is_rational ? 1.0 + 0.75 * resolved * static_cast<double>(settings_.most_steps) : 1.2;
    limit.observed = analysis::largest_stable_step(
        [&](double step) {
          const GrowthExperiment::Outcome outcome = experiment->run(step, settings_.most_steps);
          context_.check();
          return outcome.growth < bound;
        },
        search_near(limit.predicted));
  }

  /// Where instability has no threshold that runs could show, it is shown at two steps that are far apart:
  /// the factor per step has to be the predicted one.
  void confirm_growth(const GrowthExperiment& experiment, StabilityLimit& limit) const {
    constexpr double logarithm = 36.0;  // of the growth in a run
    limit.is_confirmed_by_growth = true;
    const LinearModes& modes = spectrum_.modes.front();
    for (const std::int64_t steps : {settings_.most_steps / 20, settings_.most_steps}) {
      const double wanted = logarithm / static_cast<double>(steps);
      double step =
          analysis::largest_stable_step([&](double h) { return !(std::log(growth_at(modes, h)) > wanted); },
                                        {.first = std::max(first_step * unit(), 1.01 * limit.predicted),
                                         .ratio = 1.05,
                                         .farthest = farthest(),
                                         .resolution = 1e-9});
      if (!(step > 0.0) || std::isinf(step)) continue;
      step *= 1.0 + 1e-9;  // growth may jump where a gap begins
      // Modes of nearly the same growth would blur it.
      const GrowthExperiment::Outcome outcome = critical_mode(step).value_or(experiment).run(step, steps);
      context_.check();
      limit.growth_ratios.push_back(outcome.rate / std::log(growth_at(modes, step)));
      limit.steps = steps;
    }
    const bool all_grow =
        !limit.growth_ratios.empty() && std::all_of(limit.growth_ratios.begin(), limit.growth_ratios.end(),
                                                    [](double ratio) { return ratio > 0.5; });
    if (all_grow && limit.predicted == 0.0) limit.observed = 0.0;
  }

  /// Of a nonlinear problem: the largest step with which velocities stay within `growth` times the largest
  /// ones of an accurate solution, on its own interval.
  void observe_trajectory(StabilityLimit& limit) const {
    class Bound final : public Observer {
     public:
      Bound(double bound, const SecondOrderSystem* system) : bound_(bound), system_(system) {}
      bool observe(const StepView& view) override {
        const double size =
            system_ != nullptr ? view.state.tail(system_->degrees_of_freedom()).norm() : view.state.norm();
        exceeded_ = exceeded_ || !(size <= bound_);
        return !exceeded_;
      }
      bool exceeded() const { return exceeded_; }

     private:
      double bound_;
      const SecondOrderSystem* system_;
      bool exceeded_ = false;
    };
    Ivp ivp = ivp_;
    ivp.y0_extended.clear();
    std::mt19937_64 random(static_cast<std::uint64_t>(settings_.seed));
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    const SecondOrderSystem* second_order = ivp.system->second_order();
    constexpr double perturbation = 1e-3;
    const Index n = second_order != nullptr ? second_order->degrees_of_freedom() : ivp.y0.size();
    const double size = perturbation * spectrum_.largest_size / std::sqrt(static_cast<double>(n));
    for (Index i = 0; i < n; ++i) {
      const double change = size * uniform(random);
      if (second_order == nullptr) ivp.y0[i] += change;
      if (second_order != nullptr && !second_order->fixed()[static_cast<std::size_t>(i)])
        ivp.y0[n + i] += change;
    }
    const double length = ivp.t1 - ivp.t0;
    constexpr double fewest = 40.0;
    limit.observed = analysis::largest_stable_step(
        [&](double step) {
          context_.check();
          const double steps = std::max(fewest, std::ceil(length / step));
          ivp.t1 = ivp.t0 + steps * step;
          Bound bound(settings_.growth * spectrum_.largest_size, second_order);
          const Solution solution = context_.solve(
              *method_.integrator, ivp, FixedStep{.step = step, .allow_short_last_step = false}, bound);
          return solution.status.ok() && !bound.exceeded();
        },
        {.first = first_step * unit(),
         .ratio = 1.25,
         .farthest = std::min(farthest(), length),
         .resolution = 5e-3});
    limit.steps = static_cast<std::int64_t>(fewest);
  }

  /// x' = −kx: up to which step the solution falls without changing its sign (S11: 1/k for explicit Euler).
  void find_monotone(StabilityLimit& limit) const {
    const double lambda = spectrum_.modes.front().eigenvalues.empty()
                              ? 0.0
                              : spectrum_.modes.front().eigenvalues.front().real();
    if (!(lambda < 0.0) || !growth_.factor_of_decay(first_step * unit() * lambda)) return;
    constexpr double far = 100.0;
    constexpr std::int64_t steps = 50;
    limit.monotone_predicted = analysis::largest_stable_step(
        [&](double step) { return *growth_.factor_of_decay(step * lambda) >= 0.0; },
        {.first = first_step * unit(), .ratio = 1.01, .farthest = far * unit(), .resolution = 1e-9});
    limit.monotone_observed = analysis::largest_stable_step(
        [&](double step) {
          context_.check();
          return !analysis::changes_sign(*method_.integrator, system_, step, steps);
        },
        {.first = first_step * unit(), .ratio = 1.1, .farthest = far * unit(), .resolution = 1e-6});
  }

  const Ivp& ivp_;
  const StabilityMethod& method_;
  const SchemeGrowth& growth_;
  const LimitSettings& settings_;
  const RunContext& context_;
  const ProblemSpectrum& spectrum_;
  std::shared_ptr<const OdeSystem> system_;
  bool original_has_springs_;
};

}  // namespace

StabilityLimit measure_limit(const StabilityProblem& problem, const StabilityMethod& method,
                             const SchemeGrowth& growth, const LimitSettings& settings,
                             const RunContext& context) {
  return LimitMeasurement(problem, method, growth, settings, context).run();
}

}  // namespace fw::study
