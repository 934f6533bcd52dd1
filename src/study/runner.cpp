#include "study/runner.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <limits>
#include <optional>

#include "core/error.hpp"
#include "core/sha256.hpp"

namespace fw::study {

namespace {

/// Gives cases that ended by an exception the columns of one that went well, so that the summary stays a table.
void complete_rows(StudyResult& study) {
  const auto is_complete = [](const CaseResult& result) { return !result.summary.empty(); };
  const auto model = std::find_if(study.cases.begin(), study.cases.end(), is_complete);
  const std::vector<SummaryCell> columns =
      model != study.cases.end() ? model->summary
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
  for (CaseResult& result : study.cases) result.summary.insert(result.summary.begin(), {"case", "", result.id});
}

}  // namespace

StudyResult run_plan(const Plan& plan, CaseArchive& archive, const RunOptions& options) {
  StudyResult study{.kind = plan.kind, .title = plan.title, .spec = plan.spec, .seed = plan.seed, .complete = true, .cases = {}};
  for (std::size_t i = 0; i < plan.cases.size(); ++i) {
    const PlannedCase& planned = plan.cases[i];
    if (options.context.is_interrupted()) {
      study.complete = false;
      break;
    }
    const std::string key = sha256_hex(options.program + "\n" + planned.id + "\n" + planned.identity);
    if (!options.force) {
      if (std::optional<CaseResult> kept = archive.find(key)) {
        study.cases.push_back(std::move(*kept));
        if (options.finished) options.finished({i, plan.cases.size(), study.cases.back(), true, 0.0});
        continue;
      }
    }
    if (options.started) options.started(i, plan.cases.size(), planned.id);
    const auto start = std::chrono::steady_clock::now();
    CaseResult result;
    bool archivable = true;
    try {
      result = planned.run(options.context);
    } catch (const Interrupted&) {
      study.complete = false;
      break;
    } catch (const std::exception& error) {
      result.verdict = Verdict::fails;
      result.reason = error.what();
      archivable = false;  // the reason may be gone at the next try
    }
    result.id = planned.id;
    result.key = key;
    if (archivable) archive.keep(result);
    study.cases.push_back(std::move(result));
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (options.finished) options.finished({i, plan.cases.size(), study.cases.back(), false, seconds});
  }
  complete_rows(study);
  return study;
}

}  // namespace fw::study
