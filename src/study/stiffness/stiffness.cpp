#include "study/stiffness/stiffness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "settings/identity_text.hpp"
#include "study/problem_spec.hpp"
#include "study/stiffness/stiffness_cases.hpp"

namespace fw::study {

void declare(settings::Archive& a, StiffnessSettings& s) {
  using settings::setting;
  a(setting("target_error", s.target_error)
        .unit("1")
        .positive()
        .doc("relative error whose cost is measured"));
  a(setting("fewest_steps", s.fewest_steps)
        .integers(1, 1'000'000)
        .doc("where the search begins; the map's coarsest step as well"));
  a(setting("max_evaluations", s.max_evaluations)
        .integers(100, 10'000'000'000)
        .quick_at_most(50'000)
        .doc("right-hand sides of a run"));
  a(setting("bracket", s.bracket).unit("1").above(1.0).doc("the number of steps is found to this factor"));
  a(setting("first_tolerance", s.first_tolerance).unit("1").positive().doc("relative, of adaptive methods"));
  a(setting("smallest_tolerance", s.smallest_tolerance).unit("1").positive().doc("likewise"));
  a(setting("tolerance_ratio", s.tolerance_ratio).unit("1").above(1.0).doc("of successive tolerances"));
  a(setting("absolute_over_relative", s.absolute_over_relative)
        .unit("SI")
        .positive()
        .doc("absolute tolerance in units of the relative one"));
  a(setting("fit_range", s.fit_range)
        .unit("1")
        .above(1.0)
        .doc("the exponent is fitted where \\|λ\\| is at most this factor below its largest"));
  a(setting("exponent_tolerance", s.exponent_tolerance)
        .unit("1")
        .positive()
        .doc("largest \\|exponent − 1\\| of steps over \\|λ\\| that holds"));
  a(setting("cost_uncertainty", s.cost_uncertainty)
        .unit("1")
        .above(1.0)
        .doc("factor by which the operation costs may be off"));
  a.section({"operation_costs", "What operations cost, in right-hand sides."}, s.costs);
  declare(a, s.timing);
  a(setting("map_levels", s.map_levels).integers(2, 30).doc("steps of the map, each half the one before"));
  a(setting("stiff_product", s.stiff_product).unit("1").positive().doc("h\\|λ\\| above counts as stiff"));
  a(setting("nonstiff_product", s.nonstiff_product)
        .unit("1")
        .positive()
        .doc("h\\|λ\\| below counts as not stiff"));
  a(setting("order_tolerance", s.order_tolerance)
        .unit("1")
        .positive()
        .doc("largest \\|observed − predicted order\\| that holds"));
}

namespace {

using settings::Archive;
using settings::choice;
using settings::setting;

/// What the cases of a study measure.
enum class Measures { both, cost, orders };

struct Spec {
  MethodPatterns methods;
  StiffnessSettings settings;
  Measures measures = Measures::both;
  ReferenceArithmetic arithmetic = ReferenceArithmetic::binary64;
  std::vector<FamilySpec> problems;
  std::int64_t quick_values = 7;
};

/// The section [stiffness], of which two keys are no settings of a case.
struct StiffnessSection {
  Spec& spec;
};

void declare(Archive& a, StiffnessSection& section) {
  declare(a, section.spec.settings);
  a(choice("measure", section.spec.measures,
           {{"both", Measures::both}, {measures_cost, Measures::cost}, {measures_orders, Measures::orders}})
        .selects_cases()
        .doc("the cost over stiffness, the orders over step and stiffness, or both"));
  a(reference_setting(section.spec.arithmetic).doc("arithmetic of the certified references"));
}

void declare(Archive& a, Spec& spec) {
  declare(a, spec.methods);
  StiffnessSection section{spec};
  a.section({"stiffness", "The search for the cost, its timing, and the map of orders."}, section);
  a.sections(problem_sections, spec.problems);
  a.quick_section([&] { a(setting("values", spec.quick_values).at_least(2).doc("members of a family")); });
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

void plan_stiffness(const Spec& spec, const StudyInput& input, Plan& plan) {
  const Catalog& catalog = input.catalog;
  StiffnessSettings settings = spec.settings;
  if (input.is_quick) settings.timing.shortest_sample = TimingRule::quick_sample;
  const std::string settings_text = settings::identity_text(settings);
  const std::string reference = to_string(spec.arithmetic);
  std::vector<std::shared_ptr<const StiffnessMethod>> methods;
  for (const std::string& call : expanded(spec.methods, input)) {
    methods.push_back(std::make_shared<const StiffnessMethod>(
        StiffnessMethod{call, catalog.method(call), catalog.theory(call).coefficients}));
  }
  for (ProblemFamily& read : make_families(spec.problems, input, plan.warnings)) {
    if (input.is_quick) thin_out(read, spec.quick_values);
    const auto [family, members] = share(read, spec.arithmetic);
    const std::string identity =
        fmt::format("stiffness\n{}parameter = {}\nvalues = {}\nreference = {}\n{}", members,
                    family->parameter, fmt::join(family->values, " "), reference, settings_text);
    const auto known = [&](const std::string& method,
                           const std::string& measure) -> std::vector<std::pair<std::string, CellValue>> {
      return {{"problem", family->label},
              {"method", method},
              {"measure", measure},
              {"parameter", family->parameter}};
    };
    for (const auto& method : methods) {
      const std::string name = family->label + "-" + method->call;
      const std::string text = identity + "method = " + method->call + "\n";
      if (spec.measures != Measures::orders) {
        plan.cases.push_back({.id = group_name(name + "-cost"),
                              .identity = text + "cost\n",
                              .run =
                                  [family = family, method, settings](const RunContext& context) {
                                    return run_stiffness_cost(*family, *method, settings, context);
                                  },
                              .is_timed = true,
                              .known = known(method->call, measures_cost)});
      }
      if (spec.measures != Measures::cost && method->integrator->info().has_fixed_step) {
        plan.cases.push_back({.id = group_name(name + "-orders"),
                              .identity = text + "orders\n",
                              .run =
                                  [family = family, method, settings](const RunContext& context) {
                                    return run_order_map(*family, *method, settings, context);
                                  },
                              .known = known(method->call, measures_orders)});
      }
    }
    plan.cases.push_back(
        {.id = group_name(family->label + "-overview"),
         .identity = identity + "overview\n",
         .run = [family =
                     family](const RunContext& context) { return run_stiffness_overview(*family, context); },
         .known = known("overview", measures_overview)});
  }
  plan.conclude = conclude_stiffness;
}

}  // namespace

StudyKind stiffness_kind() {
  return declared_kind<Spec>(
      {.name = "stiffness",
       .title = "Stiffness",
       .description =
           "what a given accuracy costs over decades of stiffness, where implicit methods begin to "
           "pay, stiffness ratio and index, and the observed order over step and stiffness",
       .summary = columns_of<StiffnessRow>(),
       .verdict_meaning = "of costs: the steps of an explicit scheme grow like abs(λ); of orders: both "
                          "observed orders are the predicted ones",
       .reason_meaning = ""},
      plan_stiffness);
}

}  // namespace fw::study
