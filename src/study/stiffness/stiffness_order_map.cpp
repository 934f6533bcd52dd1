#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/fit/order_fit.hpp"
#include "analysis/theory/stiff_order.hpp"
#include "analysis/theory/stiffness_measures.hpp"
#include "core/special_values.hpp"
#include "study/measure/error_meter.hpp"
#include "study/stiffness/stiffness_cases.hpp"

namespace fw::study {

namespace {

/// Local slopes in a fit differ from the finest ones by no more.
constexpr double slope_tolerance = 0.1;
/// Where local errors add up undamped, the steps must be this much fewer than those that would add up.
constexpr double accumulation_margin = 10.0;

/// One member: errors at every step.
struct MapRow {
  double largest_eigenvalue = no_value;
  double floor = 0.0;
  std::vector<double> errors;
  std::vector<char> used;  ///< in one of the two fits
};

class OrderMap {
 public:
  OrderMap(const StiffnessFamily& family, const StiffnessMethod& method, const StiffnessSettings& settings,
           const RunContext& context)
      : family_(family), method_(method), settings_(settings), context_(context) {
    const Ivp& ivp = family.members.front()->ivp();
    for (std::int64_t k = 0; k < settings.map_levels; ++k) {
      steps_.push_back((ivp.t1 - ivp.t0) / static_cast<double>(settings.fewest_steps << k));
    }
  }

  CaseResult run() {
    const std::string why = why_not_applicable(info(), *family_.members.front()->ivp().system);
    if (!why.empty()) return conclude(Verdict::not_applicable, why);
    for (const auto& member : family_.members) {
      const ErrorMeter meter(*member, context_);
      if (!meter.status().ok()) return conclude(Verdict::not_applicable, meter.status().describe());
      rows_.push_back(measure(*member, meter));
    }
    fit_nonstiff();
    fit_stiff();
    return judge();
  }

 private:
  const MethodInfo& info() const { return method_.integrator->info(); }

  MapRow measure(const SharedProblem& member, const ErrorMeter& meter) const {
    MapRow row;
    const Ivp& ivp = member.ivp();
    row.largest_eigenvalue = analysis::stiffness_measures(*ivp.system, ivp.t0, ivp.y0).largest_eigenvalue;
    row.floor = meter.floor();
    row.used.assign(steps_.size(), 0);
    for (const double step : steps_) {
      const Solution solution = run_once(*method_.integrator, ivp,
                                         FixedStep{.step = step, .allow_short_last_step = false}, context_);
      const double error = solution.status.ok() ? meter.error(solution.state) : no_value;
      row.errors.push_back(std::isfinite(error) ? error : no_value);
    }
    return row;
  }

  /// The order of one row over the steps with lowest ≤ h|λ| ≤ highest and at most `most_steps` steps.
  analysis::OrderFit fit_row(MapRow& row, double lowest, double highest) const {
    std::vector<double> steps, errors;
    std::vector<std::size_t> index;
    for (std::size_t k = 0; k < steps_.size(); ++k) {
      const double product = steps_[k] * row.largest_eigenvalue;
      if (product < lowest || product > highest) continue;
      steps.push_back(steps_[k]);
      errors.push_back(row.errors[k]);
      index.push_back(k);
    }
    analysis::OrderFit fit = analysis::fit_order(steps, errors, row.floor, slope_tolerance);
    for (std::size_t k = 0; fit.valid && k < index.size(); ++k) {
      if (fit.used[k] != 0) row.used[index[k]] = 1;
    }
    return fit;
  }

  /// Rows by rising stiffness.
  std::vector<std::size_t> by_stiffness() const {
    std::vector<std::size_t> order(rows_.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
    std::stable_sort(order.begin(), order.end(), [this](std::size_t i, std::size_t j) {
      return rows_[i].largest_eigenvalue < rows_[j].largest_eigenvalue;
    });
    return order;
  }

  /// On the least stiff row alone: on others, steps with small h|λ| may be few or not asymptotic.
  void fit_nonstiff() { nonstiff_ = fit_row(rows_[by_stiffness().front()], 0.0, settings_.nonstiff_product); }

  /// The stiffest row with enough points above the floor (or why the stiffest has not); the theory for the
  /// steps that it used.
  void fit_stiff() {
    if (info().is_explicit && !info().is_a_stable) {
      prediction_.reason = "the scheme is explicit";
      return;  // there is no convergence outside the stability interval
    }
    std::vector<std::size_t> order = by_stiffness();
    std::reverse(order.begin(), order.end());
    for (const std::size_t k : order) {
      MapRow& row = rows_[k];
      double lowest = settings_.stiff_product;
      if (family_.is_prothero_robinson) {
        prediction_ = analysis::stiff_order(method_.data, middle_step(row), -row.largest_eigenvalue);
        if (prediction_.valid && prediction_.accumulates) {
          // N = T/h steps against the memory·h|λ| that would add up: h|λ| ≥ √(margin T|λ|/memory).
          const double length = steps_.front() * static_cast<double>(settings_.fewest_steps);
          lowest = std::max(
              lowest, std::sqrt(accumulation_margin * length * row.largest_eigenvalue / prediction_.memory));
        }
      }
      analysis::OrderFit fit = fit_row(row, lowest, std::numeric_limits<double>::infinity());
      const bool is_first = k == order.front();
      if (is_first || fit.valid) stiff_ = std::move(fit);
      if (stiff_.valid) {
        stiff_value_ = family_.values[k];
        if (family_.is_prothero_robinson) predict_over(row);
        return;
      }
    }
  }

  /// The prediction for the steps of the fit: valid if the same term leads at the coarsest and the finest.
  void predict_over(const MapRow& row) {
    std::vector<double> used;
    for (std::size_t k = 0; k < steps_.size(); ++k) {
      const bool is_stiff = steps_[k] * row.largest_eigenvalue >= settings_.stiff_product;
      if (row.used[k] != 0 && is_stiff) used.push_back(steps_[k]);
    }
    const analysis::StiffOrder coarse =
        analysis::stiff_order(method_.data, used.front(), -row.largest_eigenvalue);
    prediction_ = analysis::stiff_order(method_.data, used.back(), -row.largest_eigenvalue);
    if (!coarse.valid) {
      prediction_ = coarse;
    } else if (prediction_.valid && prediction_.power_of_step != coarse.power_of_step) {
      prediction_.valid = false;
      prediction_.reason = "another term of the local error leads at small steps than at large ones";
    }
  }

  /// The geometric mean of the steps that are stiff and above the floor.
  double middle_step(const MapRow& row) const {
    double sum = 0.0;
    int count = 0;
    for (std::size_t k = 0; k < steps_.size(); ++k) {
      if (steps_[k] * row.largest_eigenvalue < settings_.stiff_product || !(row.errors[k] > row.floor))
        continue;
      sum += std::log(steps_[k]);
      ++count;
    }
    return count > 0 ? std::exp(sum / count) : steps_.front();
  }

  CaseResult judge() const {
    bool predicted = false, holds = true;
    std::string reason;
    const auto say = [&reason](const std::string& text) { reason += (reason.empty() ? "" : "; ") + text; };
    const auto check = [&](const analysis::OrderFit& fit, int order) {
      predicted = true;
      holds = holds && std::abs(fit.order - order) <= settings_.order_tolerance;
    };
    if (nonstiff_.valid) {
      say(fmt::format("not stiff: order {:.3f} [{:.3f}, {:.3f}], predicted {}", nonstiff_.order,
                      nonstiff_.order_low, nonstiff_.order_high, classical_order()));
      check(nonstiff_, classical_order());
    } else {
      say("not stiff: " + nonstiff_.reason);
    }
    if (stiff_.valid) {
      say(fmt::format("stiff ({} = {:g}): order {:.3f} [{:.3f}, {:.3f}]", family_.parameter, stiff_value_,
                      stiff_.order, stiff_.order_low, stiff_.order_high));
      if (prediction_.valid) {
        reason += fmt::format(", predicted {} (error ~ {})", prediction_.order, prediction_.formula());
        check(stiff_, prediction_.order);
      } else if (family_.is_prothero_robinson) {
        reason += ", no prediction: " + prediction_.reason;
      }
    } else {
      say("stiff: " + (stiff_.reason.empty() ? prediction_.reason : stiff_.reason));
    }
    if (!predicted) return conclude(Verdict::not_applicable, reason);
    return conclude(holds ? Verdict::holds : Verdict::fails, reason);
  }

  int classical_order() const { return order_on(info(), *family_.members.front()->ivp().system); }

  CaseResult conclude(Verdict verdict, std::string reason) const {
    StiffnessRow row{.problem = family_.label,
                     .method = method_.call,
                     .measure = measures_orders,
                     .stepping = info().is_explicit ? "explicit" : "implicit",
                     .parameter = family_.parameter,
                     .classical_order = classical_order()};
    row.points = nonstiff_.points + stiff_.points;
    const auto figure = [](const analysis::OrderFit& fit) -> StiffnessRow::Figure {
      if (!fit.valid) return {};
      return {fit.order, fit.order_low, fit.order_high};
    };
    row.nonstiff_order = figure(nonstiff_);
    row.stiff_order = figure(stiff_);
    if (prediction_.valid) row.predicted_stiff_order = prediction_.order;
    return case_result(verdict, std::move(reason), columns(), row);
  }

  std::vector<Column> columns() const {
    std::vector<double> parameter, eigenvalue, errors, orders, products;
    std::vector<std::int64_t> used;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const MapRow& row = rows_[i];
      parameter.push_back(family_.values[i]);
      eigenvalue.push_back(row.largest_eigenvalue);
      for (std::size_t k = 0; k < steps_.size(); ++k) {
        errors.push_back(row.errors[k]);
        const bool has_slope = k > 0 && row.errors[k] > row.floor && row.errors[k - 1] > row.floor;
        orders.push_back(has_slope ? std::log2(row.errors[k - 1] / row.errors[k]) : no_value);
        products.push_back(steps_[k] * row.largest_eigenvalue);
        used.push_back(row.used[k]);
      }
    }
    const std::vector<std::uint64_t> shape{rows_.size(), steps_.size()};
    return {{"parameter", "SI", parameter, {}, {{"name", family_.parameter}}},
            {"largest_eigenvalue", "1/s", eigenvalue, {}, {}},
            {"step", "s", steps_, {}, {}},
            {"map_error", "1", errors, shape, {}},
            {"local_order", "1", orders, shape, {}},
            {"stiffness_product", "1", products, shape, {}},
            {"used", "1", used, shape, {}}};
  }

  const StiffnessFamily& family_;
  const StiffnessMethod& method_;
  const StiffnessSettings& settings_;
  const RunContext& context_;
  std::vector<double> steps_;
  std::vector<MapRow> rows_;
  analysis::OrderFit nonstiff_, stiff_;
  analysis::StiffOrder prediction_;
  double stiff_value_ = no_value;
};

}  // namespace

CaseResult run_order_map(const StiffnessFamily& family, const StiffnessMethod& method,
                         const StiffnessSettings& settings, const RunContext& context) {
  return OrderMap(family, method, settings, context).run();
}

}  // namespace fw::study
