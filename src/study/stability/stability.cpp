#include "study/stability/stability.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.hpp"
#include "study/stability/stability_cases.hpp"

namespace fw::study {

namespace {

/// Follows nonlinear problems for their spectra.
constexpr const char* tracer_call = "dormand_prince_54";

/// [from, to] with from < to.
void read_range(const CheckedTable& table, const char* key, double& from, double& to) {
  const std::vector<double> range = table.numbers_or(key, {from, to});
  if (range.size() != 2 || !(range[0] < range[1]))
    table.fail(key, "found no two numbers in rising order, expected [from, to]");
  from = range[0];
  to = range[1];
}

constexpr std::int64_t fewest_points = 11, most_points = 1001;

RegionSettings read_regions(const CheckedTable& table, const CheckedTable& quick_table, bool quick) {
  RegionSettings settings;
  read_range(table, "real", settings.real_from, settings.real_to);
  read_range(table, "imaginary", settings.imaginary_from, settings.imaginary_to);
  settings.points = table.integer_or("points", settings.points, fewest_points, most_points);
  const std::int64_t fewer = quick_table.integer_or("points", std::min<std::int64_t>(settings.points, 61),
                                                    fewest_points, most_points);
  if (quick) settings.points = fewer;
  return settings;
}

LimitSettings read_limits(const CheckedTable& table, const CheckedTable& quick_table, bool quick,
                          std::int64_t seed) {
  LimitSettings settings;
  settings.tolerance = table.number_or("tolerance", settings.tolerance, NumberRule::positive);
  settings.exponent_tolerance =
      table.number_or("exponent_tolerance", settings.exponent_tolerance, NumberRule::positive);
  settings.farthest = table.number_or("farthest", settings.farthest, NumberRule::positive);
  settings.growth = table.number_or("growth", settings.growth, NumberRule::positive);
  if (settings.growth <= 4.0) {
    // The positions of a body that moves freely grow fourfold from the first quarter of a run to the last.
    table.fail("growth", fmt::format("found {}, expected more than 4", settings.growth));
  }
  settings.fewest_steps = table.integer_or("fewest_steps", settings.fewest_steps, 100, 10'000'000);
  settings.most_steps = table.integer_or("most_steps", std::max(settings.most_steps, settings.fewest_steps),
                                         settings.fewest_steps, 100'000'000);
  settings.samples = table.integer_or("samples", settings.samples, 2, 10'000);
  settings.largest_dense = table.integer_or("largest_dense", settings.largest_dense, 1, 5000);
  settings.seed = seed;
  const std::int64_t fewer_steps = quick_table.integer_or(
      "fewest_steps", std::min<std::int64_t>(settings.fewest_steps, 1000), 100, 10'000'000);
  if (quick) settings.fewest_steps = std::min(fewer_steps, settings.most_steps);
  return settings;
}

/// Every other member of a family, from both ends, until there are at most `most`.
void thin_out(ProblemFamily& family, std::int64_t most) {
  const auto count = static_cast<std::int64_t>(family.members.size());
  if (count <= most) return;
  std::vector<double> values;
  std::vector<StudyProblem> members;
  for (std::int64_t k = 0; k < most; ++k) {
    const auto from = static_cast<std::size_t>(k * (count - 1) / std::max<std::int64_t>(most - 1, 1));
    values.push_back(family.values[from]);
    members.push_back(std::move(family.members[from]));
  }
  family.values = std::move(values);
  family.members = std::move(members);
}

std::vector<StabilityFamily> read_families(const CheckedTable& spec, const Catalog& catalog, bool quick,
                                           std::vector<std::string>& warnings) {
  const CheckedTable quick_table = spec.table_or_empty("quick");
  const std::int64_t most_members = quick_table.integer_or("members", 4, 1, 10'000);
  const std::int64_t most_problems = quick_table.integer_or("problems", 2, 1, 10'000);
  std::vector<ProblemFamily> found = read_problem_families(spec, catalog, warnings);
  const std::vector<CheckedTable> sections = spec.tables("problem");
  const std::shared_ptr<const Integrator> tracer = catalog.method(tracer_call);
  std::vector<StabilityFamily> families;
  for (std::size_t k = 0; k < found.size(); ++k) {
    const bool linearise = sections[k].boolean_or("linearise", false);
    StabilityFamily family;
    if (sections[k].has("exponent")) {
      family.exponent = sections[k].number("exponent");
      if (found[k].parameter.empty())
        sections[k].fail("exponent", "found without vary, expected with it only");
      if (found[k].values.size() < 3) {
        sections[k].fail("exponent", fmt::format("found with {} values, expected at least 3 to fit a law to",
                                                 found[k].values.size()));
      }
    }
    if (quick) thin_out(found[k], most_members);
    family.label = found[k].label;
    family.parameter = found[k].parameter;
    family.values = found[k].values;
    family.identity = fmt::format("linearise = {}\nexponent = {}\n", linearise, family.exponent);
    for (StudyProblem& member : found[k].members) {
      if (linearise && member.problem.ivp.system->second_order() == nullptr) {
        sections[k].fail("linearise",
                         fmt::format("\"{}\" is y' = f(t, y), expected M q'' = f(t, q, q')", member.label));
      }
      family.identity += member.identity;
      family.members.push_back(
          std::make_shared<const StabilityProblem>(std::move(member), linearise, tracer));
    }
    families.push_back(std::move(family));
  }
  if (quick && families.size() > static_cast<std::size_t>(most_problems))
    families.resize(static_cast<std::size_t>(most_problems));
  return families;
}

void read_stability(const CheckedTable& spec, const Catalog& catalog, bool quick, Plan& plan) {
  const bool has_regions = spec.has("regions"), has_problems = spec.has("problem");
  if (!has_regions && !has_problems) {
    throw InputError(
        fmt::format("{}: found neither [regions] nor [[problem]], expected one or both", spec.source_name()));
  }
  std::vector<std::shared_ptr<const StabilityMethod>> methods;
  const std::vector<std::string> calls = read_method_patterns(spec, catalog);
  for (const std::string& call : calls) {
    const std::shared_ptr<const Integrator> integrator = catalog.method(call);
    const bool is_pattern_match = !integrator->info().has_fixed_step;
    if (is_pattern_match) {
      plan.warnings.push_back(
          fmt::format("{}: \"{}\" chooses its own steps and is left out", spec.source_name(), call));
      continue;
    }
    const analysis::Theory theory = catalog.theory(call);
    methods.push_back(std::make_shared<const StabilityMethod>(
        StabilityMethod{call, integrator, theory.coefficients, theory.on_linear_systems}));
  }
  const CheckedTable quick_table = spec.table_or_empty("quick");
  if (has_regions) {
    const RegionSettings settings = read_regions(spec.table("regions"), quick_table, quick);
    for (const auto& method : methods) {
      plan.cases.push_back({.id = group_name("region-" + method->call),
                            .identity = "stability region\nmethod = " + method->call + "\n" + settings.text(),
                            .run = [method, settings](const RunContext& context) {
                              return run_region_case(*method, settings, context);
                            }});
    }
  }
  if (!has_problems) return;
  const LimitSettings settings = read_limits(spec.table_or_empty("limits"), quick_table, quick, plan.seed);
  for (StabilityFamily& read : read_families(spec, catalog, quick, plan.warnings)) {
    const auto family = std::make_shared<const StabilityFamily>(std::move(read));
    for (const auto& method : methods) {
      plan.cases.push_back({.id = group_name(family->label + "-" + method->call),
                            .identity = "stability limit\n" + family->identity + "method = " + method->call +
                                        "\n" + settings.text(),
                            .run = [family, method, settings](const RunContext& context) {
                              return run_limit_case(*family, *method, settings, context);
                            }});
    }
  }
}

}  // namespace

void StabilityRow::add_to(CaseResult& result) const {
  result.summary = {{"part", "", part},
                    {"problem", "", problem},
                    {"method", "", method},
                    {"basis", "", basis},
                    {"real_interval", "1", real_interval},
                    {"imaginary_interval", "1", imaginary_interval},
                    {"stability_angle", "deg", angle},
                    {"growth_at_infinity", "1", at_infinity},
                    {"spectral_radius", "1/s", spectral_radius},
                    {"predicted_limit", "s", predicted},
                    {"observed_limit", "s", observed},
                    {"ratio", "1", ratio},
                    {"monotone_predicted", "s", monotone_predicted},
                    {"monotone_observed", "s", monotone_observed},
                    {"largest_deviation", "1", largest_deviation},
                    {"expected_exponent", "1", expected_exponent},
                    {"predicted_exponent", "1", predicted_exponent},
                    {"predicted_exponent_low", "1", predicted_exponent_low},
                    {"predicted_exponent_high", "1", predicted_exponent_high},
                    {"observed_exponent", "1", observed_exponent},
                    {"observed_exponent_low", "1", observed_exponent_low},
                    {"observed_exponent_high", "1", observed_exponent_high},
                    {"verdict", "", std::string(to_string(result.verdict))},
                    {"reason", "", result.reason}};
}

StudyKind stability_kind() {
  return {.name = "stability",
          .title = "Linear stability",
          .description =
              "regions of stability; largest stable step of every method on every problem, predicted "
              "from spectra and observed in runs; its law over a parameter",
          .read = read_stability};
}

}  // namespace fw::study
