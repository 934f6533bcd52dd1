#include "study/work_precision/work_precision.hpp"

#include <fmt/format.h>

#include "study/problem_spec.hpp"
#include "study/work_precision/work_precision_case.hpp"

namespace fw::study {

namespace {

double ratio_above_one(const CheckedTable& table, const std::string& key, double value) {
  const double ratio = table.number_or(key, value, NumberRule::positive);
  if (ratio <= 1.0) table.fail(key, fmt::format("found {}, expected more than 1", ratio));
  return ratio;
}

WorkPrecisionSettings read_settings(const CheckedTable& spec, bool quick) {
  WorkPrecisionSettings settings;
  const CheckedTable table = spec.table_or_empty("work_precision");
  const auto positive = [&](const std::string& key, double& value) {
    value = table.number_or(key, value, NumberRule::positive);
  };
  settings.levels = table.integer_or("levels", settings.levels, 1, 1000);
  settings.step_ratio = ratio_above_one(table, "step_ratio", settings.step_ratio);
  settings.tolerance_ratio = ratio_above_one(table, "tolerance_ratio", settings.tolerance_ratio);
  settings.fewest_steps = table.integer_or("fewest_steps", settings.fewest_steps, 1, 1'000'000'000);
  positive("start_error", settings.start_error);
  positive("finest_error", settings.finest_error);
  if (settings.finest_error >= settings.start_error) {
    table.fail(table.has("finest_error") ? "finest_error" : "start_error",
               fmt::format("found a finest error of {} and a start error of {}, expected it to be smaller",
                           settings.finest_error, settings.start_error));
  }
  positive("first_tolerance", settings.first_tolerance);
  positive("smallest_tolerance", settings.smallest_tolerance);
  positive("absolute_over_relative", settings.absolute_over_relative);
  settings.max_evaluations =
      table.integer_or("max_evaluations", settings.max_evaluations, 100, 10'000'000'000);
  settings.max_factorisations =
      table.integer_or("max_factorisations", settings.max_factorisations, 1, 10'000'000'000);
  positive("target_error", settings.target_error);
  positive("fit_error", settings.fit_error);
  positive("tolerance", settings.tolerance);
  settings.timing.repetitions = table.integer_or("repetitions", settings.timing.repetitions, 1, 1000);
  positive("shortest_sample", settings.timing.shortest_sample);
  positive("longest_timing", settings.timing.longest_total);
  const CheckedTable shrunk = spec.table_or_empty("quick");
  const std::int64_t evaluations = shrunk.integer_or(
      "max_evaluations", std::min<std::int64_t>(settings.max_evaluations, 2000), 100, 10'000'000'000);
  const std::int64_t repetitions = shrunk.integer_or("repetitions", 1, 1, 1000);
  if (quick) {
    settings.max_evaluations = evaluations;
    settings.timing.repetitions = repetitions;
    settings.timing.shortest_sample = 1e-4;
  }
  return settings;
}

std::vector<LadderControl> read_controls(const CheckedTable& spec) {
  const CheckedTable table = spec.table_or_empty("work_precision");
  const std::string chosen = table.choice_or("control", "both", {"both", "fixed", "adaptive"});
  if (chosen == "fixed") return {LadderControl::fixed};
  if (chosen == "adaptive") return {LadderControl::adaptive};
  return {LadderControl::fixed, LadderControl::adaptive};
}

bool can_run(const MethodInfo& info, LadderControl control) {
  return control == LadderControl::fixed ? info.has_fixed_step : info.is_adaptive;
}

/// Single methods without a control are left out; a study of none would be empty.
void require_a_ladder(const CheckedTable& spec, const Catalog& catalog,
                      const std::vector<std::string>& methods, const std::vector<LadderControl>& controls) {
  for (const std::string& call : methods) {
    const std::shared_ptr<const Integrator> integrator = catalog.method(call);
    for (const LadderControl control : controls) {
      if (can_run(integrator->info(), control)) return;
    }
  }
  spec.fail("methods",
            fmt::format("found no method that can run with control = \"{}\", expected at least one",
                        to_string(controls.front())));
}

void read_work_precision(const CheckedTable& spec, const Catalog& catalog, bool quick, Plan& plan) {
  const WorkPrecisionSettings settings = read_settings(spec, quick);
  const std::vector<LadderControl> controls = read_controls(spec);
  const std::string reference =
      spec.table_or_empty("work_precision").choice_or("reference", "binary128", {"binary128", "binary64"});
  const ReferenceArithmetic arithmetic =
      reference == "binary128" ? ReferenceArithmetic::binary128 : ReferenceArithmetic::binary64;
  const std::vector<std::string> methods = read_method_patterns(spec, catalog);
  require_a_ladder(spec, catalog, methods, controls);
  std::vector<StudyProblem> problems;
  for (ProblemFamily& family : read_problem_families(spec, catalog, plan.warnings)) {
    for (StudyProblem& member : family.members) problems.push_back(std::move(member));
  }
  const std::int64_t quick_problems =
      spec.table_or_empty("quick").integer_or("problems", static_cast<std::int64_t>(problems.size()), 1);
  if (quick && static_cast<std::int64_t>(problems.size()) > quick_problems) {
    problems.resize(static_cast<std::size_t>(quick_problems));
  }
  for (StudyProblem& entry : problems) {
    const auto problem = std::make_shared<const SharedProblem>(std::move(entry), arithmetic);
    const std::string identity = fmt::format("work_precision\n{}reference = {}\n{}",
                                             problem->entry().identity, reference, settings.text());
    for (const std::string& call : methods) {
      const std::shared_ptr<const Integrator> integrator = catalog.method(call);
      for (const LadderControl control : controls) {
        if (!can_run(integrator->info(), control)) continue;
        plan.cases.push_back(
            {.id = group_name(fmt::format("{}-{}-{}", problem->entry().label, call, to_string(control))),
             .identity = fmt::format("{}method = {}\ncontrol = {}\n", identity, call, to_string(control)),
             .run = [spec = WorkPrecisionSpec{problem, call, integrator, control, settings}](
                        const RunContext& context) { return run_work_precision(spec, context); },
             .is_timed = true});
      }
    }
    plan.cases.push_back({.id = group_name(problem->entry().label + "-front"),
                          .identity = "work_precision front\n" + identity,
                          .run = [problem](const RunContext&) { return empty_front(problem->entry()); }});
  }
  plan.conclude = conclude_fronts;
}

}  // namespace

StudyKind work_precision_kind() {
  return {.name = "work_precision",
          .title = "Error against work",
          .description =
              "the true error over a ladder of steps or tolerances against right-hand sides, Jacobians, "
              "factorisations, iterations and seconds; efficiency orders; Pareto fronts over all methods",
          .read = read_work_precision};
}

}  // namespace fw::study
