#include "study/kinds/dissipation_case.hpp"
#include "core/special_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace fw::study {

namespace {

/// A fit with a larger relative residual saw more than one pair of factors.
constexpr double largest_residual = 1e-9;

/// Whether the parasitic factors have died out before the window, so that a run has to show the principal
/// one.
bool is_measurable(const analysis::NumericalOscillation& theory, std::int64_t transient_steps) {
  if (!theory.oscillates) return false;
  if (theory.parasitic_ratio == 0.0) return true;
  const double rate = std::abs(std::log(std::abs(theory.factor)));
  const double steps =
      std::min(static_cast<double>(transient_steps), std::log(1e30) / std::max(rate, 1e-300));
  return steps * std::log(theory.parasitic_ratio) < std::log(1e-12);
}

class Motion final : public Observer {
 public:
  bool observe(const StepView& view) override {
    times.push_back(view.time);
    positions.push_back(view.state[0]);
    return std::isfinite(view.state[0]) && std::abs(view.state[0]) < 1e12;
  }
  std::vector<double> times, positions;
};

class DissipationCase {
 public:
  DissipationCase(const std::string& call, const Integrator& integrator,
                  const analysis::AmplificationFactors& theory, const Problem& spring,
                  const DissipationSettings& settings, const RunContext& context)
      : call_(call),
        integrator_(integrator),
        factors_(theory),
        spring_(spring),
        settings_(settings),
        context_(context) {}

  CaseResult run() {
    predict();
    measure();
    judge();
    return case_result(verdict_, reason_, columns(), row());
  }

 private:
  analysis::OscillationRun oscillation_run() const {
    return {.periods = settings_.periods,
            .transient_steps = static_cast<int>(settings_.transient_steps),
            .stop = context_.stop};
  }

  void predict() {
    z_ = settings_.grid();
    if (!factors_) return;
    theory_ = analysis::numerical_oscillations(factors_, z_);
    shown_theory_ = analysis::numerical_oscillations(factors_, {settings_.shown()}).front();
    radius_at_infinity_ = analysis::spectral_radius_at_infinity(factors_);
    radius_far_out_ = analysis::spectral_radius(factors_, settings_.infinity);
  }

  void measure() {
    double phase = 0.0, before = 0.0;
    for (const double z : z_) {
      analysis::MeasuredOscillation found = analysis::measure_oscillation(
          integrator_, settings_.mass, settings_.stiffness, z, oscillation_run());
      context_.check();
      if (!found.status.ok() && status_.ok()) status_ = found.status;
      if (!(found.residual <= largest_residual)) found.points = 0;
      measured_.push_back(found);
      // The angle per step is known up to its sign and whole turns: the nearest to where it should have gone.
      phase =
          found.points == 0 ? no_value : unwrapped(found.angle, std::isnan(phase) ? z : phase + (z - before));
      phases_.push_back(phase);
      before = z;
    }
    shown_measured_ = analysis::measure_oscillation(integrator_, settings_.mass, settings_.stiffness,
                                                    settings_.shown(), oscillation_run());
    if (std::isfinite(radius_at_infinity_)) {
      measured_radius_at_infinity_ = analysis::measure_radius_at_infinity(
          integrator_, settings_.mass, settings_.stiffness, settings_.infinity, oscillation_run());
    }
    follow_motion();
    context_.check();
  }

  static double unwrapped(double angle, double expected) {
    constexpr double turn = 2.0 * std::numbers::pi;
    const auto next_to = [&](double a) { return a + turn * std::round((expected - a) / turn); };
    const double plus = next_to(angle), minus = next_to(-angle);
    return std::abs(plus - expected) <= std::abs(minus - expected) ? plus : minus;
  }

  void follow_motion() {
    const double omega = std::sqrt(settings_.stiffness / settings_.mass);
    const double h = settings_.shown() / omega;
    Ivp ivp = spring_.ivp;
    ivp.t1 = ivp.t0 + std::round(settings_.shown_periods * settings_.shown_steps_per_period) * h;
    context_.solve(integrator_, ivp, FixedStep{.step = h}, motion_);
    for (const double t : motion_.times) {
      context_.check();
      exact_positions_.push_back(static_cast<double>(spring_.exact(Float128(t)).front()));
    }
  }

  void judge() {
    std::size_t due = 0, compared = 0;
    double worst_z = no_value;
    for (std::size_t k = 0; k < theory_.size(); ++k) {
      if (!is_measurable(theory_[k], settings_.transient_steps)) continue;
      ++due;
      if (measured_[k].points == 0) continue;
      ++compared;
      const Complex expected(theory_[k].factor.real(), std::abs(theory_[k].factor.imag()));
      const double difference = std::abs(measured_[k].factor - expected) / std::max(1.0, std::abs(expected));
      if (std::isnan(worst_z) || !(difference <= largest_difference_)) {
        largest_difference_ = difference;
        worst_z = z_[k];
      }
    }
    compared_ = static_cast<std::int64_t>(compared);
    std::string findings =
        fmt::format("at {:.0f} steps per period the damping ratio is {:.3g}, the period off by {:.3g} %",
                    settings_.shown_steps_per_period, shown_damping(), 100.0 * shown_period_error());
    if (!factors_) {
      judge_without_theory(findings);
      return;
    }
    const bool all = due > 0 && compared == due;
    const bool agrees = all && largest_difference_ <= settings_.tolerance;
    const bool infinity_agrees = !std::isfinite(radius_at_infinity_) ||
                                 std::abs(measured_radius_at_infinity_ - radius_far_out_) <= radius_tolerance;
    verdict_ = agrees && infinity_agrees ? Verdict::holds : Verdict::fails;
    if (due == 0) {
      reason_ = "theory predicts no oscillation that could be measured";
      verdict_ = Verdict::not_applicable;
      return;
    }
    reason_ =
        fmt::format("factor per step as predicted within {:.1e} at {} of {} steps, worst at wh = {:.3g}",
                    largest_difference_, compared, due, worst_z);
    if (std::isfinite(radius_at_infinity_)) {
      reason_ += fmt::format("; radius at wh = {:g} is {:.4f}, predicted {:.4f}", settings_.infinity,
                             measured_radius_at_infinity_, radius_far_out_);
    }
    if (!status_.ok() && compared < due) reason_ += "; " + status_.describe();
    reason_ += "; " + findings;
  }

  /// A symplectic scheme does not damp: its factors lie on the unit circle while they are complex.
  void judge_without_theory(const std::string& findings) {
    if (!integrator_.info().is_symplectic) {
      reason_ = "no coefficients to predict from; " + findings;
      return;
    }
    double worst = 0.0;
    for (const analysis::MeasuredOscillation& found : measured_) {
      if (found.points == 0 || !found.oscillates) continue;
      worst = std::max(worst, std::abs(found.spectral_radius - 1.0));
      ++compared_;
    }
    largest_difference_ = worst;
    verdict_ = compared_ > 0 && worst <= settings_.tolerance ? Verdict::holds : Verdict::fails;
    reason_ = fmt::format("symplectic: modulus 1 per step within {:.1e} at {} steps; {}", worst, compared_,
                          findings);
  }

  double shown_damping() const {
    return factors_ ? shown_theory_.damping_ratio()
                    : -std::log(shown_measured_.spectral_radius) / shown_measured_.angle;
  }
  double shown_period_error() const {
    return factors_ ? shown_theory_.period_error(settings_.shown())
                    : settings_.shown() / shown_measured_.angle - 1.0;
  }

  std::vector<Column> columns() const {
    std::vector<double> per_period, damping, period, radius, measured_damping, measured_period,
        measured_radius, residual;
    for (std::size_t k = 0; k < z_.size(); ++k) {
      per_period.push_back(2.0 * std::numbers::pi / z_[k]);
      const bool known = k < theory_.size();
      damping.push_back(known ? theory_[k].damping_ratio() : no_value);
      period.push_back(known ? theory_[k].period_error(z_[k]) : no_value);
      radius.push_back(known ? theory_[k].spectral_radius : no_value);
      const analysis::MeasuredOscillation& found = measured_[k];
      const bool fitted = found.points > 0;
      const bool swings = fitted && found.oscillates;
      measured_damping.push_back(swings ? -std::log(found.spectral_radius) / phases_[k] : no_value);
      measured_period.push_back(swings ? z_[k] / phases_[k] - 1.0 : no_value);
      measured_radius.push_back(fitted ? found.spectral_radius : no_value);
      residual.push_back(found.residual);
    }
    return {{"frequency_step", "1", z_, {}, {}},
            {"steps_per_period", "1", per_period, {}, {}},
            {"damping_ratio", "1", damping, {}, {}},
            {"period_error", "1", period, {}, {}},
            {"spectral_radius", "1", radius, {}, {}},
            {"measured_damping_ratio", "1", measured_damping, {}, {}},
            {"measured_period_error", "1", measured_period, {}, {}},
            {"measured_radius", "1", measured_radius, {}, {}},
            {"fit_residual", "1", residual, {}, {}},
            {"motion_time", "s", motion_.times, {}, {}},
            {"motion_position", "m", motion_.positions, {}, {}},
            {"motion_exact", "m", exact_positions_, {}, {}}};
  }

  DissipationRow row() const {
    return {.method = call_,
            .steps_per_period = settings_.shown_steps_per_period,
            .damping_ratio = shown_damping(),
            .period_error = shown_period_error(),
            .radius_at_infinity = radius_at_infinity_,
            .measured_radius_at_infinity = measured_radius_at_infinity_,
            .largest_difference = largest_difference_,
            .compared = compared_};
  }

  /// Where factors coincide, their growth per step is approached like a power of the number of steps.
  static constexpr double radius_tolerance = 5e-3;

  const std::string& call_;
  const Integrator& integrator_;
  const analysis::AmplificationFactors& factors_;
  const Problem& spring_;
  const DissipationSettings& settings_;
  const RunContext& context_;
  std::vector<double> z_, phases_;
  std::vector<analysis::NumericalOscillation> theory_;
  analysis::NumericalOscillation shown_theory_;
  std::vector<analysis::MeasuredOscillation> measured_;
  analysis::MeasuredOscillation shown_measured_;
  double radius_at_infinity_ = no_value, radius_far_out_ = no_value, measured_radius_at_infinity_ = no_value,
         largest_difference_ = no_value;
  std::int64_t compared_ = 0;
  Motion motion_;
  std::vector<double> exact_positions_;
  Status status_;
  Verdict verdict_ = Verdict::not_applicable;
  std::string reason_;
};

}  // namespace

std::vector<double> DissipationSettings::grid() const {
  std::vector<double> z;
  for (std::int64_t k = 0; k < count; ++k) {
    z.push_back(from * std::pow(to / from, static_cast<double>(k) / static_cast<double>(count - 1)));
  }
  return z;
}

double DissipationSettings::shown() const {
  return 2.0 * std::numbers::pi / shown_steps_per_period;
}

void declare(settings::Archive& a, DissipationSettings& s) {
  using settings::setting;
  a(setting("mass", s.mass).unit("kg").positive().doc("of the spring's particle"));
  a(setting("stiffness", s.stiffness).unit("N/m").positive().doc("of the spring"));
  a(setting("from", s.from).unit("1").at_least_number(1e-3).doc("smallest z = ωh"));
  a(setting("to", s.to).unit("1").positive().doc("largest z"));
  a(setting("count", s.count)
        .integers(3, 10'000)
        .quick_at_most(13)
        .doc("values of z, in a geometric sequence"));
  a(setting("periods", s.periods)
        .unit("1")
        .positive()
        .doc("of the exact oscillation in a fit; at least 32 steps, at most 1 000 000 at the finest step"));
  a(setting("transient_steps", s.transient_steps).integers(0, 100'000).doc("before the fit"));
  a(setting("shown_steps_per_period", s.shown_steps_per_period)
        .unit("1")
        .positive()
        .doc("of the motion that is stored, and of the figures in the summary"));
  a(setting("shown_periods", s.shown_periods)
        .unit("1")
        .positive()
        .doc("length of that motion, at most 100 000 steps"));
  a(setting("infinity", s.infinity).unit("1").positive().doc("the ωh at which ρ(∞) is measured"));
  a(setting("tolerance", s.tolerance)
        .unit("1")
        .positive()
        .doc("largest \\|λ_measured − λ\\|/max(1, \\|λ\\|) that holds"));
}

void declare(SummaryRow& a, const DissipationRow& row) {
  a("method", "", row.method, "as in the study, with settings");
  a("steps_per_period", "1", row.steps_per_period, "at which the next two figures are given");
  a("damping_ratio", "1", row.damping_ratio, "by theory, of the run where there is none");
  a("period_error", "1", row.period_error, "likewise");
  a("radius_at_infinity", "1", row.radius_at_infinity,
    "limit of the spectral radius; inf if it grows, NaN without theory");
  a("measured_radius_at_infinity", "1", row.measured_radius_at_infinity,
    "of a run; NaN where the limit is not finite");
  a("largest_difference", "1", row.largest_difference,
    "of the measured factor from the predicted one; of symplectic foreign solvers of its modulus from 1");
  a("compared", "1", row.compared, "values of ωh");
}

CaseResult run_dissipation(const std::string& call, const Integrator& integrator,
                           const analysis::AmplificationFactors& theory, const Problem& spring,
                           const DissipationSettings& settings, const RunContext& context) {
  return DissipationCase(call, integrator, theory, spring, settings, context).run();
}

}  // namespace fw::study
