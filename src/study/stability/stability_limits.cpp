#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/fit/power_law.hpp"
#include "core/special_values.hpp"
#include "study/stability/stability_cases.hpp"

namespace fw::study {

namespace {

using analysis::SchemeGrowth;

/// A case of a family.
class LimitCase {
 public:
  LimitCase(const StabilityFamily& family, const StabilityMethod& method, const LimitSettings& settings,
            const RunContext& context)
      : family_(family), method_(method), settings_(settings), context_(context) {}

  CaseResult run() {
    const SchemeGrowth growth(method_.integrator, method_.linear);
    row_.basis = to_string(growth.basis());
    is_by_steps_ = growth.basis() == analysis::GrowthBasis::single_steps;
    for (const std::shared_ptr<const StabilityProblem>& member : family_.members)
      limits_.push_back(measure_limit(*member, method_, growth, settings_, context_));
    row_.part = is_family() ? "law" : "limit";
    row_.problem = family_.label;
    row_.method = method_.call;
    judge();
    add_columns();
    result_.summary = cells_of(row_);
    return std::move(result_);
  }

 private:
  bool is_family() const { return !family_.parameter.empty(); }
  bool is_linear(std::size_t k) const { return family_.members[k]->spectrum(settings_, context_).is_linear; }

  static bool agrees(double predicted, double observed, double tolerance) {
    if (std::isinf(predicted) || std::isinf(observed)) return predicted == observed;
    if (predicted == 0.0) return observed == 0.0;
    return std::abs(observed / predicted - 1.0) <= tolerance;
  }

  /// Whether theory holds for one member of a linear family, and the finding as a clause.
  bool holds(const StabilityLimit& limit, std::string& text) const {
    bool good = true;
    if (limit.is_confirmed_by_growth) {
      good = limit.growth_ratios.size() == 2;
      text = limit.predicted == 0.0 ? "predicted unstable at every step"
                                    : fmt::format("predicted {:.5g} s", limit.predicted);
      if (limit.predicted > 0.0 && !std::isnan(limit.observed)) {
        good = good && agrees(limit.predicted, limit.observed, settings_.tolerance);
        text += fmt::format(", observed {:.5g} s in the critical mode, ratio {:.4f}", limit.observed,
                            limit.ratio());
      } else if (limit.predicted > 0.0) {
        text += ", too weak growth beyond for a threshold";
      }
      text += "; measured/predicted growth";
      for (const double ratio : limit.growth_ratios) {
        good = good && std::abs(ratio - 1.0) <= settings_.tolerance;
        text += fmt::format(" {:.4f}", ratio);
      }
      if (limit.growth_ratios.size() != 2) text += " at too few steps";
    } else if (std::isnan(limit.predicted)) {
      text =
          std::isinf(limit.observed) ? "no limit observed" : fmt::format("observed {:.5g} s", limit.observed);
    } else if (std::isinf(limit.predicted)) {
      good = agrees(limit.predicted, limit.observed, settings_.tolerance);
      text = std::isinf(limit.observed)
                 ? fmt::format("no limit up to {:g}/|λ|, as predicted", settings_.farthest)
                 : fmt::format("no limit predicted, unstable beyond {:.5g} s", limit.observed);
    } else {
      good = agrees(limit.predicted, limit.observed, settings_.tolerance);
      text = fmt::format("predicted {:.5g} s, observed {:.5g} s, ratio {:.4f}", limit.predicted,
                         limit.observed, limit.ratio());
    }
    if (!good && !limit.failed_run.empty()) text += fmt::format(" ({})", limit.failed_run);
    if (!std::isnan(limit.monotone_predicted)) {
      good = good && agrees(limit.monotone_predicted, limit.monotone_observed, settings_.tolerance);
      text += std::isinf(limit.monotone_predicted)
                  ? fmt::format("; never changes sign{}",
                                std::isinf(limit.monotone_observed) ? "" : " by R, but does in the run")
                  : fmt::format("; changes sign beyond {:.5g} s, predicted {:.5g} s", limit.monotone_observed,
                                limit.monotone_predicted);
    }
    return good;
  }

  void judge() {
    for (std::size_t k = 0; k < limits_.size(); ++k) {
      if (limits_[k].failure.empty()) continue;
      result_.reason = limits_[k].failure;
      return;
    }
    std::string reason;
    bool all_hold = true, is_theory = true, is_decided = true;
    double largest = 0.0;
    for (std::size_t k = 0; k < limits_.size(); ++k) {
      const StabilityLimit& limit = limits_[k];
      std::string text;
      is_theory = is_theory && is_linear(k) && !std::isnan(limit.predicted);
      all_hold = holds(limit, text) && all_hold;
      if (!is_family()) reason = text;
      if (limit.predicted > 0.0 && !std::isnan(limit.ratio()))
        largest = std::max(largest, std::abs(limit.ratio() - 1.0));
      for (const double ratio : limit.growth_ratios) largest = std::max(largest, std::abs(ratio - 1.0));
    }
    row_.largest_deviation = largest;
    if (is_family()) {
      reason = fmt::format("largest deviation of observed from predicted limits {:.2g}", largest);
      const analysis::LawJudgement law = fit_laws(reason);
      all_hold = all_hold && law != analysis::LawJudgement::refuted;
      if (law == analysis::LawJudgement::open) {
        reason += "; the exponent is not decided";
        is_decided = false;
      }
    } else {
      fill_single(limits_.front());
    }
    if (is_theory && is_by_steps_) {
      result_.reason = fmt::format(
          "no coefficients to predict from; the steps {} their own spectrum (largest deviation {:.2g}): {}",
          all_hold ? "agree with" : "DISAGREE with", largest, reason);
      return;
    }
    result_.reason = is_theory ? reason
                     : std::isnan(limits_.front().predicted)
                         ? method_.integrator->info().needs.has(Capability::springs)
                               ? "no prediction: the method needs springs, the linear part along the "
                                 "solution has none; " +
                                     reason
                               : "no prediction for this scheme on this problem; " + reason
                         : "nonlinear, prediction from J along the solution; " + reason;
    if (is_theory && (is_decided || !all_hold)) result_.verdict = all_hold ? Verdict::holds : Verdict::fails;
  }

  void fill_single(const StabilityLimit& limit) {
    row_.spectral_radius = family_.members.front()->spectrum(settings_, context_).spectral_radius;
    row_.predicted = limit.predicted;
    row_.observed = limit.observed;
    row_.ratio = limit.ratio();
    row_.monotone_predicted = limit.monotone_predicted;
    row_.monotone_observed = limit.monotone_observed;
  }

  /// Fits limit ∝ |parameter|^p to predictions and observations: whether theory's p is met. Where there is no
  /// law, or no theory, nothing is said against it.
  analysis::LawJudgement fit_laws(std::string& reason) {
    using analysis::LawJudgement;
    std::vector<double> x, predicted, observed;
    for (std::size_t k = 0; k < limits_.size(); ++k) {
      x.push_back(std::abs(family_.values[k]));
      predicted.push_back(limits_[k].predicted);
      observed.push_back(limits_[k].observed);
    }
    row_.expected_exponent = family_.exponent;
    const auto fit = [&](const char* what, const std::vector<double>& limit, double& exponent, double& low,
                         double& high) {
      const analysis::PowerLaw law = analysis::fit_power_law(x, limit);
      if (!law.valid) {
        reason += fmt::format("; no law of {} limits ({})", what, law.reason);
        return LawJudgement::supported;  // nothing depends on the parameter: no limit, or none above 0
      }
      exponent = law.exponent;
      low = law.exponent_low;
      high = law.exponent_high;
      reason += fmt::format("; {} exponent {:.4f} [{:.4f}, {:.4f}]", what, exponent, low, high);
      if (std::isnan(family_.exponent)) return LawJudgement::supported;
      return analysis::judge_exponent(law, family_.exponent, settings_.exponent_tolerance);
    };
    const LawJudgement of_predicted = fit("predicted", predicted, row_.predicted_exponent,
                                          row_.predicted_exponent_low, row_.predicted_exponent_high);
    const LawJudgement of_observed = fit("observed", observed, row_.observed_exponent,
                                         row_.observed_exponent_low, row_.observed_exponent_high);
    if (!std::isnan(family_.exponent)) reason += fmt::format(", in theory {:g}", family_.exponent);
    for (const LawJudgement judgement : {LawJudgement::refuted, LawJudgement::open}) {
      if (of_predicted == judgement || of_observed == judgement) return judgement;
    }
    return LawJudgement::supported;
  }

  void add_columns() {
    std::vector<double> radius, predicted, observed, ratio, monotone_predicted, monotone_observed;
    std::vector<std::int64_t> steps;
    for (std::size_t k = 0; k < limits_.size(); ++k) {
      radius.push_back(family_.members[k]->spectrum(settings_, context_).spectral_radius);
      predicted.push_back(limits_[k].predicted);
      observed.push_back(limits_[k].observed);
      ratio.push_back(limits_[k].ratio());
      monotone_predicted.push_back(limits_[k].monotone_predicted);
      monotone_observed.push_back(limits_[k].monotone_observed);
      steps.push_back(limits_[k].steps);
    }
    std::vector<std::pair<std::string, std::string>> varied;
    result_.columns = {
        {"parameter", "SI", family_.values, {}, {{"name", is_family() ? family_.parameter : "none"}}},
        {"spectral_radius", "1/s", radius, {}, {}},
        {"predicted_limit", "s", predicted, {}, {}},
        {"observed_limit", "s", observed, {}, {}},
        {"ratio", "1", ratio, {}, {}},
        {"monotone_predicted", "s", monotone_predicted, {}, {}},
        {"monotone_observed", "s", monotone_observed, {}, {}},
        {"steps", "1", steps, {}, {}},
    };
    if (is_family()) return;
    const ProblemSpectrum& spectrum = family_.members.front()->spectrum(settings_, context_);
    std::vector<double> real, imaginary, time;
    for (std::size_t k = 0; k < spectrum.modes.size(); ++k) {
      for (const Complex& lambda : spectrum.modes[k].eigenvalues) {
        time.push_back(spectrum.times[k]);
        real.push_back(lambda.real());
        imaginary.push_back(lambda.imag());
      }
    }
    result_.columns.push_back({"eigenvalue_time", "s", time, {}, {}});
    result_.columns.push_back({"eigenvalue_real", "1/s", real, {}, {}});
    result_.columns.push_back({"eigenvalue_imaginary", "1/s", imaginary, {}, {}});
    if (const std::string& scene = family_.members.front()->entry().scene_toml; !scene.empty())
      result_.columns.push_back({"scene", "", std::vector<std::string>{scene}, {}, {}});
  }

  const StabilityFamily& family_;
  const StabilityMethod& method_;
  const LimitSettings& settings_;
  const RunContext& context_;
  std::vector<StabilityLimit> limits_;
  StabilityRow row_;
  bool is_by_steps_ = false;
  CaseResult result_;
};

}  // namespace

CaseResult run_limit_case(const StabilityFamily& family, const StabilityMethod& method,
                          const LimitSettings& settings, const RunContext& context) {
  return LimitCase(family, method, settings, context).run();
}

}  // namespace fw::study
