#include "study/propagation/propagation.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "analysis/fit/binned_series.hpp"
#include "analysis/theory/influence_front.hpp"
#include "core/error.hpp"
#include "study/propagation/disturbed_network.hpp"

namespace fw::study {

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// The keys of [propagation].
struct Settings {
  std::vector<double> steps;     ///< h [s]
  std::int64_t step_count = 60;  ///< of every run
  double duration = 0.0;         ///< in place of it [s]; 0: none
  std::int64_t mass = -1;        ///< the one that is disturbed; −1: the middle one
  bool kick = true;              ///< a velocity, else a displacement
  double size = 1.0;             ///< of it [m/s] or [m]
  Vec3<double> direction{1.0, 0.0, 0.0};
  double threshold = 1e-3;        ///< of the largest displacement so far, for the front that can be seen
  double speed_tolerance = 0.02;  ///< of the speed of the wave, relative

  std::int64_t steps_of(double step) const {
    return duration > 0.0 ? std::max<std::int64_t>(2, std::llround(duration / step)) : step_count;
  }

  std::string text() const {
    return fmt::format(
        "steps = {}\nstep_count = {}\nduration = {}\nmass = {}\nkick = {}\nsize = {}\ndirection = {} {} "
        "{}\nthreshold = {}\n"
        "speed_tolerance = {}\n",
        fmt::join(steps, ", "), step_count, duration, mass, kick, size, direction.x, direction.y, direction.z,
        threshold, speed_tolerance);
  }
};

/// ∫₀ⁿ J_n(x) dx → 1/3: where a kick's displacement has reached a third of its final value, there the front
/// is that travels at the speed of long waves [Watson 1944, 8.43].
constexpr double wave_level = 1.0 / 3.0;

/// Records displacements and fronts of every step.
class FrontObserver final : public Observer {
 public:
  FrontObserver(const DisturbedNetwork& network, double threshold, double plateau, const RunContext& context)
      : network_(network), threshold_(threshold), plateau_(plateau), context_(context) {}

  bool observe(const StepView& view) override {
    const Index n = network_.rest.size(), c = network_.coordinates;
    const Vector displacement = view.state.head(n) - network_.rest;
    const auto velocity = view.state.tail(n);
    largest_ = std::max(largest_, displacement.cwiseAbs().maxCoeff());
    analysis::InfluenceFront front;
    int seen = -1;
    for (Index i = 0; i < network_.masses(); ++i) {
      const int distance = network_.distance[static_cast<std::size_t>(i)];
      const double size = displacement.segment(c * i, c).norm();
      displacements.push_back(c == 1 ? displacement[i] : size);
      // An unreachable mass that moves counts as farther than all others: no theory allows it.
      const int where = distance >= 0 ? distance : network_.farthest + 1;
      if ((displacement.segment(c * i, c).array() != 0.0).any())
        front.position = std::max(front.position, where);
      if ((velocity.segment(c * i, c).array() != 0.0).any()) front.velocity = std::max(front.velocity, where);
      if (size > threshold_ * largest_ && size > 0.0) seen = std::max(seen, where);
    }
    times.push_back(view.time);
    fronts.push_back(front);
    visible.push_back(seen);
    waves.push_back(wave_front(displacement));
    return !context_.is_interrupted();
  }

  std::vector<double> times, displacements, waves;
  std::vector<analysis::InfluenceFront> fronts;
  std::vector<std::int64_t> visible;

 private:
  /// In a chain, where the displacement falls below the wave's level, between masses by interpolation.
  double wave_front(const Vector& u) const {
    if (std::isnan(plateau_)) return none;
    const double level = wave_level * plateau_;
    for (Index i = u.size() - 2; i >= network_.disturbed; --i) {
      if (u[i] >= level && u[i + 1] < level) {
        return static_cast<double>(i - network_.disturbed) + (u[i] - level) / (u[i] - u[i + 1]);
      }
    }
    return none;
  }

  const DisturbedNetwork& network_;
  double threshold_, plateau_;
  const RunContext& context_;
  double largest_ = 0.0;
};

class PropagationCase {
 public:
  PropagationCase(const DisturbedNetwork& network, const std::string& call, const Integrator& integrator,
                  const schemes::SchemeData& data, double step, const Settings& settings,
                  const RunContext& context)
      : network_(network),
        call_(call),
        integrator_(integrator),
        step_(step),
        settings_(settings),
        context_(context),
        // Of a kick in an endless chain every mass ends up displaced by v/(2ω).
        seen_(network, settings.threshold,
              network.is_kicked ? 0.5 * settings.size / network.wave_speed : none, context) {
    const analysis::InfluenceFront start =
        network.is_kicked ? analysis::InfluenceFront{-1, 0} : analysis::InfluenceFront{0, -1};
    predicted_ = analysis::predict_fronts(data, start, network.farthest,
                                          static_cast<std::uint64_t>(settings.steps_of(step)));
    if (!integrator.info().is_explicit) predicted_ = {.known = true, .whole_system = true, .fronts = {}};
  }

  CaseResult run() {
    Ivp ivp = network_.ivp;
    ivp.t1 = ivp.t0 + step_ * static_cast<double>(settings_.steps_of(step_));
    solution_ = integrator_.solve(ivp, FixedStep{.step = step_}, seen_);
    if (context_.is_interrupted()) throw Interrupted{};
    fit_speed();
    CaseResult result;
    judge(result);
    add_columns(result);
    add_summary(result);
    return result;
  }

 private:
  /// Springs per step until the farthest mass is reached, from the second step on: the first ones depend on
  /// whether positions or velocities were disturbed.
  double springs_per_step(int analysis::InfluenceFront::*front) const {
    const auto& fronts = seen_.fronts;
    std::size_t last = 0;
    while (last + 1 < fronts.size() && fronts[last].*front < network_.farthest) ++last;
    // Where the last step was cut short by the end of the network, the one before.
    const std::size_t first = std::min<std::size_t>(2, last / 2);
    if (last == 0) return none;
    std::size_t end = last;
    if (fronts[end].*front == network_.farthest && end > first + 1) --end;
    // A whole number of steps in which the front moves on, so that halves come out as halves.
    if ((end - first) % 2 == 1 && end > first + 1) --end;
    if (end == first) return fronts[last].*front / static_cast<double>(last);
    return (fronts[end].*front - fronts[first].*front) / static_cast<double>(end - first);
  }

  /// The speed of the wave between 30 % and 90 % of the way to the end.
  void fit_speed() {
    std::vector<double> times, fronts;
    for (std::size_t k = 0; k < seen_.waves.size(); ++k) {
      const double way = seen_.waves[k] / network_.farthest;
      if (way > 0.9) break;  // soon it is reflected
      if (!(way >= 0.3)) continue;
      times.push_back(seen_.times[k]);
      fronts.push_back(seen_.waves[k]);
    }
    if (times.size() < 5) return;
    analysis::BinnedSeries series(times.size(), 1);
    for (std::size_t k = 0; k < times.size(); ++k) series.add(times[k], fronts[k]);
    speed_ = series.slope();
  }

  void judge(CaseResult& result) const {
    const MethodInfo& info = integrator_.info();
    std::vector<std::string> texts;
    bool applies = false, holds = true;
    const auto require = [&](bool fine, std::string text) {
      applies = true;
      holds = holds && fine;
      texts.push_back(fine ? std::move(text) : "FAILS: " + text);
    };
    const double velocity_rate = springs_per_step(&analysis::InfluenceFront::velocity);
    if (!solution_.status.ok()) {
      require(false, solution_.status.describe());
    } else if (predicted_.known && predicted_.whole_system) {
      judge_implicit(require, texts);
    } else if (predicted_.known) {
      std::size_t differing = 0, where = 0;
      for (std::size_t n = seen_.fronts.size(); n-- > 0;) {
        if (seen_.fronts[n] == predicted_.fronts[n]) continue;
        ++differing;
        where = n;
      }
      require(
          differing == 0,
          differing == 0
              ? fmt::format("{:.3g} springs per step, front as predicted at each of {} steps", velocity_rate,
                            seen_.fronts.size() - 1)
              : fmt::format(
                    "{:.3g} springs per step; after step {} velocities are {} springs away and positions {}, "
                    "predicted {} and {}",
                    velocity_rate, where, seen_.fronts[where].velocity, seen_.fronts[where].position,
                    predicted_.fronts[where].velocity, predicted_.fronts[where].position));
    } else {
      texts.push_back(fmt::format("{:.3g} springs per step; no stages to predict from", velocity_rate));
    }
    if (std::isfinite(speed_)) {
      const double off = speed_ / network_.wave_speed - 1.0;
      const std::string text = fmt::format("wave at {:.4g} springs/s, physically {:.4g} ({:+.2f} %)", speed_,
                                           network_.wave_speed, 100.0 * off);
      // Schemes of order 1 damp or amplify the front, which moves its level.
      if (info.order >= 2 && step_ * network_.wave_speed <= 0.5) {
        require(std::abs(off) <= settings_.speed_tolerance, text);
      } else {
        texts.push_back(text);
      }
    }
    result.verdict = !applies ? Verdict::not_applicable : holds ? Verdict::holds : Verdict::fails;
    result.reason = fmt::format("{}", fmt::join(texts, "; "));
  }

  template <class Require>
  void judge_implicit(Require& require, std::vector<std::string>& texts) const {
    const analysis::InfluenceFront& first = seen_.fronts[1];
    const std::string found = fmt::format("after one step velocities {} and positions {} of {} springs away",
                                          first.velocity, first.position, network_.farthest);
    const bool whole = first.velocity == network_.farthest && first.position == network_.farthest;
    // An iteration moves on by one spring, and it stops at its tolerance.
    if (solution_.work.linear_iterations > 0 && !whole) {
      texts.push_back(fmt::format(
          "{}: the iterative solver stops at its tolerance, after {:.1f} iterations per step", found,
          static_cast<double>(solution_.work.linear_iterations) /
              static_cast<double>(settings_.steps_of(step_))));
    } else {
      require(whole, found);
    }
  }

  void add_columns(CaseResult& result) const {
    std::vector<std::int64_t> position, velocity, predicted_position, predicted_velocity;
    for (std::size_t n = 0; n < seen_.fronts.size(); ++n) {
      position.push_back(seen_.fronts[n].position);
      velocity.push_back(seen_.fronts[n].velocity);
      if (predicted_.fronts.empty()) continue;
      predicted_position.push_back(predicted_.fronts[n].position);
      predicted_velocity.push_back(predicted_.fronts[n].velocity);
    }
    std::vector<std::int64_t> distance(network_.distance.begin(), network_.distance.end());
    const auto masses = static_cast<std::uint64_t>(network_.masses());
    result.columns = {{"time", "s", seen_.times, {}, {}},
                      {"distance", "1", distance, {}, {}},
                      {"displacement", "m", seen_.displacements, {seen_.times.size(), masses}, {}},
                      {"front_position", "1", position, {}, {}},
                      {"front_velocity", "1", velocity, {}, {}},
                      {"front_visible", "1", seen_.visible, {}, {}},
                      {"front_wave", "1", seen_.waves, {}, {}}};
    if (!predicted_.fronts.empty()) {
      result.columns.push_back({"predicted_position", "1", predicted_position, {}, {}});
      result.columns.push_back({"predicted_velocity", "1", predicted_velocity, {}, {}});
    }
  }

  void add_summary(CaseResult& result) const {
    const auto& fronts = seen_.fronts;
    result.summary = {
        {"problem", "", network_.label},
        {"method", "", call_},
        {"step", "s", step_},
        {"farthest", "1", static_cast<std::int64_t>(network_.farthest)},
        {"springs_per_step", "1", springs_per_step(&analysis::InfluenceFront::velocity)},
        {"first_step_velocity", "1", static_cast<std::int64_t>(fronts.size() > 1 ? fronts[1].velocity : -1)},
        {"first_step_position", "1", static_cast<std::int64_t>(fronts.size() > 1 ? fronts[1].position : -1)},
        {"wave_springs_per_step", "1", step_ * network_.wave_speed},
        {"wave_speed", "1/s", speed_},
        {"physical_wave_speed", "1/s", network_.wave_speed},
        {"verdict", "", std::string(to_string(result.verdict))},
        {"reason", "", result.reason}};
  }

  const DisturbedNetwork& network_;
  const std::string& call_;
  const Integrator& integrator_;
  double step_;
  const Settings& settings_;
  const RunContext& context_;
  FrontObserver seen_;
  analysis::PredictedFronts predicted_;
  Solution solution_;
  double speed_ = none;
};

Settings read_settings(const CheckedTable& spec, bool quick) {
  Settings settings;
  const CheckedTable table = spec.table("propagation");
  settings.steps = table.numbers("steps", NumberRule::positive);
  if (settings.steps.empty()) table.fail("steps", "found an empty list, expected at least one step");
  settings.step_count = table.integer_or("step_count", settings.step_count, 2, 100'000);
  settings.duration = table.number_or("duration", settings.duration, NumberRule::nonnegative);
  settings.mass = table.integer_or("mass", settings.mass, -1);
  settings.kick = table.choice_or("disturbance", "velocity", {"velocity", "position"}) == "velocity";
  settings.size = table.number_or("size", settings.size, NumberRule::positive);
  settings.direction = table.vec3_or("direction", settings.direction);
  if (norm(settings.direction) == 0.0) table.fail("direction", "found the zero vector, expected a direction");
  settings.threshold = table.number_or("threshold", settings.threshold, NumberRule::positive);
  settings.speed_tolerance =
      table.number_or("speed_tolerance", settings.speed_tolerance, NumberRule::positive);
  const std::int64_t quick_count =
      spec.table_or_empty("quick").integer_or("step_count", settings.step_count, 2, 100'000);
  if (quick) settings.step_count = quick_count;
  for (std::size_t k = 0; k < settings.steps.size(); ++k) {
    if (settings.duration / settings.steps[k] > 1e5) {
      table.fail("duration", fmt::format("found {}, expected at most 100 000 steps of {}", settings.duration,
                                         settings.steps[k]));
    }
  }
  return settings;
}

/// Displacements that a case keeps: (steps + 1) × masses.
constexpr double most_displacements = 5e7;

void require_fitting(const CheckedTable& spec, const Settings& settings, const DisturbedNetwork& network) {
  const auto masses = static_cast<double>(network.masses());
  for (const double step : settings.steps) {
    const auto states = static_cast<double>(settings.steps_of(step) + 1);
    if (states * masses <= most_displacements) continue;
    spec.table("propagation")
        .fail(
            settings.duration > 0.0 ? "duration" : "step_count",
            fmt::format("found {:.0f} states of the {:.0f} masses of problem \"{}\", expected at most {:.0f} "
                        "displacements in a case",
                        states, masses, network.label, most_displacements));
  }
}

void read_propagation(const CheckedTable& spec, const Catalog& catalog, bool quick, Plan& plan) {
  const Settings settings = read_settings(spec, quick);
  const std::vector<std::string> methods = read_methods(spec, catalog);
  for (const StudyProblem& entry : read_problems(spec, catalog, plan.warnings)) {
    std::shared_ptr<const DisturbedNetwork> network;
    try {
      network = std::make_shared<const DisturbedNetwork>(
          disturb(entry, settings.mass, settings.kick, settings.size, settings.direction));
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: {}", spec.source_name(), error.what()));
    }
    require_fitting(spec, settings, *network);
    for (std::size_t i = 0; i < methods.size(); ++i) {
      const std::string& call = methods[i];
      const std::shared_ptr<const Integrator> integrator = catalog.method(call);
      std::string why = why_not_applicable(integrator->info(), *network->ivp.system);
      if (!integrator->info().has_fixed_step)
        why = "it chooses its own steps, expected a method with a fixed step";
      if (!why.empty()) {
        spec.fail("methods", {i}, fmt::format("\"{}\" (problem \"{}\"): {}", call, network->label, why));
      }
      for (const double step : settings.steps) {
        plan.cases.push_back(
            {.id = group_name(fmt::format("{}-{}-h{}", network->label, call, step)),
             .identity = fmt::format("propagation\n{}method = {}\nstep = {}\n{}", network->identity, call,
                                     step, settings.text()),
             .run = [network, call, integrator, data = catalog.theory(call).on_position_forces, step,
                     settings](const RunContext& context) {
               return PropagationCase(*network, call, *integrator, data, step, settings, context).run();
             }});
      }
    }
  }
}

}  // namespace

StudyKind propagation_kind() {
  return {.name = "propagation",
          .title = "Propagation of a disturbance",
          .description = "springs that a disturbance travels per step, against stages and the speed of waves",
          .read = read_propagation};
}

}  // namespace fw::study
