#include "study/propagation/propagation_case.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "analysis/fit/binned_series.hpp"
#include "analysis/theory/influence_front.hpp"
#include "core/special_values.hpp"

namespace fw::study {

namespace {

/// ∫₀ⁿ J_n(x) dx → 1/3: where a kick's displacement has reached a third of its final value, there the front
/// is that travels at the speed of long waves [Watson 1944, 8.43].
constexpr double wave_level = 1.0 / 3.0;

/// Records displacements and fronts of every step.
class FrontObserver final : public Observer {
 public:
  FrontObserver(const DisturbedNetwork& network, double threshold, double plateau)
      : network_(network), threshold_(threshold), plateau_(plateau) {}

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
    return true;
  }

  std::vector<double> times, displacements, waves;
  std::vector<analysis::InfluenceFront> fronts;
  std::vector<std::int64_t> visible;

 private:
  /// In a chain, where the displacement falls below the wave's level, between masses by interpolation.
  double wave_front(const Vector& u) const {
    if (std::isnan(plateau_)) return no_value;
    const double level = wave_level * plateau_;
    for (Index i = u.size() - 2; i >= network_.disturbed; --i) {
      if (u[i] >= level && u[i + 1] < level) {
        return static_cast<double>(i - network_.disturbed) + (u[i] - level) / (u[i] - u[i + 1]);
      }
    }
    return no_value;
  }

  const DisturbedNetwork& network_;
  double threshold_, plateau_;
  double largest_ = 0.0;
};

class PropagationCase {
 public:
  PropagationCase(const DisturbedNetwork& network, const std::string& call, const Integrator& integrator,
                  const schemes::SchemeData& data, double step, const PropagationSettings& settings,
                  const RunContext& context)
      : network_(network),
        call_(call),
        integrator_(integrator),
        step_(step),
        settings_(settings),
        context_(context),
        // Of a kick in an endless chain every mass ends up displaced by v/(2ω).
        seen_(network, settings.threshold,
              network.is_kicked ? 0.5 * settings.size / network.wave_speed : no_value) {
    const analysis::InfluenceFront start =
        network.is_kicked ? analysis::InfluenceFront{-1, 0} : analysis::InfluenceFront{0, -1};
    predicted_ =
        analysis::predict_fronts(data, start, network.farthest,
                                 static_cast<std::uint64_t>(settings.steps_of(step)), network.has_dampers);
    if (!integrator.info().is_explicit) predicted_ = {.known = true, .whole_system = true, .fronts = {}};
  }

  CaseResult run() {
    Ivp ivp = network_.ivp;
    ivp.t1 = ivp.t0 + step_ * static_cast<double>(settings_.steps_of(step_));
    solution_ = context_.solve(integrator_, ivp, FixedStep{.step = step_}, seen_);
    fit_speed();
    const auto [verdict, reason] = judge();
    return case_result(verdict, reason, columns(), row());
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
    if (last == 0) return no_value;
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

  std::pair<Verdict, std::string> judge() const {
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
      std::size_t differing = 0, where = 0, lost = 0;
      for (std::size_t n = seen_.fronts.size(); n-- > 0;) {
        const analysis::InfluenceFront &front = seen_.fronts[n], &predicted = predicted_.fronts[n];
        if (front == predicted) continue;
        // Of a scene's coordinates the smallest displacements are lost, of velocities that start from 0 none.
        if (network_.coordinates == 3 && front.velocity == predicted.velocity &&
            front.position < predicted.position) {
          ++lost;
          continue;
        }
        ++differing;
        where = n;
      }
      if (differing == 0 && lost > 0) {
        texts.push_back(fmt::format(
            "{:.3g} springs per step; velocities are where they are predicted, displacements at {} of {} "
            "steps not yet: below the last digit of a position they are lost, larger steps or fewer show "
            "them",
            velocity_rate, lost, seen_.fronts.size() - 1));
      } else {
        require(differing == 0,
                differing == 0
                    ? fmt::format("{:.3g} springs per step, front as predicted at each of {} steps",
                                  velocity_rate, seen_.fronts.size() - 1)
                    : fmt::format("{:.3g} springs per step; after step {} velocities are {} springs away and "
                                  "positions {}, predicted {} and {}",
                                  velocity_rate, where, seen_.fronts[where].velocity,
                                  seen_.fronts[where].position, predicted_.fronts[where].velocity,
                                  predicted_.fronts[where].position));
      }
    } else {
      texts.push_back(fmt::format("{:.3g} springs per step; {}", velocity_rate,
                                  network_.has_dampers
                                      ? "no prediction: the coefficients do not tell how dampers enter"
                                      : "no stages to predict from"));
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
    const Verdict verdict = !applies ? Verdict::not_applicable : holds ? Verdict::holds : Verdict::fails;
    return {verdict, fmt::format("{}", fmt::join(texts, "; "))};
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

  std::vector<Column> columns() const {
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
    std::vector<Column> columns = {
        {"time", "s", seen_.times, {}, {}},
        {"distance", "1", distance, {}, {}},
        {"displacement", "m", seen_.displacements, {seen_.times.size(), masses}, {}},
        {"front_position", "1", position, {}, {}},
        {"front_velocity", "1", velocity, {}, {}},
        {"front_visible", "1", seen_.visible, {}, {}},
        {"front_wave", "1", seen_.waves, {}, {}}};
    if (!predicted_.fronts.empty()) {
      columns.push_back({"predicted_position", "1", predicted_position, {}, {}});
      columns.push_back({"predicted_velocity", "1", predicted_velocity, {}, {}});
    }
    return columns;
  }

  PropagationRow row() const {
    const auto& fronts = seen_.fronts;
    return {.problem = network_.label,
            .method = call_,
            .step = step_,
            .farthest = network_.farthest,
            .springs_per_step = springs_per_step(&analysis::InfluenceFront::velocity),
            .first_step_velocity = fronts.size() > 1 ? fronts[1].velocity : -1,
            .first_step_position = fronts.size() > 1 ? fronts[1].position : -1,
            .wave_springs_per_step = step_ * network_.wave_speed,
            .wave_speed = speed_,
            .physical_wave_speed = network_.wave_speed};
  }

  const DisturbedNetwork& network_;
  const std::string& call_;
  const Integrator& integrator_;
  double step_;
  const PropagationSettings& settings_;
  const RunContext& context_;
  FrontObserver seen_;
  analysis::PredictedFronts predicted_;
  Solution solution_;
  double speed_ = no_value;
};

}  // namespace

std::int64_t PropagationSettings::steps_of(double step) const {
  return duration > 0.0 ? std::max<std::int64_t>(2, std::llround(duration / step)) : step_count;
}

void declare(settings::Archive& a, PropagationSettings& s) {
  using settings::choice;
  using settings::setting;
  a(setting("steps", s.steps).unit("s").required().not_empty().positive().doc("h; a case each"));
  a(setting("step_count", s.step_count)
        .integers(2, 100'000)
        .quick()
        .doc("steps of every run; a case keeps (steps + 1) · masses displacements, at most 50 000 000"));
  a(setting("duration", s.duration)
        .unit("s")
        .nonnegative()
        .doc("in place of `step_count`: every run lasts about so long; 0: not so"));
  a(setting("mass", s.mass).at_least(-1).doc("index of the one that is disturbed; −1: the middle one"));
  a(choice("disturbance", s.kick, {{"velocity", true}, {"position", false}})
        .doc("what it is given at the start"));
  a(setting("size", s.size).unit("m/s or m").positive().doc("of the disturbance"));
  a(setting("direction", s.direction).doc("of it in a scene; a chain moves along itself"));
  a(setting("threshold", s.threshold)
        .unit("1")
        .positive()
        .doc("of the largest displacement so far, for the front that can be seen"));
  a(setting("speed_tolerance", s.speed_tolerance)
        .unit("1")
        .positive()
        .doc("relative, of the speed of the wave"));
}

void declare(SummaryRow& a, const PropagationRow& row) {
  a("problem", "", row.problem, "its label");
  a("method", "", row.method, "as in the study, with settings");
  a("step", "s", row.step, "h");
  a("farthest", "1", row.farthest, "largest distance");
  a("springs_per_step", "1", row.springs_per_step, "of the velocities' front until it reaches the end");
  a("first_step_velocity", "1", row.first_step_velocity, "front of the velocities after one step");
  a("first_step_position", "1", row.first_step_position, "of the positions");
  a("wave_springs_per_step", "1", row.wave_springs_per_step, "√(k/m) h; NaN in scenes");
  a("wave_speed", "1/s", row.wave_speed, "springs per second, fitted; NaN where it cannot be");
  a("physical_wave_speed", "1/s", row.physical_wave_speed, "√(k/m); NaN in scenes");
}

CaseResult run_propagation(const DisturbedNetwork& network, const std::string& call,
                           const Integrator& integrator, const schemes::SchemeData& data, double step,
                           const PropagationSettings& settings, const RunContext& context) {
  return PropagationCase(network, call, integrator, data, step, settings, context).run();
}

}  // namespace fw::study
