#include "study/plan.hpp"

#include "core/error.hpp"

#include <fmt/format.h>

#include <cctype>
#include <set>

namespace fw::study {

Solution RunContext::solve(const Integrator& integrator, const Ivp& ivp, const StepControl& control,
                           Observer& observer) const {
  Solution solution = integrator.solve(ivp, control, observer, {.stop = stop});
  if (solution.status.code == StatusCode::interrupted) throw Interrupted{};
  if (warnings != nullptr) warnings->push_back(fmt::format("{}", fmt::join(solution.warnings, "; ")));
  return solution;
}

void RunContext::check() const {
  if (stop.stop_requested()) throw Interrupted{};
}

void declare(settings::Archive& a, StudyHeader& header) {
  using settings::setting;
  a(setting("kind", header.kind).required().choices({header.kind}).doc("the kind of study"));
  a(setting("title", header.title).required().doc("for people"));
  a(setting("seed", header.seed)
        .at_least(0)
        .doc("of all random numbers of the study; stored with the result"));
  a(setting("time_limit", header.time_limit)
        .nonnegative()
        .unit("s")
        .doc("time after which a case is ended; 0: never"));
}

Plan read_plan(const CheckedTable& spec, const std::vector<StudyKind>& kinds, const Catalog& catalog,
               bool quick) {
  std::vector<std::string> names;
  names.reserve(kinds.size());
  for (const StudyKind& kind : kinds) names.push_back(kind.name);
  Plan plan;
  plan.kind = spec.choice("kind", names);
  plan.quick = quick;
  for (const StudyKind& kind : kinds) {
    if (kind.name != plan.kind) continue;
    plan.summary = kind.summary;
    kind.read(spec, catalog, quick, plan);
  }
  std::set<std::string> ids;
  for (const PlannedCase& planned : plan.cases) {
    if (!ids.insert(planned.id).second) {
      throw InputError(fmt::format("{}: the case \"{}\" appears twice; give its problem another label",
                                   spec.source_name(), planned.id));
    }
  }
  return plan;
}

std::string group_name(const std::string& text) {
  std::string name = text;
  for (char& letter : name) {
    const bool keeps = std::isalnum(static_cast<unsigned char>(letter)) ||
                       std::string_view("_.-:=,[]").find(letter) != std::string_view::npos;
    if (!keeps) letter = '_';
  }
  return name;
}

}  // namespace fw::study
