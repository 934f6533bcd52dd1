#include "study/stability/stability.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.hpp"
#include "settings/identity_text.hpp"
#include "study/stability/stability_cases.hpp"

namespace fw::study {

void declare(settings::Archive& a, LimitSettings& s) {
  using settings::setting;
  a(setting("tolerance", s.tolerance)
        .unit("1")
        .positive()
        .doc("largest \\|observed/predicted − 1\\| that holds"));
  a(setting("exponent_tolerance", s.exponent_tolerance)
        .unit("1")
        .positive()
        .doc("of exponents outside their 95 % interval"));
  a(setting("farthest", s.farthest).unit("1").positive().doc("largest step tried, in units of 1/\\|λ\\|"));
  // The positions of a body that moves freely grow fourfold from the first quarter of a run to the last.
  a(setting("growth", s.growth)
        .unit("1")
        .above(4.0)
        .doc("of the norm of a perturbation that makes a step unstable"));
  a(setting("fewest_steps", s.fewest_steps)
        .integers(100, 10'000'000)
        .quick_at_most(1000)
        .doc("of a run; not more than `most_steps`"));
  if (!a.is_description()) s.most_steps = std::max(s.most_steps, s.fewest_steps);
  a(setting("most_steps", s.most_steps)
        .integers(a.is_description() ? 100 : s.fewest_steps, 100'000'000)
        .doc("of a run; not less than `fewest_steps`, which is the default where it is more"));
  a(setting("samples", s.samples).integers(2, 10'000).doc("of J along a nonlinear trajectory"));
  a(setting("largest_dense", s.largest_dense).integers(1, 5000).doc("unknowns with all eigenvalues"));
}

namespace {

using settings::Archive;
using settings::setting;

/// Follows nonlinear problems for their spectra.
constexpr const char* tracer_call = "dormand_prince_54";

/// The keys of [regions] as a file has them.
struct RegionSpec {
  std::vector<double> real = {RegionSettings().real_from, RegionSettings().real_to};
  std::vector<double> imaginary = {RegionSettings().imaginary_from, RegionSettings().imaginary_to};
  std::int64_t points = RegionSettings().points;
};

void declare(Archive& a, RegionSpec& regions) {
  a(setting("real", regions.real).entries(2).doc("[from, to] of Re z"));
  a(setting("imaginary", regions.imaginary).entries(2).doc("[from, to] of Im z"));
  a(setting("points", regions.points).integers(11, 1001).quick_at_most(61).doc("along each axis"));
}

RegionSettings region_settings(const RegionSpec& spec, const CheckedTable& table) {
  const auto check = [&table](const char* key, const std::vector<double>& range) {
    if (!(range[0] < range[1]))
      table.fail(key, fmt::format("found [{}, {}], expected [from, to] with from < to", range[0], range[1]));
  };
  check("real", spec.real);
  check("imaginary", spec.imaginary);
  return {spec.real[0], spec.real[1], spec.imaginary[0], spec.imaginary[1], spec.points};
}

/// A [[problem]] and what theory says of its limit.
struct LimitProblemSpec {
  FamilySpec family;
  bool linearise = false;
  std::optional<double> exponent;
};

void declare(Archive& a, LimitProblemSpec& problem) {
  declare(a, problem.family);
  a(setting("linearise", problem.linearise)
        .doc("the problem is replaced by its linearisation about its start: M q̈ = K q + D q̇"));
  a(setting("exponent", problem.exponent)
        .unit("1")
        .default_text("none")
        .doc("with `vary`: p of limit ∝ \\|parameter\\|^p in theory"));
}

struct Spec {
  MethodPatterns methods;
  std::optional<RegionSpec> regions;
  std::vector<LimitProblemSpec> problems;
  LimitSettings limits;
  std::int64_t quick_members = 4, quick_problems = 2;
};

void declare(Archive& a, Spec& spec) {
  declare(a, spec.methods);
  a.optional_section({"regions",
                      "The part of the complex plane in which regions of stability are shown; "
                      "without it there are none."},
                     spec.regions);
  a.sections({"problem", "A problem of the catalogue, or a scene; without any no limits are measured."},
             spec.problems);
  const bool has_problems = a.is_description() || !spec.problems.empty();
  if (has_problems) a.section({"limits", "How the largest stable step is found."}, spec.limits);
  a.quick_section([&] {
    if (!has_problems) return;
    a(setting("members", spec.quick_members).integers(1, 10'000).doc("members of a family, spread evenly"));
    a(setting("problems", spec.quick_problems).integers(1, 10'000).doc("the first problems or families"));
  });
}

std::vector<StabilityFamily> stability_families(const Spec& spec, const StudyInput& input,
                                                std::vector<std::string>& warnings) {
  std::vector<FamilySpec> specs;
  for (const LimitProblemSpec& problem : spec.problems) specs.push_back(problem.family);
  std::vector<ProblemFamily> found = make_families(specs, input, warnings);
  const std::vector<CheckedTable> sections = input.file.tables("problem");
  const Catalog& catalog = input.catalog;
  const bool quick = input.is_quick;
  const std::shared_ptr<const Integrator> tracer = catalog.method(tracer_call);
  std::vector<StabilityFamily> families;
  for (std::size_t k = 0; k < found.size(); ++k) {
    const bool linearise = spec.problems[k].linearise;
    StabilityFamily family;
    if (spec.problems[k].exponent) {
      family.exponent = *spec.problems[k].exponent;
      if (found[k].parameter.empty())
        sections[k].fail("exponent", "found without vary, expected with it only");
      if (found[k].values.size() < 3) {
        sections[k].fail("exponent", fmt::format("found with {} values, expected at least 3 to fit a law to",
                                                 found[k].values.size()));
      }
    }
    if (quick) thin_out(found[k], spec.quick_members);
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
  if (quick && families.size() > static_cast<std::size_t>(spec.quick_problems))
    families.resize(static_cast<std::size_t>(spec.quick_problems));
  return families;
}

void plan_stability(const Spec& study, const StudyInput& input, Plan& plan) {
  const CheckedTable& spec = input.file;
  const Catalog& catalog = input.catalog;
  if (!study.regions && study.problems.empty()) {
    throw InputError(
        fmt::format("{}: found neither [regions] nor [[problem]], expected one or both", spec.source_name()));
  }
  std::vector<std::shared_ptr<const StabilityMethod>> methods;
  const std::vector<std::string> calls = expanded(study.methods, input);
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
  if (study.regions) {
    const RegionSettings settings = region_settings(*study.regions, spec.table("regions"));
    const std::string identity = settings::identity_text(*study.regions);
    for (const auto& method : methods) {
      plan.cases.push_back(
          {.id = group_name("region-" + method->call),
           .identity = "stability region\nmethod = " + method->call + "\n" + identity,
           .run = [method, settings](
                      const RunContext& context) { return run_region_case(*method, settings, context); },
           .known = {{"part", "region"}, {"method", method->call}}});
    }
  }
  if (study.problems.empty()) return;
  LimitSettings settings = study.limits;
  if (input.is_quick) settings.fewest_steps = std::min(settings.fewest_steps, settings.most_steps);
  settings.seed = plan.seed;
  const std::string identity = settings::identity_text(settings);
  for (StabilityFamily& read : stability_families(study, input, plan.warnings)) {
    const auto family = std::make_shared<const StabilityFamily>(std::move(read));
    for (const auto& method : methods) {
      plan.cases.push_back(
          {.id = group_name(family->label + "-" + method->call),
           .identity = "stability limit\n" + family->identity + "method = " + method->call + "\n" + identity,
           .run =
               [family, method, settings](const RunContext& context) {
                 return run_limit_case(*family, *method, settings, context);
               },
           .known = {{"part", family->parameter.empty() ? "limit" : "law"},
                     {"problem", family->label},
                     {"method", method->call}}});
    }
  }
}

}  // namespace

void declare(SummaryRow& a, const StabilityRow& row) {
  a("part", "", row.part, "`region`, `limit` or `law`");
  a("problem", "", row.problem, "its label; empty of regions");
  a("method", "", row.method, "as in the study");
  a("basis", "", row.basis,
    "what growth is taken from: `R(z)`, `characteristic polynomial`, `oscillator matrix`, `two-step "
    "recurrence`, `exp(z)`, `single steps`");
  a("real_interval", "1", row.real_interval,
    "largest x with growth ≤ 1 on [−x, 0]; of regions, like the next three, else NaN");
  a("imaginary_interval", "1", row.imaginary_interval, "largest y with growth ≤ 1 on [0, iy]");
  a("stability_angle", "deg", row.angle, "α of A(α)-stability, of R(z) and multistep formulas");
  a("growth_at_infinity", "1", row.at_infinity, "likewise");
  a("spectral_radius", "1/s", row.spectral_radius, "of limits, like the next five, else NaN");
  a("predicted_limit", "s", row.predicted, "as the column");
  a("observed_limit", "s", row.observed, "as the column");
  a("ratio", "1", row.ratio, "as the column");
  a("monotone_predicted", "s", row.monotone_predicted, "as the column");
  a("monotone_observed", "s", row.monotone_observed, "as the column");
  a("largest_deviation", "1", row.largest_deviation,
    "of limits and laws: largest ∣observed/predicted − 1∣ of limits or growth rates");
  a("expected_exponent", "1", row.expected_exponent,
    "p of limit ∝ ∣parameter∣^p in theory; of laws, like all that follows, else NaN");
  a("predicted_exponent", "1", row.predicted_exponent, "fitted to the predicted limits");
  a("predicted_exponent_low", "1", row.predicted_exponent_low, "95 % interval");
  a("predicted_exponent_high", "1", row.predicted_exponent_high, "");
  a("observed_exponent", "1", row.observed_exponent, "fitted to the observed limits");
  a("observed_exponent_low", "1", row.observed_exponent_low, "95 % interval");
  a("observed_exponent_high", "1", row.observed_exponent_high, "");
}

StudyKind stability_kind() {
  return declared_kind<Spec>(
      {.name = "stability",
       .title = "Linear stability",
       .description = "regions of stability; largest stable step of every method on every problem, predicted "
                      "from spectra and observed in runs; its law over a parameter",
       .summary = columns_of<StabilityRow>(),
       .verdict_meaning = "`holds` of regions: the running code is what coefficients and claims say; of "
                          "linear problems: predicted and observed limits agree, and the exponents are "
                          "theory's; `not applicable` of nonlinear problems",
       .reason_meaning = "with the figures"},
      plan_stability);
}

}  // namespace fw::study
