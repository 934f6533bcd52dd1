#include "study/kinds/convergence.hpp"

#include <memory>
#include <optional>

#include "settings/identity_text.hpp"
#include "study/kinds/convergence_case.hpp"
#include "study/problem_spec.hpp"
#include "study/shared_problem.hpp"

namespace fw::study {

namespace {

using settings::Archive;

struct ConvergenceSpec {
  std::vector<std::string> methods;
  ConvergenceSettings settings;
  std::optional<ReferenceArithmetic> arithmetic;
  std::vector<ProblemSpec> problems;
};

/// The section [convergence], of which one key is no setting of the measurement.
struct ConvergenceSection {
  ConvergenceSpec& spec;
};

void declare(Archive& a, ConvergenceSection& section) {
  declare(a, section.spec.settings);
  a(reference_setting(section.spec.arithmetic)
        .doc("`binary64` for systems too large for it: two methods of orders 8 and 7 in double, about 9 "
             "digits"));
}

void declare(Archive& a, ConvergenceSpec& spec) {
  a(methods_setting(spec.methods));
  ConvergenceSection section{spec};
  a.section({"convergence", "How orders are measured."}, section);
  a.sections(problem_sections, spec.problems);
  a.quick_section();
}

void plan_convergence(const ConvergenceSpec& spec, const StudyInput& input, Plan& plan) {
  const ConvergenceSettings& settings = spec.settings;
  const ReferenceArithmetic arithmetic = spec.arithmetic.value_or(ReferenceArithmetic::binary128);
  std::string identity = settings::identity_text(settings);
  if (arithmetic != ReferenceArithmetic::binary128) identity += "reference = " + to_string(arithmetic) + "\n";
  const std::vector<std::string>& methods = checked_methods(spec.methods, input.file, input.catalog);
  for (StudyProblem& entry : make_problems(spec.problems, input, plan.warnings)) {
    const auto problem = std::make_shared<const SharedProblem>(std::move(entry), arithmetic);
    for (std::size_t i = 0; i < methods.size(); ++i) {
      const std::string& call = methods[i];
      const std::shared_ptr<const Integrator> integrator = input.catalog.method(call);
      require_fixed_step(input.file, i, call, integrator->info());
      plan.cases.push_back(
          {.id = group_name(problem->entry().label + "-" + call),
           .identity = "convergence\n" + problem->entry().identity + "method = " + call + "\n" + identity,
           .run =
               [problem, call, integrator, settings](const RunContext& context) {
                 return run_convergence(*problem, call, *integrator, settings, context);
               },
           .known = {{"problem", problem->entry().label}, {"method", call}}});
    }
  }
}

}  // namespace

StudyKind convergence_kind() {
  return declared_kind<ConvergenceSpec>(
      {.name = "convergence",
       .title = "Observed order of accuracy",
       .description =
           "error against step for every method on every problem, fitted order with a 95 % interval",
       .summary = columns_of<ConvergenceRow>(),
       .verdict_meaning = "",
       .reason_meaning = ""},
      plan_convergence);
}

}  // namespace fw::study
