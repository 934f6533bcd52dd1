#include "study/runner.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <limits>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>

#include "core/error.hpp"
#include "core/sha256.hpp"

namespace fw::study {

namespace {

/// Gives cases that ended by an exception the columns of one that went well, so that the summary stays a
/// table.
void complete_rows(StudyResult& study) {
  const auto is_complete = [](const CaseResult& result) { return !result.summary.empty(); };
  const auto model = std::find_if(study.cases.begin(), study.cases.end(), is_complete);
  const std::vector<SummaryCell> columns =
      model != study.cases.end()
          ? model->summary
          : std::vector<SummaryCell>{{"verdict", "", std::string()}, {"reason", "", std::string()}};
  for (CaseResult& result : study.cases) {
    if (is_complete(result)) continue;
    for (SummaryCell cell : columns) {
      if (cell.name == "verdict") {
        cell.value = std::string(to_string(result.verdict));
      } else if (cell.name == "reason") {
        cell.value = result.reason;
      } else if (std::holds_alternative<double>(cell.value)) {
        cell.value = std::numeric_limits<double>::quiet_NaN();
      } else if (std::holds_alternative<std::int64_t>(cell.value)) {
        cell.value = std::int64_t{0};
      } else {
        cell.value = std::string();
      }
      result.summary.push_back(std::move(cell));
    }
  }
}

/// The run of one plan, shared by its threads.
class Run {
 public:
  Run(const Plan& plan, CaseArchive& archive, const RunOptions& options)
      : plan_(plan), archive_(archive), options_(options), results_(plan.cases.size()) {}

  /// Takes one case after the other until none is left, the user interrupts or the archive fails.
  void work() {
    while (!stopped_ && !options_.context.is_interrupted()) {
      const std::size_t index = next_++;
      if (index >= plan_.cases.size()) return;
      try {
        run_case(index);
      } catch (const Interrupted&) {
        return;
      } catch (...) {
        const std::lock_guard lock(mutex_);
        if (!failure_) failure_ = std::current_exception();
        stopped_ = true;
      }
    }
  }

  StudyResult result() {
    if (failure_) std::rethrow_exception(failure_);
    StudyResult study{.kind = plan_.kind,
                      .title = plan_.title,
                      .spec = plan_.spec,
                      .seed = plan_.seed,
                      .complete = true,
                      .cases = {}};
    for (std::optional<CaseResult>& result : results_) {
      if (result) {
        study.cases.push_back(std::move(*result));
      } else {
        study.complete = false;
      }
    }
    complete_rows(study);
    return study;
  }

 private:
  void run_case(std::size_t index) {
    const PlannedCase& planned = plan_.cases[index];
    const std::string key = sha256_hex(options_.program + "\n" + planned.id + "\n" + planned.identity);
    if (!options_.force) {
      if (std::optional<CaseResult> kept = archive_.find(key)) {
        finish(index, std::move(*kept), true, 0.0);
        return;
      }
    }
    if (options_.started) {
      const std::lock_guard lock(mutex_);
      options_.started(index, plan_.cases.size(), planned.id);
    }
    const auto start = std::chrono::steady_clock::now();
    CaseResult result;
    bool archivable = true;
    try {
      result = planned.run(options_.context);
    } catch (const std::exception& error) {
      result.verdict = Verdict::fails;
      result.reason = error.what();
      archivable = false;  // the reason may be gone at the next try
    }
    result.id = planned.id;
    result.key = key;
    if (archivable) archive_.keep(result);
    finish(index, std::move(result), false,
           std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }

  void finish(std::size_t index, CaseResult result, bool kept, double seconds) {
    const std::lock_guard lock(mutex_);
    results_[index] = std::move(result);
    if (options_.finished) options_.finished({index, plan_.cases.size(), *results_[index], kept, seconds});
  }

  const Plan& plan_;
  CaseArchive& archive_;
  const RunOptions& options_;
  std::vector<std::optional<CaseResult>> results_;
  std::atomic<std::size_t> next_{0};
  std::atomic<bool> stopped_{false};
  std::mutex mutex_;
  std::exception_ptr failure_;
};

}  // namespace

StudyResult run_plan(const Plan& plan, CaseArchive& archive, const RunOptions& options) {
  Run run(plan, archive, options);
  std::vector<std::thread> threads;
  const auto useful = static_cast<std::size_t>(std::max(options.jobs, 1));
  for (std::size_t job = 1; job < std::min(useful, plan.cases.size()); ++job) {
    try {
      threads.emplace_back([&run] { run.work(); });
    } catch (const std::system_error&) {
      break;  // the machine has no more threads; those there are do all the work
    }
  }
  run.work();
  for (std::thread& thread : threads) thread.join();
  StudyResult study = run.result();
  if (plan.conclude) plan.conclude(study);
  return study;
}

}  // namespace fw::study
