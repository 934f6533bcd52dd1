#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "ode/integrator.hpp"
#include "settings/description.hpp"
#include "settings/reader.hpp"
#include "study/catalog.hpp"
#include "study/result.hpp"
#include "study/summary_row.hpp"
#include "text/checked_table.hpp"

namespace fw::study {

/// What a case may ask its surroundings while it runs.
struct RunContext {
  /// The user's interrupt; a case then stops and is not kept.
  StopToken stop{};
  /// Directory of certified references that were computed before; empty: none are kept.
  std::filesystem::path reference_cache{};
  /// Takes the warnings of the runs, a text per run (`Solution::warnings`), empty where there are none. Null: nobody.
  std::vector<std::string>* warnings = nullptr;

  /// `integrator.solve` under the token. Throws Interrupted where that stopped the run.
  Solution solve(const Integrator& integrator, const Ivp& ivp, const StepControl& control,
                 Observer& observer) const;
  /// Throws Interrupted if the user has asked to stop: for work that is no run, and after runs that others
  /// made under the token.
  void check() const;
};

/// Thrown by the context inside a case when the user has interrupted it; the runner drops the case.
struct Interrupted {};

/// One case of a study: what identifies it and how to run it. `run` is a pure function of the plan (timings
/// aside); a numerical failure is a verdict of its result, not an exception.
struct PlannedCase {
  std::string id;        ///< unique in the study, usable as a group name
  std::string identity;  ///< the resolved case as text: equal text, equal result
  std::function<CaseResult(const RunContext&)> run;
  /// Its seconds are results: it never runs beside another case, and on one processor.
  bool is_timed = false;
  std::vector<SummaryCell> parameters{};  ///< those of its result
  /// Cells of its row that are known before it runs, name and value: problem, method and the like. The row of
  /// a case that could not be computed has them, so that it says what failed.
  std::vector<std::pair<std::string, CellValue>> known{};
};

/// A study that has been read and checked completely, ready to run.
struct Plan {
  std::string kind;
  std::string title;
  std::string spec;  ///< the resolved input as TOML text
  std::int64_t seed = 0;
  bool quick = false;                    ///< shrunk by its own [quick] section
  double time_limit = 0.0;               ///< [s] of one case; 0: none
  std::vector<std::string> warnings{};   ///< what is legal but has no effect, one sentence each
  std::vector<SummaryColumn> summary{};  ///< the columns that every case has
  std::vector<PlannedCase> cases{};
  /// What only all cases together tell, such as a front over methods: fills in columns and cells after the
  /// last case, from the cases that there are. It runs again on cases that an earlier run kept, so that it
  /// has to replace what it wrote. Empty: nothing.
  std::function<void(StudyResult&)> conclude{};
};

/// The keys that every study has beside those of its kind.
struct StudyHeader {
  std::string kind{};
  std::string title{};
  std::int64_t seed = 0;    ///< of all random numbers
  double time_limit = 0.0;  ///< [s] of one case; 0: none
};
void declare(settings::Archive& a, StudyHeader& header);

/// What a kind makes its plan from, beside what its declaration has read.
struct StudyInput {
  const CheckedTable& file;  ///< for messages that name a key and its line
  TomlTree resolved;         ///< the file's values and the defaults; takes defaults that are worked out later
  const Catalog& catalog;
  bool is_quick = false;

  /// The section, for messages about it, whether or not the file has it.
  CheckedTable section(const char* name) const {
    return file.has(name) ? file.table(name) : file.empty_table(name);
  }
};

/// One kind of study: what its specification may say, and how it becomes a plan. Made by `declared_kind`.
struct StudyKind {
  std::string name;
  std::string title;
  std::string description;
  std::vector<SummaryColumn> summary{};  ///< `columns_of` the row that its cases have
  std::string verdict_meaning{};         ///< when a verdict is what, in Markdown
  std::string reason_meaning{};
  /// Every key of a study file of this kind.
  std::function<settings::SectionDescription()> describe{};
  /// Reads a specification, of which `quick` applies the study's own [quick] section. Throws InputError.
  std::function<void(const CheckedTable& spec, const Catalog& catalog, bool quick, Plan& plan)> read{};
};

namespace detail {
/// A whole study file.
template <class Spec>
struct StudyFile {
  StudyHeader header;
  Spec spec;
};
template <class Spec>
void declare(settings::Archive& a, StudyFile<Spec>& file) {
  declare(a, file.header);
  declare(a, file.spec);
}
}  // namespace detail

/// A kind whose keys are those that `declare(settings::Archive&, Spec&)` names; `plan` checks what one value
/// demands of another and makes the cases.
template <class Spec>
StudyKind declared_kind(
    StudyKind facts, std::function<void(const Spec& spec, const StudyInput& input, Plan& plan)> plan_cases) {
  facts.describe = [name = facts.name, text = facts.description] {
    detail::StudyFile<Spec> file{.header = {.kind = name}, .spec = {}};
    settings::Describer describer({.name = name, .doc = text});
    declare(describer, file);
    return describer.description();
  };
  facts.read = [name = facts.name, plan_cases = std::move(plan_cases)](
                   const CheckedTable& spec, const Catalog& catalog, bool quick, Plan& plan) {
    detail::StudyFile<Spec> file{.header = {.kind = name}, .spec = {}};
    const StudyInput input{spec, settings::read(spec, file, quick), catalog, quick};
    plan.title = file.header.title;
    plan.seed = file.header.seed;
    plan.time_limit = file.header.time_limit;
    plan_cases(file.spec, input, plan);
    for (PlannedCase& planned : plan.cases) planned.identity += "\nseed = " + std::to_string(plan.seed);
    plan.spec = input.resolved.text();
  };
  return facts;
}

/// Reads a study file of one of `kinds`; everything is checked before anything runs. Throws InputError.
Plan read_plan(const CheckedTable& spec, const std::vector<StudyKind>& kinds, const Catalog& catalog,
               bool quick);

/// A name that is fit for a group: letters, digits, and any of _.-:=,[] stay, everything else becomes '_'.
std::string group_name(const std::string& text);

}  // namespace fw::study
