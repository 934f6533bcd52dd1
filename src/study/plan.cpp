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
  return solution;
}

void RunContext::check() const {
  if (stop.stop_requested()) throw Interrupted{};
}

Plan read_plan(const CheckedTable& spec, const std::vector<StudyKind>& kinds, const Catalog& catalog,
               bool quick) {
  std::vector<std::string> names;
  names.reserve(kinds.size());
  for (const StudyKind& kind : kinds) names.push_back(kind.name);
  Plan plan;
  plan.kind = spec.choice("kind", names);
  plan.title = spec.string("title");
  plan.quick = quick;
  plan.seed = spec.integer_or("seed", 0, 0);
  plan.time_limit = spec.number_or("time_limit", 0.0, NumberRule::nonnegative);
  for (const StudyKind& kind : kinds) {
    if (kind.name == plan.kind) kind.read(spec, catalog, quick, plan);
  }
  spec.finish();
  std::set<std::string> ids;
  for (const PlannedCase& planned : plan.cases) {
    if (!ids.insert(planned.id).second) {
      throw InputError(fmt::format("{}: the case \"{}\" appears twice; give its problem another label",
                                   spec.source_name(), planned.id));
    }
  }
  plan.spec = spec.to_toml_text();
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
