#include "study/propagation/propagation.hpp"

#include <fmt/format.h>

#include <memory>

#include "core/error.hpp"
#include "settings/identity_text.hpp"
#include "study/propagation/propagation_case.hpp"

namespace fw::study {

namespace {

using settings::Archive;

struct Spec {
  std::vector<std::string> methods;
  PropagationSettings settings;
  std::vector<ProblemSpec> problems;
};

void declare(Archive& a, Spec& spec) {
  a(methods_setting(spec.methods));
  a.section({.name = "propagation", .doc = "The disturbance and the runs.", .is_required = true},
            spec.settings);
  a.sections(problem_sections, spec.problems);
  a.quick_section();
}

void check(const PropagationSettings& settings, const CheckedTable& table) {
  if (norm(settings.direction) == 0.0) table.fail("direction", "found the zero vector, expected a direction");
  for (const double step : settings.steps) {
    if (settings.duration / step > 1e5) {
      table.fail("duration",
                 fmt::format("found {}, expected at most 100 000 steps of {}", settings.duration, step));
    }
  }
}

/// Displacements that a case keeps: (steps + 1) × masses.
constexpr double most_displacements = 5e7;

void require_fitting(const CheckedTable& spec, const PropagationSettings& settings,
                     const DisturbedNetwork& network) {
  const auto masses = static_cast<double>(network.masses());
  for (const double step : settings.steps) {
    const auto states = static_cast<double>(settings.steps_of(step) + 1);
    if (states * masses <= most_displacements) continue;
    spec.table("propagation")
        .fail(
            settings.duration > 0.0 ? "duration" : "step_count",
            fmt::format("found {:.0f} states of the {:.0f} masses of problem \"{}\", expected at most {:.0f} "
                        "displacements in a case",
                        states, masses, network.label, most_displacements));
  }
}

void plan_propagation(const Spec& study, const StudyInput& input, Plan& plan) {
  const CheckedTable& spec = input.file;
  const Catalog& catalog = input.catalog;
  const PropagationSettings& settings = study.settings;
  check(settings, spec.table("propagation"));
  const std::vector<std::string>& methods = checked_methods(study.methods, spec, catalog);
  for (const StudyProblem& entry : make_problems(study.problems, input, plan.warnings)) {
    std::shared_ptr<const DisturbedNetwork> network;
    try {
      network = std::make_shared<const DisturbedNetwork>(
          disturb(entry, settings.mass, settings.kick, settings.size, settings.direction));
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: {}", spec.source_name(), error.what()));
    }
    require_fitting(spec, settings, *network);
    for (std::size_t i = 0; i < methods.size(); ++i) {
      const std::string& call = methods[i];
      const std::shared_ptr<const Integrator> integrator = catalog.method(call);
      if (const std::string why = why_no_constant_steps(integrator->info(), *network->ivp.system);
          !why.empty()) {
        spec.fail("methods", {i}, fmt::format("\"{}\" (problem \"{}\"): {}", call, network->label, why));
      }
      for (const double step : settings.steps) {
        plan.cases.push_back(
            {.id = group_name(fmt::format("{}-{}-h{}", network->label, call, step)),
             .identity = fmt::format("propagation\n{}method = {}\nstep = {}\n{}", network->identity, call,
                                     step, settings::identity_text(settings)),
             .run =
                 [network, call, integrator, data = catalog.theory(call).on_position_forces, step,
                  settings](const RunContext& context) {
                   return run_propagation(*network, call, *integrator, data, step, settings, context);
                 },
             .known = {{"problem", network->label}, {"method", call}, {"step", step}}});
      }
    }
  }
}

}  // namespace

StudyKind propagation_kind() {
  return declared_kind<Spec>(
      {.name = "propagation",
       .title = "Propagation of a disturbance",
       .description = "springs that a disturbance travels per step, against stages and the speed of waves",
       .summary = columns_of<PropagationRow>(),
       .verdict_meaning = "`holds`: fronts as predicted, and the wave's speed",
       .reason_meaning = ""},
      plan_propagation);
}

}  // namespace fw::study
