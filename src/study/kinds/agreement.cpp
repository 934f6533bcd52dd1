#include "study/kinds/agreement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "settings/identity_text.hpp"
#include "study/kinds/agreement_case.hpp"
#include "study/problem_spec.hpp"

namespace fw::study {

namespace {

using settings::Archive;
using settings::setting;

struct AgreementSpec {
  MethodPatterns methods;
  AgreementSettings settings;
  std::vector<ProblemSpec> problems;
  std::int64_t quick_problems = 2;
};

void declare(Archive& a, AgreementSpec& spec) {
  declare(a, spec.methods);
  a.section({"agreement", "How far methods are refined."}, spec.settings);
  a.sections(problem_sections, spec.problems);
  a.quick_section([&] {
    if (!a.is_description()) {
      spec.quick_problems = static_cast<std::int64_t>(std::min<std::size_t>(spec.problems.size(), 2));
    }
    a(setting("problems", spec.quick_problems)
          .at_least(1)
          .default_text("at most 2")
          .doc("how many of the problems, from the first one"));
  });
}

void check(const AgreementSettings& settings, const StudyInput& input) {
  const CheckedTable table = input.section("agreement");
  if (settings.error > settings.largest_error) {
    table.fail("error", fmt::format("found {}, expected at most largest_error = {}", settings.error,
                                    settings.largest_error));
  }
  if (2 * settings.fewest_steps > settings.most_steps) {
    table.fail("fewest_steps", fmt::format("found {}, expected at most half of most_steps, which is {}{}",
                                           settings.fewest_steps, settings.most_steps,
                                           input.is_quick ? " with --quick" : ""));
  }
}

void plan_agreement(const AgreementSpec& spec, const StudyInput& input, Plan& plan) {
  const AgreementSettings& settings = spec.settings;
  check(settings, input);
  const auto given = static_cast<std::int64_t>(spec.problems.size());
  if (spec.quick_problems > given) {
    input.section("quick").fail(
        "problems", fmt::format("found {}, expected an integer from 1 to {}", spec.quick_problems, given));
  }
  std::vector<StudyProblem> problems = make_problems(spec.problems, input, plan.warnings);
  if (input.is_quick) problems.resize(static_cast<std::size_t>(spec.quick_problems));
  auto participants = std::make_shared<std::vector<Participant>>();
  std::string calls;
  for (const std::string& call : expanded(spec.methods, input)) {
    participants->push_back({call, input.catalog.method(call)});
    calls += "method = " + call + "\n";
  }
  for (StudyProblem& entry : problems) {
    const auto problem = std::make_shared<const SharedProblem>(std::move(entry));
    plan.cases.push_back(
        {.id = group_name(problem->entry().label),
         .identity = "agreement\n" + problem->entry().identity + calls + settings::identity_text(settings),
         .run =
             [problem, participants, settings](const RunContext& context) {
               return run_agreement(*problem, *participants, settings, context);
             },
         .known = {{"problem", problem->entry().label}}});
  }
}

}  // namespace

StudyKind agreement_kind() {
  return declared_kind<AgreementSpec>(
      {.name = "agreement",
       .title = "Agreement of all methods",
       .description =
           "own schemes and foreign solvers on the same problems: difference of every pair against "
           "what their error estimates allow",
       .summary = columns_of<AgreementRow>(),
       .verdict_meaning = "`holds`: no pair disagrees",
       .reason_meaning = "names the worst pair and the methods not compared"},
      plan_agreement);
}

}  // namespace fw::study
