#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "ode/integrator.hpp"
#include "study/catalog.hpp"
#include "study/result.hpp"
#include "text/checked_table.hpp"

namespace fw::study {

/// What a case may ask its surroundings while it runs.
struct RunContext {
  /// The user's interrupt; a case then stops and is not kept.
  StopToken stop{};
  /// Directory of certified references that were computed before; empty: none are kept.
  std::filesystem::path reference_cache{};

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
  /// Cells of the summary that are known before it runs, for the row of a case that cannot be computed.
  std::vector<SummaryCell> facts{};
};

/// A study that has been read and checked completely, ready to run.
struct Plan {
  std::string kind;
  std::string title;
  std::string spec;  ///< the resolved input as TOML text
  std::int64_t seed = 0;
  bool quick = false;                   ///< shrunk by its own [quick] section
  double time_limit = 0.0;              ///< [s] of one case; 0: none
  std::vector<std::string> warnings{};  ///< what is legal but has no effect, one sentence each
  std::vector<PlannedCase> cases{};
  /// What only all cases together tell, such as a front over methods: fills in columns and cells after the
  /// last case, from the cases that there are. It runs again on cases that an earlier run kept, so that it
  /// has to replace what it wrote. Empty: nothing.
  std::function<void(StudyResult&)> conclude{};
};

/// One kind of study: reads its specification into a plan. `quick` applies the study's own [quick] section.
struct StudyKind {
  std::string name;
  std::string title;
  std::string description;
  std::function<void(const CheckedTable& spec, const Catalog& catalog, bool quick, Plan& plan)> read;
};

/// Reads a study file of one of `kinds`; everything is checked before anything runs. Throws InputError.
Plan read_plan(const CheckedTable& spec, const std::vector<StudyKind>& kinds, const Catalog& catalog,
               bool quick);

/// A name that is fit for a group: letters, digits, and any of _.-:=,[] stay, everything else becomes '_'.
std::string group_name(const std::string& text);

}  // namespace fw::study
