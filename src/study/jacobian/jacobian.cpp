#include "study/jacobian/jacobian.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/error.hpp"
#include "settings/identity_text.hpp"
#include "study/jacobian/jacobian_definiteness.hpp"
#include "study/jacobian/jacobian_derivatives.hpp"
#include "study/jacobian/jacobian_row.hpp"
#include "study/jacobian/jacobian_runs.hpp"
#include "study/jacobian/jacobian_spec.hpp"
#include "study/parameter_values.hpp"

namespace fw::study {

namespace {

/// With --quick `rule.points` entries, the first and the last among them.
std::vector<double> thinned(const std::vector<double>& values, const QuickRule& rule) {
  return rule.is_on ? thinned_out(values, rule.points) : values;
}

struct Springs {
  mechanics::SpringLaw law;
  std::string name;
};

const std::vector<Springs>& spring_laws() {
  using mechanics::SpringLaw;
  static const std::vector<Springs> all = {
      {SpringLaw::hooke, "hooke"}, {SpringLaw::strain, "strain"}, {SpringLaw::tension_only, "tension_only"}};
  return all;
}

bool is_printed(const std::string& formula) {
  return formula.starts_with("printed");
}

void plan_derivatives(const DerivativeSubject& subject, const std::string& identity, bool is_printable,
                      const DerivativeSpec& derivatives, Plan& plan) {
  const std::string settings_text = settings::identity_text(derivatives);
  for (const std::string& formula : derivatives.formulas) {
    if (is_printed(formula) && !is_printable) continue;
    plan.cases.push_back(
        {.id = group_name(subject.label + "-" + formula),
         .identity = fmt::format("jacobian derivative\n{}seed = {}\n{}formula = {}\n", identity, plan.seed,
                                 settings_text, formula),
         .run =
             [subject, formula, settings = derivatives.settings](const RunContext& context) {
               return run_derivative(subject, formula, settings, context);
             },
         .known = {{"subject", subject.label}, {"part", "derivative"}, {"variant", formula}}});
  }
}

void plan_springs(const SpringSpec& springs, const DerivativeSpec& derivatives, const QuickRule& rule,
                  Plan& plan) {
  const std::int64_t samples = rule.is_on ? std::min(springs.samples, rule.samples) : springs.samples;
  for (const std::string& name : springs.laws) {
    const Springs& law = *std::find_if(spring_laws().begin(), spring_laws().end(),
                                       [&](const Springs& one) { return one.name == name; });
    for (const std::string& dampers : springs.dampers) {
      const SpringSampling sampling{law.law, dampers == "with"};
      const std::string label = law.name + (sampling.is_damped ? "-damped" : "");
      const DerivativeSubject subject{
          label, [sampling, samples, seed = plan.seed] { return random_springs(sampling, samples, seed); }};
      const bool is_printable = law.law == mechanics::SpringLaw::hooke && !sampling.is_damped;
      plan_derivatives(subject, fmt::format("springs = {}\ncount = {}\n", label, samples), is_printable,
                       derivatives, plan);
    }
  }
}

void plan_problem_derivatives(const StudyProblem& problem, const DerivativeSpec& derivatives, Plan& plan) {
  const Ivp& ivp = problem.problem.ivp;
  const double displacement = derivatives.displacement * typical_length(*ivp.system);
  const DerivativeSubject subject{problem.label,
                                  [ivp, displacement, count = derivatives.samples, seed = plan.seed] {
                                    return displaced_states(ivp, count, displacement, seed);
                                  }};
  plan_derivatives(subject, problem.identity, false, derivatives, plan);
  if (!derivatives.pattern) return;
  plan.cases.push_back({.id = group_name(problem.label + "-pattern"),
                        .identity = fmt::format("jacobian pattern\n{}seed = {}\n{}", problem.identity,
                                                plan.seed, settings::identity_text(derivatives)),
                        .run = [subject](const RunContext& context) { return run_pattern(subject, context); },
                        .known = {{"subject", subject.label}, {"part", "pattern"}}});
}

Compression scaled(Compression start, const StudyProblem& problem) {
  const double length = typical_length(*problem.problem.ivp.system);
  start.displacement *= length;
  start.speed *= length;
  return start;
}

std::string compression_text(const Compression& start) {
  return fmt::format("closing_rate = {}\ndisplacement = {}\nspeed = {}\nseed = {}\n", start.closing_rate,
                     start.displacement, start.speed, start.seed);
}

void require_springs(const CheckedTable& spec, const std::string& section, const StudyProblem& problem) {
  const SecondOrderSystem* mechanics = problem.problem.ivp.system->second_order();
  if (mechanics == nullptr || !mechanics->has_springs()) {
    throw InputError(fmt::format("{}: [{}]: problem \"{}\" has no springs, expected a mass-spring system",
                                 spec.source_name(), section, problem.label));
  }
}

/// All matrices of these parts are dense.
void require_small(const CheckedTable& spec, const std::string& section, const StudyProblem& problem,
                   Index unknowns, Index most) {
  if (unknowns <= most) return;
  throw InputError(
      fmt::format("{}: [{}]: problem \"{}\" has {} unknowns, expected at most {}: its matrices are dense",
                  spec.source_name(), section, problem.label, unknowns, most));
}

/// Unknowns (of ẏ = f) up to which a Jacobian is built by complex steps, and degrees of freedom up to which
/// all eigenvalues at every compression and step take minutes rather than hours.
constexpr Index most_unknowns = 5000, most_degrees_of_freedom = 600;
/// Steps of one run of [runs].
constexpr double most_steps = 1e6;

void plan_definiteness(const DefinitenessSpec& given, const CheckedTable& spec,
                       const std::vector<StudyProblem>& problems, const QuickRule& rule, Plan& plan) {
  DefinitenessSettings settings;
  settings.compressions = thinned(given.compressions, rule);
  settings.steps = thinned(given.steps, rule);
  settings.start = given.start.with_seed(plan.seed);
  const std::vector<std::string>& models = given.tangents;
  for (const StudyProblem& problem : problems) {
    require_springs(spec, "definiteness", problem);
    require_small(spec, "definiteness", problem,
                  problem.problem.ivp.system->second_order()->degrees_of_freedom(), most_degrees_of_freedom);
    DefinitenessSettings own = settings;
    own.start = scaled(settings.start, problem);
    for (const std::string& model : models) {
      plan.cases.push_back(
          {.id = group_name(problem.label + "-" + model),
           .identity = fmt::format("jacobian definiteness\n{}{}compressions = {}\nsteps = {}\ntangent = {}\n",
                                   problem.identity, compression_text(own.start),
                                   fmt::join(own.compressions, " "), fmt::join(own.steps, " "), model),
           .run = [problem, model,
                   own](const RunContext& context) { return run_definiteness(problem, model, own, context); },
           .known = {{"subject", problem.label}, {"part", "definiteness"}, {"variant", model}}});
    }
  }
}

void plan_runs(const RunsSpec& given, const StudyInput& input, const std::vector<StudyProblem>& problems,
               const QuickRule& rule, Plan& plan) {
  const CheckedTable& spec = input.file;
  const Catalog& catalog = input.catalog;
  const CheckedTable table = spec.table("runs");
  CompressedRunSettings settings;
  settings.compressions = thinned(given.compressions, rule);
  settings.steps = thinned(given.steps, rule);
  settings.start = given.start.with_seed(plan.seed);
  const std::vector<std::string>& methods = checked_methods(given.methods, table, catalog);
  for (const StudyProblem& problem : problems) {
    require_springs(spec, "runs", problem);
    const double duration = problem.problem.ivp.t1 - problem.problem.ivp.t0;
    for (const double step : settings.steps) {
      if (duration / step > most_steps) {
        table.fail("steps",
                   fmt::format("found {}, expected at most 1 000 000 steps in the {} s of problem \"{}\"",
                               step, duration, problem.label));
      }
    }
    CompressedRunSettings own = settings;
    own.start = scaled(settings.start, problem);
    for (std::size_t k = 0; k < methods.size(); ++k) {
      const std::shared_ptr<const Integrator> integrator = catalog.method(methods[k]);
      if (integrator->info().is_multistep || !integrator->info().has_fixed_step) {
        table.fail("methods", {k}, fmt::format("\"{}\" is no one-step method with a fixed step", methods[k]));
      }
      for (const double compression : own.compressions) {
        plan.cases.push_back(
            {.id = group_name(fmt::format("{}-{}-L{:.6g}", problem.label, methods[k], compression)),
             .identity = fmt::format("jacobian runs\n{}{}compression = {}\nsteps = {}\nmethod = {}\n",
                                     problem.identity, compression_text(own.start), compression,
                                     fmt::join(own.steps, " "), methods[k]),
             .run =
                 [problem, call = methods[k], integrator, compression, own](const RunContext& context) {
                   return run_compressed(problem, call, *integrator, compression, own, context);
                 },
             .known = {{"subject", problem.label}, {"part", "runs"}, {"variant", methods[k]}}});
      }
    }
  }
}

void check(const DerivativeSettings& settings, const CheckedTable& table) {
  if (settings.smallest_increment < settings.largest_increment) return;
  table.fail("smallest_increment", fmt::format("found {}, expected less than the largest increment {}",
                                               settings.smallest_increment, settings.largest_increment));
}

void plan_jacobian(const JacobianSpec& study, const StudyInput& input, Plan& plan) {
  const CheckedTable& spec = input.file;
  QuickRule rule = study.rule;
  rule.is_on = input.is_quick;
  const std::vector<StudyProblem> problems = make_problems(study.problems, input, plan.warnings);
  if (study.derivatives) {
    DerivativeSpec derivatives = *study.derivatives;
    check(derivatives.settings, input.section("derivatives"));
    if (rule.is_on) derivatives.samples = std::min(derivatives.samples, rule.samples);
    if (study.springs) plan_springs(*study.springs, derivatives, rule, plan);
    for (const StudyProblem& problem : problems) {
      require_small(spec, "derivatives", problem, problem.problem.ivp.y0.size(), most_unknowns);
      plan_problem_derivatives(problem, derivatives, plan);
    }
  }
  if (study.definiteness) plan_definiteness(*study.definiteness, spec, problems, rule, plan);
  if (study.runs) plan_runs(*study.runs, input, problems, rule, plan);
  if (plan.cases.empty()) {
    throw InputError(fmt::format(
        "{}: found none of [derivatives], [springs], [definiteness] and [runs], expected at least one",
        spec.source_name()));
  }
}

}  // namespace

StudyKind jacobian_kind() {
  return declared_kind<JacobianSpec>(
      {.name = "jacobian",
       .title = "Derivatives of the forces and their definiteness",
       .description =
           "analytic derivatives against complex steps, differences and the lecture's printed formulas; "
           "sparsity; definiteness of K and of implicit steps over compression and step, and what Newton, "
           "conjugate gradients and long runs make of it",
       .summary = columns_of<JacobianRow>(),
       .verdict_meaning = "see [the kind's page](studies/jacobian.md)",
       .reason_meaning = ""},
      plan_jacobian);
}

}  // namespace fw::study
