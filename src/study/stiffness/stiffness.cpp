#include "study/stiffness/stiffness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "study/problem_spec.hpp"
#include "study/stiffness/stiffness_cases.hpp"

namespace fw::study {

namespace {

double ratio_above_one(const CheckedTable& table, const std::string& key, double value) {
  const double ratio = table.number_or(key, value, NumberRule::positive);
  if (ratio <= 1.0) table.fail(key, fmt::format("found {}, expected more than 1", ratio));
  return ratio;
}

void read_costs(const CheckedTable& table, OperationCosts& costs) {
  const std::pair<const char*, double*> keys[] = {{"jacobian", &costs.jacobian},
                                                  {"jacobian_product", &costs.jacobian_product},
                                                  {"factorisation", &costs.factorisation},
                                                  {"linear_solve", &costs.linear_solve},
                                                  {"linear_iteration", &costs.linear_iteration}};
  for (const auto& [key, value] : keys) *value = table.number_or(key, *value, NumberRule::nonnegative);
}

StiffnessSettings read_settings(const CheckedTable& spec, bool quick) {
  StiffnessSettings settings;
  const CheckedTable table = spec.table_or_empty("stiffness");
  const auto positive = [&table](const std::string& key, double& value) {
    value = table.number_or(key, value, NumberRule::positive);
  };
  positive("target_error", settings.target_error);
  settings.fewest_steps = table.integer_or("fewest_steps", settings.fewest_steps, 1, 1'000'000);
  settings.max_evaluations =
      table.integer_or("max_evaluations", settings.max_evaluations, 100, 10'000'000'000);
  settings.bracket = ratio_above_one(table, "bracket", settings.bracket);
  positive("first_tolerance", settings.first_tolerance);
  positive("smallest_tolerance", settings.smallest_tolerance);
  settings.tolerance_ratio = ratio_above_one(table, "tolerance_ratio", settings.tolerance_ratio);
  positive("absolute_over_relative", settings.absolute_over_relative);
  settings.fit_range = ratio_above_one(table, "fit_range", settings.fit_range);
  positive("exponent_tolerance", settings.exponent_tolerance);
  settings.cost_uncertainty = ratio_above_one(table, "cost_uncertainty", settings.cost_uncertainty);
  read_costs(table.table_or_empty("operation_costs"), settings.costs);
  settings.timing.repetitions = table.integer_or("repetitions", settings.timing.repetitions, 1, 1000);
  positive("shortest_sample", settings.timing.shortest_sample);
  positive("longest_timing", settings.timing.longest_total);
  settings.map_levels = table.integer_or("map_levels", settings.map_levels, 2, 30);
  positive("stiff_product", settings.stiff_product);
  positive("nonstiff_product", settings.nonstiff_product);
  positive("order_tolerance", settings.order_tolerance);
  const CheckedTable shrunk = spec.table_or_empty("quick");
  const std::int64_t repetitions = shrunk.integer_or("repetitions", 1, 1, 1000);
  const std::int64_t evaluations = shrunk.integer_or(
      "max_evaluations", std::min<std::int64_t>(settings.max_evaluations, 50'000), 100, 10'000'000'000);
  if (quick) {
    settings.timing.repetitions = repetitions;
    settings.max_evaluations = evaluations;
    settings.timing.shortest_sample = 1e-4;
  }
  return settings;
}

/// Every `stride`-th member, and the last one.
void thin_out(ProblemFamily& family, std::int64_t count) {
  const auto members = static_cast<std::int64_t>(family.members.size());
  if (members <= count) return;
  ProblemFamily thin{family.label, family.parameter, {}, {}};
  for (std::int64_t k = 0; k < count; ++k) {
    const auto at = static_cast<std::size_t>(k * (members - 1) / std::max<std::int64_t>(count - 1, 1));
    thin.values.push_back(family.values[at]);
    thin.members.push_back(std::move(family.members[at]));
  }
  family = std::move(thin);
}

/// A family's members with what identifies them all.
struct ReadFamily {
  std::shared_ptr<const StiffnessFamily> family;
  std::string identity;
};

ReadFamily share(ProblemFamily& read, ReferenceArithmetic arithmetic) {
  auto family = std::make_shared<StiffnessFamily>();
  family->label = read.label;
  family->parameter = read.parameter;
  family->values = read.values;
  std::string identity;
  family->is_prothero_robinson = true;
  for (StudyProblem& member : read.members) {
    identity += member.identity;
    family->is_prothero_robinson =
        family->is_prothero_robinson && member.problem.test_equation == TestEquation::prothero_robinson;
    family->members.push_back(std::make_shared<const SharedProblem>(std::move(member), arithmetic));
  }
  return {std::move(family), std::move(identity)};
}

void read_stiffness(const CheckedTable& spec, const Catalog& catalog, bool quick, Plan& plan) {
  const StiffnessSettings settings = read_settings(spec, quick);
  const CheckedTable table = spec.table_or_empty("stiffness");
  const std::string measure = table.choice_or("measure", "both", {"both", measures_cost, measures_orders});
  const std::string reference = table.choice_or("reference", "binary64", {"binary128", "binary64"});
  const ReferenceArithmetic arithmetic =
      reference == "binary128" ? ReferenceArithmetic::binary128 : ReferenceArithmetic::binary64;
  const std::int64_t quick_values = spec.table_or_empty("quick").integer_or("values", 7, 2);
  std::vector<std::shared_ptr<const StiffnessMethod>> methods;
  for (const std::string& call : read_method_patterns(spec, catalog)) {
    methods.push_back(std::make_shared<const StiffnessMethod>(
        StiffnessMethod{call, catalog.method(call), catalog.theory(call).coefficients}));
  }
  for (ProblemFamily& read : read_problem_families(spec, catalog, plan.warnings)) {
    if (quick) thin_out(read, quick_values);
    const auto [family, members] = share(read, arithmetic);
    const std::string identity =
        fmt::format("stiffness\n{}parameter = {}\nvalues = {}\nreference = {}\n{}", members,
                    family->parameter, fmt::join(family->values, " "), reference, settings.text());
    for (const auto& method : methods) {
      const std::string name = family->label + "-" + method->call;
      const std::string text = identity + "method = " + method->call + "\n";
      if (measure != measures_orders) {
        plan.cases.push_back({.id = group_name(name + "-cost"),
                              .identity = text + "cost\n",
                              .run =
                                  [family = family, method, settings](const RunContext& context) {
                                    return run_stiffness_cost(*family, *method, settings, context);
                                  },
                              .is_timed = true});
      }
      if (measure != measures_cost && method->integrator->info().has_fixed_step) {
        plan.cases.push_back({.id = group_name(name + "-orders"),
                              .identity = text + "orders\n",
                              .run = [family = family, method, settings](const RunContext& context) {
                                return run_order_map(*family, *method, settings, context);
                              }});
      }
    }
    plan.cases.push_back({.id = group_name(family->label + "-overview"),
                          .identity = identity + "overview\n",
                          .run = [family = family](const RunContext& context) {
                            return run_stiffness_overview(*family, context);
                          }});
  }
  plan.conclude = conclude_stiffness;
}

}  // namespace

StudyKind stiffness_kind() {
  return {.name = "stiffness",
          .title = "Stiffness",
          .description =
              "what a given accuracy costs over decades of stiffness, where implicit methods begin to pay, "
              "stiffness ratio and index, and the observed order over step and stiffness",
          .read = read_stiffness};
}

}  // namespace fw::study
