#include "study/jacobian/jacobian_spec.hpp"

namespace fw::study {

using settings::Archive;
using settings::setting;

namespace {

void declare_lists(Archive& a, std::vector<double>& compressions, std::vector<double>& steps) {
  a(setting("compressions", compressions)
        .unit("1")
        .required()
        .not_empty()
        .positive()
        .or_sequence()
        .doc("factors of all distances from the centre"));
  a(setting("steps", steps).unit("s").required().not_empty().positive().or_sequence().doc("h"));
}

}  // namespace

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

void declare(Archive& a, CompressionSpec& start) {
  a(setting("closing_rate", start.closing_rate)
        .unit("1/s")
        .doc("velocities −rate·(x − centre): what dampers see"));
  a(setting("displacement", start.displacement)
        .unit("typical length")
        .nonnegative()
        .doc("random, before the compression: buckling needs a direction"));
  a(setting("speed", start.speed)
        .unit("typical length/s")
        .nonnegative()
        .doc("largest random velocity of a moving component, added"));
}

void declare(Archive& a, DefinitenessSpec& spec) {
  declare_lists(a, spec.compressions, spec.steps);
  declare(a, spec.start);
  a(setting("tangents", spec.tangents).not_empty().choices(tangent_model_names()).doc("models of K"));
}

void declare(Archive& a, RunsSpec& spec) {
  declare_lists(a, spec.compressions, spec.steps);
  declare(a, spec.start);
  a(methods_setting(spec.methods));
}

void declare(Archive& a, JacobianSpec& spec) {
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

}  // namespace fw::study
