#include "study/jacobian/jacobian_derivatives.hpp"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/fit/power_law.hpp"
#include "analysis/theory/numerical_jacobian.hpp"
#include "core/special_values.hpp"
#include "study/jacobian/jacobian_row.hpp"
#include "study/jacobian/printed_stiffness.hpp"

namespace fw::study {

namespace {

using analysis::Difference;
using analysis::PowerLaw;

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// What is compared: K and D of M q̈ = f, or the whole Jacobian as K, with an empty D.
struct Derivatives {
  Matrix K, D;
};

Derivatives parts_of(const OdeSystem& system, const Matrix& J) {
  const SecondOrderSystem* mechanics = system.second_order();
  if (mechanics == nullptr) return {J, Matrix()};
  const Index n = mechanics->degrees_of_freedom();
  const auto mass = mechanics->mass().asDiagonal();
  return {mass * J.bottomLeftCorner(n, n), mass * J.bottomRightCorner(n, n)};
}

Derivatives assembled(const JacobianSample& sample) {
  const SecondOrderSystem* mechanics = sample.system->second_order();
  if (mechanics == nullptr)
    return {analysis::analytic_jacobian(*sample.system, sample.time, sample.state), {}};
  const Index n = mechanics->degrees_of_freedom();
  SparseMatrix K = mechanics->tangent_pattern(), D = K;
  mechanics->stiffness(sample.time, sample.state.head(n), sample.state.tail(n), TangentModel::exact, K);
  mechanics->damping(sample.time, sample.state.head(n), sample.state.tail(n), D);
  return {K, D};
}

Derivatives by_complex_steps(const JacobianSample& sample) {
  return parts_of(*sample.system, analysis::complex_step_jacobian(*sample.system, sample.time, sample.state));
}

/// Largest deviation over the largest entry of the oracle; absolute where that is zero, NaN where empty.
double relative_deviation(const Matrix& found, const Matrix& oracle) {
  if (oracle.size() == 0) return no_value;
  const double scale = oracle.cwiseAbs().maxCoeff();
  const double deviation = (found - oracle).cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
  return scale > 0.0 ? deviation / scale : deviation;
}

double largest(const std::vector<double>& values) {
  return values.empty() ? no_value : *std::max_element(values.begin(), values.end());
}

double smallest(const std::vector<double>& values) {
  return values.empty() ? no_value : *std::min_element(values.begin(), values.end());
}

void run_analytic(const std::vector<JacobianSample>& samples, const DerivativeSettings& settings,
                  const RunContext& context, JacobianRow& row, CaseResult& result) {
  std::vector<double> deviation, deviation_damping, difference;
  for (const JacobianSample& sample : samples) {
    context.check();
    const Derivatives oracle = by_complex_steps(sample), found = assembled(sample);
    deviation.push_back(relative_deviation(found.K, oracle.K));
    deviation_damping.push_back(relative_deviation(found.D, oracle.D));
    difference.push_back((found.K - oracle.K).cwiseAbs().maxCoeff());
  }
  row.deviation = largest(deviation);
  row.least_deviation = smallest(deviation);
  row.deviation_damping = largest(deviation_damping);
  row.largest_difference = largest(difference);
  const bool damping_holds = std::isnan(row.deviation_damping) || row.deviation_damping <= settings.tolerance;
  result.verdict = row.deviation <= settings.tolerance && damping_holds ? Verdict::holds : Verdict::fails;
  result.reason = fmt::format(
      "deviates from complex steps by at most {:.1e}{}, allowed {:.0e}", row.deviation,
      std::isnan(row.deviation_damping) ? std::string()
                                        : fmt::format(" (K) and {:.1e} (D)", row.deviation_damping),
      settings.tolerance);
  result.columns = {{"deviation", "1", deviation, {}, {}},
                    {"deviation_damping", "1", deviation_damping, {}, {}},
                    {"largest_difference", "SI", difference, {}, {}}};
}

/// The printed formulas are for single, undamped Hooke springs.
void run_printed(const std::vector<JacobianSample>& samples, Erratum erratum, const RunContext& context,
                 JacobianRow& row, CaseResult& result) {
  std::vector<double> deviation, difference, measured, predicted;
  double largest_disagreement = 0.0;
  for (const JacobianSample& sample : samples) {
    context.check();
    const auto& model = dynamic_cast<const mechanics::MassSpringSystem&>(*sample.system).model();
    const Matrix oracle = by_complex_steps(sample).K;
    const Matrix wrong = printed_stiffness(model, sample.state.head(6), erratum) - oracle;
    deviation.push_back(wrong.cwiseAbs().maxCoeff() / oracle.cwiseAbs().maxCoeff());
    difference.push_back(wrong.cwiseAbs().maxCoeff());
    const Eigen::Matrix3d block = erratum == Erratum::e1 ? wrong.block<3, 3>(0, 0) : wrong.block<3, 3>(3, 0);
    measured.push_back(Eigen::JacobiSVD<Eigen::Matrix3d>(block).singularValues()[0]);
    const double length = (sample.state.segment<3>(3) - sample.state.segment<3>(0)).norm();
    predicted.push_back(
        printed_error(model.springs.stiffness[0], model.springs.rest_length[0], length, erratum));
    largest_disagreement = std::max(largest_disagreement, std::abs(measured.back() / predicted.back() - 1.0));
  }
  row.deviation = largest(deviation);
  row.least_deviation = smallest(deviation);
  row.largest_difference = largest(difference);
  row.predicted_difference = largest(predicted);
  result.verdict = largest_disagreement <= 1e-9 ? Verdict::holds : Verdict::fails;
  result.reason = fmt::format(
      "as printed K is wrong by {:.0f} % to {:.0f} % of its largest entry (at most {:.3g} N/m), and by what "
      "the mistake predicts, {}, to {:.0e}",
      100.0 * row.least_deviation, 100.0 * row.deviation, row.largest_difference,
      erratum == Erratum::e1 ? "3 k l0/L in K_ii" : "2 k max(1, |1 - l0/L|) in K_ji",
      std::max(largest_disagreement, epsilon));
  result.columns = {{"deviation", "1", deviation, {}, {}},
                    {"largest_difference", "SI", difference, {}, {}},
                    {"block_difference", "N/m", measured, {}, {}},
                    {"predicted_difference", "N/m", predicted, {}, {}}};
}

std::vector<double> increments(const DerivativeSettings& settings) {
  const double decades = std::log10(settings.largest_increment / settings.smallest_increment);
  const auto count =
      static_cast<std::int64_t>(std::llround(decades * static_cast<double>(settings.per_decade)));
  std::vector<double> values;
  for (std::int64_t k = 0; k <= count; ++k) {
    values.push_back(settings.largest_increment *
                     std::pow(10.0, -static_cast<double>(k) / static_cast<double>(settings.per_decade)));
  }
  return values;
}

/// The law of the errors at increments in [low, high].
PowerLaw fit_between(const std::vector<double>& increment, const std::vector<double>& error, double low,
                     double high) {
  std::vector<double> x, y;
  for (std::size_t k = 0; k < increment.size(); ++k) {
    if (increment[k] < low || increment[k] > high || !std::isfinite(error[k])) continue;
    x.push_back(increment[k]);
    y.push_back(error[k]);
  }
  return analysis::fit_power_law(x, y);
}

/// The error over the increment: the geometric mean over the samples, in which single zeros do not count; NaN
/// where a sample's error is not finite, since a mean without it would tell less than the truth.
std::vector<double> error_curve(const std::vector<JacobianSample>& samples, Difference difference,
                                const std::vector<double>& increment, const RunContext& context) {
  std::vector<double> logarithms(increment.size(), 0.0), counts(increment.size(), 0.0);
  for (const JacobianSample& sample : samples) {
    const Matrix oracle = by_complex_steps(sample).K;
    const double length = typical_length(*sample.system);
    for (std::size_t k = 0; k < increment.size(); ++k) {
      context.check();
      const Matrix J = analysis::difference_jacobian(*sample.system, sample.time, sample.state,
                                                     increment[k] * length, difference);
      const double error = relative_deviation(parts_of(*sample.system, J).K, oracle);
      if (error == 0.0) continue;
      logarithms[k] += std::isfinite(error) ? std::log(error) : no_value;
      counts[k] += 1.0;
    }
  }
  std::vector<double> error;
  for (std::size_t k = 0; k < increment.size(); ++k) {
    error.push_back(counts[k] > 0.0 ? std::exp(logarithms[k] / counts[k]) : 0.0);
  }
  return error;
}

/// A truncation error that is no more than rounding: f is linear.
constexpr double linear_error = 1e-10;
/// Distance of the fitted points from the increment of the least error, where the other error is below a few
/// per cent; and the increments beyond which higher orders or the rounding of y + h show.
constexpr double distance = 10.0, largest_fitted = 1e-2, smallest_fitted = 1e-13;

void run_difference(const std::vector<JacobianSample>& samples, Difference difference,
                    const DerivativeSettings& settings, const RunContext& context, JacobianRow& row,
                    CaseResult& result) {
  const std::vector<double> increment = increments(settings);
  const std::vector<double> error = error_curve(samples, difference, increment, context);
  result.columns = {{"increment", "1", increment, {}, {}}, {"deviation", "1", error, {}, {}}};
  const auto known = std::find_if(error.begin(), error.end(), [](double e) { return std::isfinite(e); });
  if (known == error.end()) {
    result.reason = "no error is finite at any increment";
    return;
  }
  const auto coarsest = static_cast<std::size_t>(known - error.begin());
  std::size_t best = coarsest;
  row.deviation = error[coarsest];
  for (std::size_t k = coarsest; k < error.size(); ++k) {
    if (error[k] < error[best]) best = k;
    if (error[k] > row.deviation) row.deviation = error[k];
  }
  row.best_increment = increment[best];
  row.best_deviation = error[best];
  if (error[coarsest] <= linear_error) {
    result.reason =
        fmt::format("f is linear here: no truncation error (deviation {:.1e} at increment {:.0e})",
                    error[coarsest], increment[coarsest]);
    return;
  }
  const int order = difference == Difference::forward ? 1 : 2;
  const PowerLaw truncation = fit_between(increment, error, distance * row.best_increment, largest_fitted);
  const PowerLaw rounding = fit_between(increment, error, smallest_fitted, row.best_increment / distance);
  if (!truncation.valid || !rounding.valid) {
    result.verdict = Verdict::fails;
    result.reason =
        fmt::format("no slope can be fitted on both sides of the best increment {:.1e}", row.best_increment);
    return;
  }
  row.truncation_slope = truncation.exponent;
  row.rounding_slope = rounding.exponent;
  const double predicted = std::pow(epsilon, 1.0 / (order + 1));
  const bool slopes_hold = std::abs(truncation.exponent - order) <= settings.slope_tolerance &&
                           std::abs(rounding.exponent + 1.0) <= settings.slope_tolerance;
  const bool best_holds = std::abs(std::log10(row.best_increment / predicted)) <= 1.0;
  result.verdict = slopes_hold && best_holds ? Verdict::holds : Verdict::fails;
  result.reason = fmt::format(
      "slopes {:.3f} and {:.3f}, predicted {} and -1; least error {:.1e} at h = {:.1e} lengths, predicted "
      "near "
      "eps^(1/{}) = {:.1e}",
      truncation.exponent, rounding.exponent, order, row.best_deviation, row.best_increment, order + 1,
      predicted);
}

}  // namespace

const std::vector<std::string>& derivative_formulas() {
  static const std::vector<std::string> list = {"analytic", "forward", "central", "printed_e1", "printed_e2"};
  return list;
}

CaseResult run_derivative(const DerivativeSubject& subject, const std::string& formula,
                          const DerivativeSettings& settings, const RunContext& context) {
  const std::vector<JacobianSample> samples = subject.draw();
  JacobianRow row{.subject = subject.label, .part = "derivative", .variant = formula};
  row.unknowns = samples.front().state.size();
  row.samples = static_cast<std::int64_t>(samples.size());
  CaseResult result;
  if (formula == "analytic") run_analytic(samples, settings, context, row, result);
  if (formula == "printed_e1") run_printed(samples, Erratum::e1, context, row, result);
  if (formula == "printed_e2") run_printed(samples, Erratum::e2, context, row, result);
  if (formula == "forward") run_difference(samples, Difference::forward, settings, context, row, result);
  if (formula == "central") run_difference(samples, Difference::central, settings, context, row, result);
  result.summary = cells_of(row);
  return result;
}

CaseResult run_pattern(const DerivativeSubject& subject, const RunContext&) {
  const JacobianSample sample = subject.draw().front();
  const SecondOrderSystem* mechanics = sample.system->second_order();
  const SparseMatrix pattern =
      mechanics != nullptr ? mechanics->tangent_pattern() : sample.system->jacobian_pattern();
  const Derivatives oracle = by_complex_steps(sample);
  const Index block = mechanics != nullptr && pattern.cols() % 3 == 0 ? 3 : 1,
              blocks = pattern.cols() / block;

  // One entry per block that the pattern has or complex steps fill.
  Matrix in_pattern = Matrix::Zero(blocks, blocks), size = Matrix::Zero(blocks, blocks),
         damped = Matrix::Zero(blocks, blocks);
  for (Index column = 0; column < pattern.outerSize(); ++column) {
    for (SparseMatrix::InnerIterator entry(pattern, column); entry; ++entry) {
      in_pattern(entry.row() / block, column / block) += 1.0;
    }
  }
  for (Index column = 0; column < pattern.cols(); ++column) {
    for (Index row = 0; row < pattern.rows(); ++row) {
      double& largest_of_block = size(row / block, column / block);
      largest_of_block = std::max(largest_of_block, std::abs(oracle.K(row, column)));
      if (oracle.D.size() > 0 && oracle.D(row, column) != 0.0) damped(row / block, column / block) = 1.0;
    }
  }
  std::vector<std::int64_t> block_row, block_column;
  std::vector<double> largest_entry;
  std::int64_t missing = 0;
  for (Index column = 0; column < blocks; ++column) {
    for (Index row = 0; row < blocks; ++row) {
      const bool is_full = in_pattern(row, column) == static_cast<double>(block * block);
      const bool is_needed = size(row, column) != 0.0 || damped(row, column) != 0.0;
      if (is_needed && !is_full) ++missing;
      if (in_pattern(row, column) == 0.0 && !is_needed) continue;
      block_row.push_back(row);
      block_column.push_back(column);
      largest_entry.push_back(size(row, column));
    }
  }
  JacobianRow row{
      .subject = subject.label, .part = "pattern", .variant = block == 3 ? "3x3 blocks" : "entries"};
  row.unknowns = pattern.cols();
  row.samples = 1;
  row.entries = pattern.nonZeros();
  row.filled = static_cast<double>(pattern.nonZeros()) /
               (static_cast<double>(pattern.cols()) * static_cast<double>(pattern.cols()));
  CaseResult result;
  result.verdict = missing == 0 ? Verdict::holds : Verdict::fails;
  result.reason = fmt::format(
      "{} of {} x {} blocks of {} x {}, {:.0f} % of all entries; {} that complex steps "
      "fill are missing",
      block_row.size(), blocks, blocks, block, block, 100.0 * row.filled, missing);
  result.columns = {{"block_row", "1", block_row, {}, {}},
                    {"block_column", "1", block_column, {}, {}},
                    {"largest_entry", "SI", largest_entry, {}, {}}};
  result.summary = cells_of(row);
  return result;
}

}  // namespace fw::study
