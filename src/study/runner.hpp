#pragma once

#include <functional>
#include <optional>

#include "study/case_archive.hpp"
#include "study/plan.hpp"

namespace fw::study {

/// What the runner tells of a case that has finished.
struct CaseReport {
  std::size_t index = 0;  ///< of the case in the plan, from 0
  std::size_t total = 0;
  const CaseResult& result;
  bool kept = false;     ///< found in the archive, not run again
  bool computed = true;  ///< false: it ended by an exception, a crash or its time limit, and `reason` says so
  double seconds = 0.0;
};

/// A case that runs, for so long, and the stage that it has told of.
struct RunningCase {
  std::string id;
  double seconds = 0.0;
  std::optional<CaseStage> stage{};
  double stage_seconds = 0.0;  ///< since the stage began
};

/// What the runner tells while cases run.
struct RunProgress {
  std::size_t done = 0, total = 0;
  std::vector<RunningCase> running{};  ///< the oldest first
};

struct RunOptions {
  RunContext context;
  std::string program;                 ///< identity of the executable: other code, other cases
  bool force = false;                  ///< run also what the archive holds
  int jobs = 1;                        ///< cases that run at the same time, those that are timed excepted
  std::optional<double> time_limit{};  ///< [s] of one case, in place of the plan's; 0: none
  double patience = 5.0;  ///< [s] that a case has to react to the user's interrupt before it is ended
  std::function<void(const RunProgress&)> waiting{};  ///< about ten times a second
  std::function<void(const CaseReport&)> finished{};
};

/// Runs the cases of a plan in worker processes, `jobs` at a time, and keeps each in the archive as soon as
/// it is finished; timed cases come last, one at a time and on one processor. A case that throws, crashes or
/// runs past its time limit fails with the reason and is not kept, one that throws NotApplicable is not
/// applicable with its reason; the others go on. The row of either names what is known of the case. The result does not
/// depend on `jobs`, timings aside. `waiting` and `finished` are called by the calling thread. After an
/// interrupt the result is incomplete. Throws SystemError if the archive cannot keep a case or no worker can
/// be started.
StudyResult run_plan(const Plan& plan, CaseArchive& archive, const RunOptions& options);

}  // namespace fw::study
