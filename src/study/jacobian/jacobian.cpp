#include "study/jacobian/jacobian.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/error.hpp"
#include "settings/identity_text.hpp"
#include "study/jacobian/jacobian_definiteness.hpp"
#include "study/jacobian/jacobian_derivatives.hpp"
#include "study/jacobian/jacobian_row.hpp"
#include "study/jacobian/jacobian_runs.hpp"
#include "study/problem_spec.hpp"

namespace fw::study {

namespace {

using settings::Archive;
using settings::setting;

/// What `--quick` leaves: entries of each list, samples of each subject.
struct QuickRule {
  bool is_on = false;
  std::int64_t points = 5;
  std::int64_t samples = 20;
};

/// With --quick `rule.points` entries, the first and the last among them.
std::vector<double> thinned(std::vector<double> values, const QuickRule& rule) {
  const auto size = static_cast<std::int64_t>(values.size());
  if (!rule.is_on || size <= rule.points) return values;
  std::vector<double> kept;
  for (std::int64_t k = 0; k < rule.points; ++k) {
    kept.push_back(values[static_cast<std::size_t>(k * (size - 1) / (rule.points - 1))]);
  }
  return kept;
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

/// The keys of [springs].
struct SpringSpec {
  std::vector<std::string> laws = {"hooke", "strain", "tension_only"};
  std::vector<std::string> dampers = {"without", "with"};
  std::int64_t samples = 200;
};

void declare(Archive& a, SpringSpec& springs) {
  a(setting("laws", springs.laws)
        .not_empty()
        .choices({"hooke", "strain", "tension_only"})
        .doc("of random single springs"));
  a(setting("dampers", springs.dampers)
        .not_empty()
        .choices({"without", "with"})
        .doc("springs without and with dampers"));
  a(setting("samples", springs.samples).integers(1, 100'000).doc("springs of each law"));
}

/// The keys of [derivatives].
struct DerivativeSpec {
  DerivativeSettings settings;
  std::vector<std::string> formulas = derivative_formulas();
  std::int64_t samples = 5;   ///< of each problem
  double displacement = 0.1;  ///< in typical lengths
  bool pattern = true;
};

void declare(Archive& a, DerivativeSpec& d) {
  DerivativeSettings& s = d.settings;
  a(setting("formulas", d.formulas)
        .not_empty()
        .choices(derivative_formulas())
        .doc("`printed_e1`, `printed_e2` for undamped Hooke springs of `[springs]` only"));
  a(setting("tolerance", s.tolerance)
        .unit("1")
        .positive()
        .doc("largest relative deviation of an analytic derivative that holds"));
  a(setting("slope_tolerance", s.slope_tolerance)
        .unit("1")
        .positive()
        .doc("largest \\|observed − predicted slope\\| of a difference that holds"));
  a(setting("largest_increment", s.largest_increment)
        .unit("typical length")
        .between(1e-20, 1e3)
        .doc("of differences"));
  a(setting("smallest_increment", s.smallest_increment)
        .unit("typical length")
        .between(1e-20, 1e3)
        .doc("of differences"));
  a(setting("per_decade", s.per_decade).integers(1, 100).doc("increments"));
  a(setting("samples", d.samples).integers(1, 100'000).doc("states of each problem"));
  a(setting("displacement", d.displacement)
        .unit("typical length")
        .nonnegative()
        .doc("of each component of the initial state, at random: nothing is at rest or straight then"));
  a(setting("pattern", d.pattern).selects_cases().doc("the part `pattern` for each problem"));
}

/// The state that [definiteness] and [runs] begin with; lengths in the typical length of the problem's
/// springs.
struct SqueezeSpec {
  double closing_rate = 0.0, displacement = 0.05, speed = 0.0;

  Squeeze squeeze(std::int64_t seed) const {
    return {.closing_rate = closing_rate, .displacement = displacement, .speed = speed, .seed = seed};
  }
};

void declare(Archive& a, SqueezeSpec& squeeze) {
  a(setting("closing_rate", squeeze.closing_rate)
        .unit("1/s")
        .doc("velocities −rate·(x − centre): what dampers see"));
  a(setting("displacement", squeeze.displacement)
        .unit("typical length")
        .nonnegative()
        .doc("random, before the compression: buckling needs a direction"));
  a(setting("speed", squeeze.speed)
        .unit("typical length/s")
        .nonnegative()
        .doc("largest random velocity of a moving component, added"));
}

/// The keys of [definiteness].
struct DefinitenessSpec {
  std::vector<double> compressions, steps;
  SqueezeSpec start;
  std::vector<std::string> tangents = tangent_model_names();
};

void declare_squeezed(Archive& a, std::vector<double>& compressions, std::vector<double>& steps) {
  a(setting("compressions", compressions)
        .unit("1")
        .required()
        .not_empty()
        .positive()
        .or_sequence()
        .doc("factors of all distances from the centre"));
  a(setting("steps", steps).unit("s").required().not_empty().positive().or_sequence().doc("h"));
}

void declare(Archive& a, DefinitenessSpec& spec) {
  declare_squeezed(a, spec.compressions, spec.steps);
  declare(a, spec.start);
  a(setting("tangents", spec.tangents).not_empty().choices(tangent_model_names()).doc("models of K"));
}

/// The keys of [runs].
struct RunsSpec {
  std::vector<double> compressions, steps;
  SqueezeSpec start;
  std::vector<std::string> methods;
};

void declare(Archive& a, RunsSpec& spec) {
  declare_squeezed(a, spec.compressions, spec.steps);
  declare(a, spec.start);
  a(methods_setting(spec.methods));
}

struct Spec {
  std::optional<SpringSpec> springs;
  std::optional<DerivativeSpec> derivatives;
  std::optional<DefinitenessSpec> definiteness;
  std::optional<RunsSpec> runs;
  std::vector<ProblemSpec> problems;
  QuickRule rule;
};

void declare(Archive& a, Spec& spec) {
  a.optional_section({"springs", "Random single springs."}, spec.springs);
  a.optional_section(
      {"derivatives", "Derivatives by formulas against complex steps, of springs and problems."},
      spec.derivatives);
  // Not asked for, the section stays out of the resolved specification: there it would be asked for.
  if (!a.is_description() && spec.springs && !spec.derivatives) {
    spec.derivatives.emplace();
    a.section({"derivatives"}, *spec.derivatives);
  }
  a.optional_section({"definiteness",
                      "Definiteness of K and of the matrix of implicit steps over compression "
                      "and step."},
                     spec.definiteness);
  a.optional_section({"runs", "Runs from compressed springs."}, spec.runs);
  a.sections({.name = "problem",
              .doc = "A problem of the catalogue, or a scene; not needed with [springs].",
              .is_required = !a.is_description() && !spec.springs},
             spec.problems);
  a.quick_section([&] {
    a(setting("points", spec.rule.points)
          .integers(2, 1000)
          .doc("entries of each list of compressions and steps, the first and last among them"));
    a(setting("samples", spec.rule.samples).integers(1, 100'000).doc("at most, of each subject"));
  });
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
         .run = [subject, formula, settings = derivatives.settings](const RunContext& context) {
           return run_derivative(subject, formula, settings, context);
         }});
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
  plan.cases.push_back(
      {.id = group_name(problem.label + "-pattern"),
       .identity = fmt::format("jacobian pattern\n{}seed = {}\n{}", problem.identity, plan.seed,
                               settings::identity_text(derivatives)),
       .run = [subject](const RunContext& context) { return run_pattern(subject, context); }});
}

Squeeze scaled(Squeeze squeeze, const StudyProblem& problem) {
  const double length = typical_length(*problem.problem.ivp.system);
  squeeze.displacement *= length;
  squeeze.speed *= length;
  return squeeze;
}

std::string squeeze_text(const Squeeze& squeeze) {
  return fmt::format("closing_rate = {}\ndisplacement = {}\nspeed = {}\nseed = {}\n", squeeze.closing_rate,
                     squeeze.displacement, squeeze.speed, squeeze.seed);
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
  settings.squeeze = given.start.squeeze(plan.seed);
  const std::vector<std::string>& models = given.tangents;
  for (const StudyProblem& problem : problems) {
    require_springs(spec, "definiteness", problem);
    require_small(spec, "definiteness", problem,
                  problem.problem.ivp.system->second_order()->degrees_of_freedom(), most_degrees_of_freedom);
    DefinitenessSettings own = settings;
    own.squeeze = scaled(settings.squeeze, problem);
    for (const std::string& model : models) {
      plan.cases.push_back(
          {.id = group_name(problem.label + "-" + model),
           .identity = fmt::format("jacobian definiteness\n{}{}compressions = {}\nsteps = {}\ntangent = {}\n",
                                   problem.identity, squeeze_text(own.squeeze),
                                   fmt::join(own.compressions, " "), fmt::join(own.steps, " "), model),
           .run = [problem, model, own](const RunContext& context) {
             return run_definiteness(problem, model, own, context);
           }});
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
  settings.squeeze = given.start.squeeze(plan.seed);
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
    own.squeeze = scaled(settings.squeeze, problem);
    for (std::size_t k = 0; k < methods.size(); ++k) {
      const std::shared_ptr<const Integrator> integrator = catalog.method(methods[k]);
      if (integrator->info().is_multistep || !integrator->info().has_fixed_step) {
        table.fail("methods", {k}, fmt::format("\"{}\" is no one-step method with a fixed step", methods[k]));
      }
      for (const double compression : own.compressions) {
        plan.cases.push_back(
            {.id = group_name(fmt::format("{}-{}-L{:.6g}", problem.label, methods[k], compression)),
             .identity = fmt::format("jacobian runs\n{}{}compression = {}\nsteps = {}\nmethod = {}\n",
                                     problem.identity, squeeze_text(own.squeeze), compression,
                                     fmt::join(own.steps, " "), methods[k]),
             .run = [problem, call = methods[k], integrator, compression, own](const RunContext& context) {
               return run_compressed(problem, call, *integrator, compression, own, context);
             }});
      }
    }
  }
}

void check(const DerivativeSettings& settings, const CheckedTable& table) {
  if (settings.smallest_increment < settings.largest_increment) return;
  table.fail("smallest_increment", fmt::format("found {}, expected less than the largest increment {}",
                                               settings.smallest_increment, settings.largest_increment));
}

void plan_jacobian(const Spec& study, const StudyInput& input, Plan& plan) {
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
  return declared_kind<Spec>(
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
