#pragma once

#include <functional>

#include "study/case_archive.hpp"
#include "study/plan.hpp"

namespace fw::study {

/// What the runner tells of a case that has finished.
struct CaseReport {
  std::size_t index = 0;  ///< of the case in the plan, from 0
  std::size_t total = 0;
  const CaseResult& result;
  bool kept = false;  ///< found in the archive, not run again
  double seconds = 0.0;
};

struct RunOptions {
  RunContext context;
  std::string program;  ///< identity of the executable: other code, other cases
  bool force = false;   ///< run also what the archive holds
  int jobs = 1;         ///< cases that run at the same time; timings are honest with 1 only
  std::function<void(std::size_t index, std::size_t total, const std::string& id)> started;
  std::function<void(const CaseReport&)> finished;
};

/// Runs the cases of a plan, `jobs` at a time, and keeps each in the archive as soon as it is finished. A
/// case that throws is a case that fails with the exception's text; the others go on. The result does not
/// depend on `jobs`, timings aside. `started` and `finished` are called one at a time. After an interrupt the
/// result is incomplete. Throws SystemError only if the archive cannot keep a case.
StudyResult run_plan(const Plan& plan, CaseArchive& archive, const RunOptions& options);

}  // namespace fw::study
