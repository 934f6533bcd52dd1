#include "study/kinds/dissipation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <numbers>

#include "settings/identity_text.hpp"
#include "study/kinds/dissipation_case.hpp"
#include "study/problem_spec.hpp"

namespace fw::study {

namespace {

using settings::Archive;

struct DissipationSpec {
  std::vector<std::string> methods;
  DissipationSettings settings;
};

void declare(Archive& a, DissipationSpec& spec) {
  a(methods_setting(spec.methods));
  a.section({"dissipation", "The spring, and the range of z = ωh."}, spec.settings);
  a.quick_section();
}

/// Steps of the motion that is kept, and of the window of a fit.
constexpr double most_shown_steps = 1e5, most_window_steps = 1e6;

void check(const DissipationSettings& s, const CheckedTable& table) {
  if (s.to <= s.from) table.fail("to", fmt::format("found {}, expected more than from = {}", s.to, s.from));
  if (s.shown_steps_per_period * s.shown_periods < 1.0) {
    table.fail("shown_periods", "found less than one step in all, expected more");
  }
  if (s.shown_steps_per_period * s.shown_periods > most_shown_steps) {
    table.fail("shown_periods",
               fmt::format("found {} periods of {} steps, expected at most {:.0f} steps in all",
                           s.shown_periods, s.shown_steps_per_period, most_shown_steps));
  }
  // The finest step, of the range or of the motion that is shown, has the longest window.
  const double finest = std::min(s.from, s.shown());
  if (2.0 * std::numbers::pi / finest * s.periods > most_window_steps) {
    table.fail("periods",
               fmt::format("found {} periods of {:.3g} steps, expected at most {:.0f} steps in a window",
                           s.periods, 2.0 * std::numbers::pi / finest, most_window_steps));
  }
}

void plan_dissipation(const DissipationSpec& spec, const StudyInput& input, Plan& plan) {
  const DissipationSettings& settings = spec.settings;
  check(settings, input.section("dissipation"));
  const Catalog& catalog = input.catalog;
  const auto spring = std::make_shared<const Problem>(
      catalog.problem("harmonic_oscillator", {{"mass", settings.mass}, {"stiffness", settings.stiffness}}));
  const std::vector<std::string>& methods = checked_methods(spec.methods, input.file, catalog);
  for (std::size_t i = 0; i < methods.size(); ++i) {
    const std::string& call = methods[i];
    const std::shared_ptr<const Integrator> integrator = catalog.method(call);
    require_fixed_step(input.file, i, call, integrator->info());
    if (const std::string why = why_not_applicable(integrator->info(), *spring->ivp.system); !why.empty()) {
      input.file.fail("methods", {i}, fmt::format("\"{}\" on a single spring: {}", call, why));
    }
    plan.cases.push_back(
        {.id = group_name(call),
         .identity = "dissipation\nmethod = " + call + "\n" + settings::identity_text(settings),
         .run =
             [call, integrator, theory = analysis::oscillator_factors(catalog.theory(call)), spring,
              settings](const RunContext& context) {
               return run_dissipation(call, *integrator, theory, *spring, settings, context);
             },
         .known = {{"method", call}}});
  }
}

}  // namespace

StudyKind dissipation_kind() {
  return declared_kind<DissipationSpec>(
      {.name = "dissipation",
       .title = "Numerical damping and period error",
       .description =
           "damping ratio and period error over w h, from the coefficients and from runs of a spring",
       .summary = columns_of<DissipationRow>(),
       .verdict_meaning = "`holds`: run and coefficients agree",
       .reason_meaning = ""},
      plan_dissipation);
}

}  // namespace fw::study
