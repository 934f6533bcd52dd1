#include "study/stiffness/stiffness_cases.hpp"

namespace fw::study {

void declare(SummaryRow& a, const StiffnessRow& row) {
  a("problem", "", row.problem, "label of the family");
  a("method", "", row.method, "as in the study; `overview`");
  a("measure", "", row.measure, "`cost`, `orders` or `overview`");
  a("stepping", "", row.stepping, "`explicit`, `exponential`, `implicit`; empty of overviews");
  a("parameter", "", row.parameter, "what is varied");
  a("points", "1", row.points, "values that reached the target; points in both fits; members");
  a("step_exponent", "1", row.step_exponent.value,
    "e of steps ~ abs(λ)^e over the stiffest members; NaN of other cases, like all that follows");
  a("step_exponent_low", "1", row.step_exponent.low, "lower end of the 95 % interval");
  a("step_exponent_high", "1", row.step_exponent.high, "upper end");
  a("classical_order", "1", row.classical_order, "of the method by theory; 0: variable, or an overview");
  a("nonstiff_order", "1", row.nonstiff_order.value, "observed where h abs(λ) is small");
  a("nonstiff_order_low", "1", row.nonstiff_order.low, "lower end");
  a("nonstiff_order_high", "1", row.nonstiff_order.high, "upper end");
  a("predicted_stiff_order", "1", row.predicted_stiff_order,
    "by the scheme's coefficients; NaN where there is no prediction");
  a("stiff_order", "1", row.stiff_order.value, "observed where h abs(λ) is large");
  a("stiff_order_low", "1", row.stiff_order.low, "lower end");
  a("stiff_order_high", "1", row.stiff_order.high, "upper end");
  a("crossing_cost", "SI", row.crossing_cost.value,
    "value of the parameter from which the cheapest implicit method costs less than the cheapest explicit "
    "one, in operations; NaN if not exactly once");
  a("crossing_cost_low", "SI", row.crossing_cost.low, "lower end");
  a("crossing_cost_high", "SI", row.crossing_cost.high, "upper end");
  a("crossing_seconds", "SI", row.crossing_seconds.value, "the same in seconds");
  a("crossing_seconds_low", "SI", row.crossing_seconds.low, "lower end");
  a("crossing_seconds_high", "SI", row.crossing_seconds.high, "upper end");
}

}  // namespace fw::study
