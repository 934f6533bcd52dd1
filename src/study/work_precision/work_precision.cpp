#include "study/work_precision/work_precision.hpp"

#include <fmt/format.h>

#include "settings/identity_text.hpp"
#include "study/problem_spec.hpp"
#include "study/work_precision/work_precision_case.hpp"

namespace fw::study {

void declare(settings::Archive& a, WorkPrecisionSettings& s) {
  using settings::setting;
  a(setting("levels", s.levels).integers(1, 1000).doc("rungs of a ladder at most"));
  a(setting("step_ratio", s.step_ratio).unit("1").above(1.0).doc("of successive constant steps"));
  a(setting("tolerance_ratio", s.tolerance_ratio).unit("1").above(1.0).doc("of successive tolerances"));
  a(setting("fewest_steps", s.fewest_steps)
        .integers(1, 1'000'000'000)
        .doc("where the search for the coarsest step begins"));
  a(setting("start_error", s.start_error)
        .unit("1")
        .positive()
        .doc("relative error at the coarsest step, found by doubling the number of steps"));
  a(setting("finest_error", s.finest_error).unit("1").positive().doc("a ladder ends below"));
  a(setting("first_tolerance", s.first_tolerance).unit("1").positive().doc("relative"));
  a(setting("smallest_tolerance", s.smallest_tolerance).unit("1").positive().doc("relative"));
  a(setting("absolute_over_relative", s.absolute_over_relative)
        .unit("SI")
        .positive()
        .doc("absolute tolerance in units of the relative one"));
  a(setting("max_evaluations", s.max_evaluations)
        .integers(100, 10'000'000'000)
        .quick_at_most(2000)
        .doc("right-hand sides of a run"));
  a(setting("max_factorisations", s.max_factorisations)
        .integers(1, 10'000'000'000)
        .doc("of a run; a ladder ends where the next one would need more"));
  a(setting("target_error", s.target_error)
        .unit("1")
        .positive()
        .doc("relative error: what it costs stands in the summary, interpolated"));
  a(setting("fit_error", s.fit_error)
        .unit("1")
        .positive()
        .doc("relative: larger errors are no part of the fit"));
  a(setting("tolerance", s.tolerance)
        .unit("1")
        .positive()
        .doc("largest \\|efficiency order − order\\| that holds"));
  declare(a, s.timing);
}

namespace {

using settings::Archive;
using settings::choice;
using settings::setting;

/// The steppings of which each makes a ladder.
enum class Controls { both, fixed, adaptive };

struct Spec {
  MethodPatterns methods;
  WorkPrecisionSettings settings;
  Controls controls = Controls::both;
  ReferenceArithmetic arithmetic = ReferenceArithmetic::binary128;
  std::vector<FamilySpec> problems;
  std::optional<std::int64_t> quick_problems;
};

/// The section [work_precision], of which two keys are no settings of a ladder.
struct WorkPrecisionSection {
  Spec& spec;
};

void declare(Archive& a, WorkPrecisionSection& section) {
  declare(a, section.spec.settings);
  a(choice("control", section.spec.controls,
           {{"both", Controls::both}, {"fixed", Controls::fixed}, {"adaptive", Controls::adaptive}})
        .selects_cases()
        .doc("methods that cannot are left out, at least one has to"));
  a(reference_setting(section.spec.arithmetic)
        .doc("`binary64` for systems too large for it: two methods of orders 8 and 7 in double, about 9 "
             "digits"));
}

void declare(Archive& a, Spec& spec) {
  declare(a, spec.methods);
  WorkPrecisionSection section{spec};
  a.section({"work_precision", "The ladders, what they may cost, and the fit."}, section);
  a.sections(problem_sections, spec.problems);
  a.quick_section([&] {
    a(setting("problems", spec.quick_problems)
          .at_least(1)
          .default_text("all")
          .doc("how many of the problems, from the first one"));
  });
}

std::vector<LadderControl> ladder_controls(Controls controls) {
  if (controls == Controls::fixed) return {LadderControl::fixed};
  if (controls == Controls::adaptive) return {LadderControl::adaptive};
  return {LadderControl::fixed, LadderControl::adaptive};
}

void check(const WorkPrecisionSettings& settings, const CheckedTable& table) {
  if (settings.finest_error < settings.start_error) return;
  table.fail(table.has("finest_error") ? "finest_error" : "start_error",
             fmt::format("found a finest error of {} and a start error of {}, expected it to be smaller",
                         settings.finest_error, settings.start_error));
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

void plan_work_precision(const Spec& study, const StudyInput& input, Plan& plan) {
  const CheckedTable& spec = input.file;
  const Catalog& catalog = input.catalog;
  WorkPrecisionSettings settings = study.settings;
  check(settings, input.section("work_precision"));
  if (input.is_quick) settings.timing.shortest_sample = TimingRule::quick_sample;
  const std::vector<LadderControl> controls = ladder_controls(study.controls);
  const std::string reference = to_string(study.arithmetic);
  const std::vector<std::string> methods = expanded(study.methods, input);
  require_a_ladder(spec, catalog, methods, controls);
  std::vector<StudyProblem> problems;
  for (ProblemFamily& family : make_families(study.problems, input, plan.warnings)) {
    for (StudyProblem& member : family.members) problems.push_back(std::move(member));
  }
  const auto all = static_cast<std::int64_t>(problems.size());
  if (!study.quick_problems) TomlTree(input.resolved).table("quick").set("problems", all);
  const std::int64_t quick_problems = study.quick_problems.value_or(all);
  if (input.is_quick && all > quick_problems) problems.resize(static_cast<std::size_t>(quick_problems));
  for (StudyProblem& entry : problems) {
    const auto problem = std::make_shared<const SharedProblem>(std::move(entry), study.arithmetic);
    const std::string identity =
        fmt::format("work_precision\n{}reference = {}\n{}", problem->entry().identity, reference,
                    settings::identity_text(settings));
    for (const std::string& call : methods) {
      const std::shared_ptr<const Integrator> integrator = catalog.method(call);
      for (const LadderControl control : controls) {
        if (!can_run(integrator->info(), control)) continue;
        plan.cases.push_back(
            {.id = group_name(fmt::format("{}-{}-{}", problem->entry().label, call, to_string(control))),
             .identity = fmt::format("{}method = {}\ncontrol = {}\n", identity, call, to_string(control)),
             .run = [spec = WorkPrecisionSpec{problem, call, integrator, control, settings}](
                        const RunContext& context) { return run_work_precision(spec, context); },
             .is_timed = true,
             .known = {{"problem", problem->entry().label},
                       {"method", call},
                       {"family", integrator->info().family},
                       {"control", to_string(control)}}});
      }
    }
    plan.cases.push_back({.id = group_name(problem->entry().label + "-front"),
                          .identity = "work_precision front\n" + identity,
                          .run = [problem](const RunContext&) { return empty_front(problem->entry()); },
                          .known = {{"problem", problem->entry().label}, {"method", front_method}}});
  }
  plan.conclude = conclude_fronts;
}

}  // namespace

StudyKind work_precision_kind() {
  return declared_kind<Spec>(
      {.name = "work_precision",
       .title = "Error against work",
       .description =
           "the true error over a ladder of steps or tolerances against right-hand sides, Jacobians, "
           "factorisations, iterations and seconds; efficiency orders; Pareto fronts over all methods",
       .summary = work_precision_summary(),
       .verdict_meaning = "of constant steps with constant work: the efficiency order is the method's order",
       .reason_meaning = ""},
      plan_work_precision);
}

}  // namespace fw::study
