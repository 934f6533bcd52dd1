#include "study/jacobian/jacobian.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/error.hpp"
#include "study/jacobian/jacobian_definiteness.hpp"
#include "study/jacobian/jacobian_derivatives.hpp"
#include "study/jacobian/jacobian_runs.hpp"
#include "study/problem_spec.hpp"

namespace fw::study {

namespace {

/// What `--quick` leaves: entries of each list, samples of each subject.
struct QuickRule {
  bool is_on = false;
  std::int64_t points = 0;
  std::int64_t samples = 0;
};

QuickRule read_quick(const CheckedTable& spec, bool quick) {
  const CheckedTable table = spec.table_or_empty("quick");
  return {quick, table.integer_or("points", 5, 2, 1000), table.integer_or("samples", 20, 1, 100'000)};
}

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

/// A list of positive numbers, or { from, to, count } for a geometric sequence.
std::vector<double> read_sequence(const CheckedTable& table, const std::string& key, const QuickRule& rule) {
  if (!table.is_table(key)) {
    std::vector<double> values = table.numbers(key, NumberRule::positive);
    if (values.empty()) table.fail(key, "found an empty list, expected at least one number");
    return thinned(std::move(values), rule);
  }
  const CheckedTable range = table.table(key);
  const double from = range.positive_number("from"), to = range.positive_number("to");
  const std::int64_t count = range.integer("count", 2, 10'000);
  std::vector<double> values;
  for (std::int64_t k = 0; k < count; ++k) {
    values.push_back(from * std::pow(to / from, static_cast<double>(k) / static_cast<double>(count - 1)));
  }
  values.back() = to;
  return thinned(std::move(values), rule);
}

struct Springs {
  mechanics::SpringLaw law;
  std::string name;
};

std::vector<Springs> spring_laws(const CheckedTable& table) {
  using mechanics::SpringLaw;
  const std::vector<Springs> all = {
      {SpringLaw::hooke, "hooke"}, {SpringLaw::strain, "strain"}, {SpringLaw::tension_only, "tension_only"}};
  std::vector<Springs> chosen;
  for (const std::string& name : table.strings_or("laws", {"hooke", "strain", "tension_only"})) {
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const Springs& one) { return one.name == name; });
    if (found == all.end()) {
      table.fail("laws", fmt::format("found \"{}\", expected hooke, strain or tension_only", name));
    }
    chosen.push_back(*found);
  }
  return chosen;
}

/// The keys of [derivatives] and [springs].
struct DerivativeSpec {
  DerivativeSettings settings;
  std::vector<std::string> formulas;
  std::int64_t samples = 5;   ///< of each problem
  double displacement = 0.1;  ///< in typical lengths
  bool pattern = true;

  std::string text() const {
    return fmt::format(
        "tolerance = {}\nslope_tolerance = {}\nincrements = {} {} {}\nsamples = {}\ndisplacement = {}\n",
        settings.tolerance, settings.slope_tolerance, settings.largest_increment, settings.smallest_increment,
        settings.per_decade, samples, displacement);
  }
};

DerivativeSpec read_derivatives(const CheckedTable& spec, const QuickRule& rule) {
  const CheckedTable table = spec.table_or_empty("derivatives");
  DerivativeSpec result;
  DerivativeSettings& settings = result.settings;
  result.formulas = table.strings_or("formulas", derivative_formulas());
  for (std::size_t k = 0; k < result.formulas.size(); ++k) {
    const auto& known = derivative_formulas();
    if (std::find(known.begin(), known.end(), result.formulas[k]) == known.end()) {
      table.fail("formulas", {k},
                 fmt::format("found \"{}\", expected one of {}", result.formulas[k], fmt::join(known, ", ")));
    }
  }
  settings.tolerance = table.number_or("tolerance", settings.tolerance, NumberRule::positive);
  settings.slope_tolerance =
      table.number_or("slope_tolerance", settings.slope_tolerance, NumberRule::positive);
  const auto increment = [&](const std::string& key, double value) {
    const double found = table.number_or(key, value, NumberRule::positive);
    if (found < 1e-20 || found > 1e3) {
      table.fail(key, fmt::format("found {}, expected 1e-20 to 1000 typical lengths", found));
    }
    return found;
  };
  settings.largest_increment = increment("largest_increment", settings.largest_increment);
  settings.smallest_increment = increment("smallest_increment", settings.smallest_increment);
  if (settings.smallest_increment >= settings.largest_increment) {
    table.fail("smallest_increment", fmt::format("found {}, expected less than the largest increment {}",
                                                 settings.smallest_increment, settings.largest_increment));
  }
  settings.per_decade = table.integer_or("per_decade", settings.per_decade, 1, 100);
  result.samples = table.integer_or("samples", result.samples, 1, 100'000);
  if (rule.is_on) result.samples = std::min(result.samples, rule.samples);
  result.displacement = table.number_or("displacement", result.displacement, NumberRule::nonnegative);
  result.pattern = table.boolean_or("pattern", result.pattern);
  return result;
}

bool is_printed(const std::string& formula) {
  return formula.starts_with("printed");
}

void plan_derivatives(const DerivativeSubject& subject, const std::string& identity, bool is_printable,
                      const DerivativeSpec& derivatives, Plan& plan) {
  for (const std::string& formula : derivatives.formulas) {
    if (is_printed(formula) && !is_printable) continue;
    plan.cases.push_back(
        {.id = group_name(subject.label + "-" + formula),
         .identity = fmt::format("jacobian derivative\n{}seed = {}\n{}formula = {}\n", identity, plan.seed,
                                 derivatives.text(), formula),
         .run = [subject, formula, settings = derivatives.settings](const RunContext& context) {
           return run_derivative(subject, formula, settings, context);
         }});
  }
}

void plan_springs(const CheckedTable& spec, const DerivativeSpec& derivatives, const QuickRule& rule,
                  Plan& plan) {
  if (!spec.has("springs")) return;
  const CheckedTable table = spec.table("springs");
  const std::vector<Springs> laws = spring_laws(table);
  std::int64_t samples = table.integer_or("samples", 200, 1, 100'000);
  if (rule.is_on) samples = std::min(samples, rule.samples);
  const std::vector<std::string> dampers = table.strings_or("dampers", {"without", "with"});
  for (const Springs& law : laws) {
    for (std::size_t k = 0; k < dampers.size(); ++k) {
      if (dampers[k] != "without" && dampers[k] != "with") {
        table.fail("dampers", {k}, fmt::format("found \"{}\", expected without or with", dampers[k]));
      }
      const SpringSampling sampling{law.law, dampers[k] == "with"};
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
       .identity =
           fmt::format("jacobian pattern\n{}seed = {}\n{}", problem.identity, plan.seed, derivatives.text()),
       .run = [subject](const RunContext& context) { return run_pattern(subject, context); }});
}

/// The state that [definiteness] and [runs] begin with; lengths in the typical length of the problem's
/// springs.
Squeeze read_squeeze(const CheckedTable& table, std::int64_t seed) {
  return {.closing_rate = table.number_or("closing_rate", 0.0),
          .displacement = table.number_or("displacement", 0.05, NumberRule::nonnegative),
          .speed = table.number_or("speed", 0.0, NumberRule::nonnegative),
          .seed = seed};
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

void plan_definiteness(const CheckedTable& spec, const std::vector<StudyProblem>& problems,
                       const QuickRule& rule, Plan& plan) {
  if (!spec.has("definiteness")) return;
  const CheckedTable table = spec.table("definiteness");
  DefinitenessSettings settings;
  settings.compressions = read_sequence(table, "compressions", rule);
  settings.steps = read_sequence(table, "steps", rule);
  settings.squeeze = read_squeeze(table, plan.seed);
  const std::vector<std::string> models = table.strings_or("tangents", tangent_model_names());
  for (std::size_t k = 0; k < models.size(); ++k) {
    const auto& known = tangent_model_names();
    if (std::find(known.begin(), known.end(), models[k]) == known.end()) {
      table.fail("tangents", {k},
                 fmt::format("found \"{}\", expected one of {}", models[k], fmt::join(known, ", ")));
    }
  }
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

void plan_runs(const CheckedTable& spec, const Catalog& catalog, const std::vector<StudyProblem>& problems,
               const QuickRule& rule, Plan& plan) {
  if (!spec.has("runs")) return;
  const CheckedTable table = spec.table("runs");
  CompressedRunSettings settings;
  settings.compressions = read_sequence(table, "compressions", rule);
  settings.steps = read_sequence(table, "steps", rule);
  settings.squeeze = read_squeeze(table, plan.seed);
  const std::vector<std::string> methods = read_methods(table, catalog);
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

void read_jacobian(const CheckedTable& spec, const Catalog& catalog, bool quick, Plan& plan) {
  const QuickRule rule = read_quick(spec, quick);
  const bool wants_derivatives = spec.has("derivatives") || spec.has("springs");
  // Not asked for, the section stays out of the resolved specification: there it would be asked for.
  const DerivativeSpec derivatives =
      read_derivatives(wants_derivatives ? spec : CheckedTable::parse_text("", spec.source_name()), rule);
  std::vector<StudyProblem> problems;
  if (!spec.has("springs") || spec.has("problem")) problems = read_problems(spec, catalog, plan.warnings);
  plan_springs(spec, derivatives, rule, plan);
  if (wants_derivatives) {
    for (const StudyProblem& problem : problems) {
      require_small(spec, "derivatives", problem, problem.problem.ivp.y0.size(), most_unknowns);
      plan_problem_derivatives(problem, derivatives, plan);
    }
  }
  plan_definiteness(spec, problems, rule, plan);
  plan_runs(spec, catalog, problems, rule, plan);
  if (plan.cases.empty()) {
    throw InputError(fmt::format(
        "{}: found none of [derivatives], [springs], [definiteness] and [runs], expected at least one",
        spec.source_name()));
  }
}

}  // namespace

StudyKind jacobian_kind() {
  return {.name = "jacobian",
          .title = "Derivatives of the forces and their definiteness",
          .description =
              "analytic derivatives against complex steps, differences and the lecture's printed formulas; "
              "sparsity; definiteness of K and of implicit steps over compression and step, and what Newton, "
              "conjugate gradients and long runs make of it",
          .read = read_jacobian};
}

}  // namespace fw::study
