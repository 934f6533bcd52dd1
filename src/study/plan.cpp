#include "study/plan.hpp"

#include "core/error.hpp"

#include <fmt/format.h>

#include <cctype>
#include <map>

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

namespace {

/// The text of the case's cell `name` that is known before it runs; empty: it has none.
std::string known_text(const PlannedCase& planned, std::string_view name) {
  for (const auto& [known, value] : planned.known) {
    const auto* text = std::get_if<std::string>(&value);
    if (known == name && text != nullptr) return *text;
  }
  return "";
}

/// Throws InputError where two cases have the same name, with what of the two is to be changed.
void check_unique(const Plan& plan, const std::string& source) {
  std::map<std::string, const PlannedCase*> known;
  for (const PlannedCase& planned : plan.cases) {
    const auto [entry, is_new] = known.emplace(planned.id, &planned);
    if (is_new) continue;
    const PlannedCase& other = *entry->second;
    const std::string method = known_text(planned, "method");
    const bool same_method = !method.empty() && method == known_text(other, "method");
    const bool same_case = planned.identity == other.identity;
    std::string mend = "give one of its problems another label";
    if (same_method && same_case) {
      mend = fmt::format("the method \"{}\" is listed twice, remove one", method);
    } else if (!method.empty() && !same_method) {
      mend = fmt::format("the methods \"{}\" and \"{}\" get the same name, remove one",
                         known_text(other, "method"), method);
    } else if (same_case) {
      mend = "an entry of a list appears twice, remove one";
    }
    throw InputError(fmt::format("{}: the case \"{}\" appears twice; {}", source, planned.id, mend));
  }
}

}  // namespace

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
  check_unique(plan, spec.source_name());
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
