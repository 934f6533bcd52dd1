#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <numbers>

#include "analysis/theory/stability_limit.hpp"
#include "analysis/verification/verification.hpp"
#include "core/special_values.hpp"
#include "schemes/multistep_properties.hpp"
#include "study/stability/stability_cases.hpp"

namespace fw::study {

namespace {

using analysis::GrowthBasis;
using analysis::SchemeGrowth;

double at(double from, double to, std::int64_t k, std::int64_t count) {
  return from + (to - from) * static_cast<double>(k) / static_cast<double>(count - 1);
}

/// The length of the interval of stability along an axis, from growth alone.
double interval(const std::function<double(double)>& growth) {
  constexpr double rounding = 1e-9;
  const double first = 0.01;
  if (std::isnan(growth(first))) return no_value;
  return analysis::largest_stable_step([&](double x) { return growth(x) <= 1.0 + rounding; },
                                       {.first = first, .ratio = 1.02, .farthest = 1e4, .resolution = 1e-6});
}

void add_grid(const SchemeGrowth& growth, const RegionSettings& settings, const RunContext& context,
              CaseResult& result) {
  const std::int64_t n = settings.points;
  std::vector<double> real, imaginary, size, star;
  for (std::int64_t k = 0; k < n; ++k) {
    real.push_back(at(settings.real_from, settings.real_to, k, n));
    imaginary.push_back(at(settings.imaginary_from, settings.imaginary_to, k, n));
  }
  for (const double y : imaginary) {
    context.check();
    for (const double x : real) {
      const double factor = growth.of_eigenvalue({x, y});
      size.push_back(factor);
      star.push_back(factor * std::exp(-x));
    }
  }
  const auto points = static_cast<std::uint64_t>(n);
  result.columns.push_back({"z_real", "1", real, {}, {}});
  result.columns.push_back({"z_imaginary", "1", imaginary, {}, {}});
  result.columns.push_back({"growth", "1", size, {points, points}, {}});
  result.columns.push_back({"order_star", "1", star, {points, points}, {}});
}

void add_axes(const SchemeGrowth& growth, const RegionSettings& settings, CaseResult& result) {
  constexpr std::int64_t count = 401;
  const double farthest = std::max(std::abs(settings.real_from), settings.imaginary_to);
  std::vector<double> distance, on_real_axis, on_imaginary_axis;
  for (std::int64_t k = 0; k < count; ++k) {
    distance.push_back(at(0.0, farthest, k, count));
    on_real_axis.push_back(growth.of_eigenvalue({-distance.back(), 0.0}));
    on_imaginary_axis.push_back(growth.of_eigenvalue({0.0, distance.back()}));
  }
  result.columns.push_back({"distance", "1", distance, {}, {}});
  result.columns.push_back({"growth_real_axis", "1", on_real_axis, {}, {}});
  result.columns.push_back({"growth_imaginary_axis", "1", on_imaginary_axis, {}, {}});
}

/// μ(θ) = ρ(e^{iθ})/σ(e^{iθ}), on which a root has modulus 1.
void add_root_locus(const schemes::MultistepFormula& formula, CaseResult& result) {
  constexpr std::int64_t count = 721;
  std::vector<double> real, imaginary;
  for (std::int64_t k = 0; k < count; ++k) {
    const Complex zeta = std::polar(1.0, at(0.0, 2.0 * std::numbers::pi, k, count));
    Complex rho = 0.0, sigma = 0.0;
    for (std::size_t j = formula.alpha.size(); j-- > 0;) {
      rho = rho * zeta + schemes::as<double>(formula.alpha[j]);
      sigma = sigma * zeta + schemes::as<double>(formula.beta[j]);
    }
    const bool is_pole = std::abs(sigma) < 1e-12;
    real.push_back(is_pole ? no_value : (rho / sigma).real());
    imaginary.push_back(is_pole ? no_value : (rho / sigma).imag());
  }
  result.columns.push_back({"locus_real", "1", real, {}, {}});
  result.columns.push_back({"locus_imaginary", "1", imaginary, {}, {}});
}

void fill_numbers(const StabilityMethod& method, const SchemeGrowth& growth, StabilityRow& row) {
  if (growth.stability_function()) {
    const schemes::LinearStability stability = schemes::linear_stability(*growth.stability_function());
    row.real_interval = stability.real_interval;
    row.imaginary_interval = growth.grows_at_every_step() ? 0.0 : stability.imaginary_interval;
    row.angle = stability.alpha_degrees;
    row.at_infinity = stability.at_infinity;
    return;
  }
  row.real_interval = interval([&](double x) { return growth.of_eigenvalue({-x, 0.0}); });
  row.imaginary_interval = growth.grows_at_every_step() ? 0.0 : interval([&](double y) {
    return growth.of_eigenvalue({0.0, y});
  });
  if (const auto* formula = std::get_if<schemes::MultistepFormula>(&method.data)) {
    row.angle = schemes::stability_angle(*formula);
    constexpr double far = -1e12;
    const bool is_explicit = formula->beta.back().value() == 0;
    row.at_infinity =
        is_explicit ? std::numeric_limits<double>::infinity() : growth.of_eigenvalue({far, 0.0});
  }
}

/// What the running code makes of the coefficients and of what is claimed.
void judge(const StabilityMethod& method, CaseResult& result) {
  std::vector<analysis::PropertyCheck> checks;
  const analysis::SchemeUnderTest scheme{*method.integrator, method.data};
  analysis::verify_stability_function(scheme, checks);
  analysis::verify_stability_limits(scheme, checks);
  std::vector<std::string> found;
  for (const analysis::PropertyCheck& check : checks) {
    if (check.verdict == Verdict::not_applicable) continue;
    const bool fails = check.verdict == Verdict::fails;
    if (fails) result.verdict = Verdict::fails;
    if (!fails && result.verdict == Verdict::not_applicable) result.verdict = Verdict::holds;
    found.push_back(fmt::format("{}: {}{}{}", check.property, check.measured,
                                check.derived.empty() ? "" : ", predicted " + check.derived,
                                fails ? " (" + check.reason + ")" : ""));
  }
  result.reason = found.empty() ? "neither coefficients nor claims to hold the running code against"
                                : fmt::format("{}", fmt::join(found, "; "));
}

}  // namespace

CaseResult run_region_case(const StabilityMethod& method, const RegionSettings& settings,
                           const RunContext& context) {
  CaseResult result;
  StabilityRow row;
  const SchemeGrowth growth(method.integrator, method.linear);
  row.part = "region";
  row.method = method.call;
  row.basis = to_string(growth.basis());
  fill_numbers(method, growth, row);
  context.check();
  judge(method, result);
  add_grid(growth, settings, context, result);
  add_axes(growth, settings, result);
  if (const auto* formula = std::get_if<schemes::MultistepFormula>(&method.data))
    add_root_locus(*formula, result);
  result.summary = cells_of(row);
  return result;
}

}  // namespace fw::study
