#include "study/runner.hpp"

#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <chrono>
#include <deque>
#include <exception>
#include <limits>
#include <map>
#include <memory>
#include <new>
#include <optional>
#include <system_error>

#include "core/error.hpp"
#include "linalg/petsc_running.hpp"
#include "ode/not_applicable.hpp"
#include "study/case_message.hpp"
#include "system/sha256.hpp"
#include "system/worker_process.hpp"

namespace fw::study {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// The first letter of a worker's answer.
constexpr char is_result = 'r', is_failure = 'f', is_interrupted = 'i', is_not_applicable = 'n';

/// What a verdict rests on in doubtful runs: how many there were, and what is wrong with the last, which is mostly
/// the finest.
std::string doubts_of(const std::vector<std::string>& warnings) {
  const auto doubtful = std::ranges::count_if(warnings, [](const std::string& text) { return !text.empty(); });
  if (doubtful == 0) return "";
  const auto last = std::find_if(warnings.rbegin(), warnings.rend(), [](const auto& text) { return !text.empty(); });
  return fmt::format("; warning of {} of {} runs: {}", doubtful, warnings.size(), *last);
}

/// Runs a case in the worker; whatever happens is an answer.
std::string answer_of(const PlannedCase& planned, const RunContext& context) {
  try {
    std::vector<std::string> warnings;
    RunContext watched = context;
    watched.warnings = &warnings;
    CaseResult result = planned.run(watched);
    result.reason += doubts_of(warnings);
    return is_result + encode(result);
  } catch (const Interrupted&) {
    return std::string(1, is_interrupted);
  } catch (const NotApplicable& error) {
    return is_not_applicable + std::string(error.what());
  } catch (const std::bad_alloc&) {
    return is_failure + std::string("out of memory");
  } catch (const std::exception& error) {
    return is_failure + std::string(error.what());
  } catch (...) {
    return is_failure + std::string("an exception of unknown type");
  }
}

/// The run of one plan.
class Run {
 public:
  Run(const Plan& plan, CaseArchive& archive, const RunOptions& options)
      : plan_(plan),
        archive_(archive),
        options_(options),
        time_limit_(options.time_limit.value_or(plan.time_limit)),
        results_(plan.cases.size()) {}

  StudyResult run() {
    take_kept_cases();
    if (linalg::petsc_is_running()) {
      throw SystemError("PETSc was started before the workers of a study; its cases cannot run");
    }
    const auto jobs = static_cast<std::size_t>(std::max(options_.jobs, 1));
    work(untimed_, jobs);
    work(timed_, 1);
    return result();
  }

 private:
  /// A worker and what it does at the moment.
  struct WorkerSlot {
    std::unique_ptr<WorkerProcess> worker;
    std::optional<std::size_t> index{};
    Clock::time_point start{};
  };

  std::string key_of(const PlannedCase& planned) const {
    return sha256_hex(options_.program + "\n" + planned.id + "\n" + planned.identity);
  }

  void take_kept_cases() {
    for (std::size_t index = 0; index < plan_.cases.size(); ++index) {
      const PlannedCase& planned = plan_.cases[index];
      std::optional<CaseResult> kept;
      if (!options_.force) kept = archive_.find(key_of(planned));
      if (kept) {
        finish(index, std::move(*kept), {.kept = true});
      } else {
        (planned.is_timed ? timed_ : untimed_).push_back(index);
      }
    }
  }

  void start_worker(std::vector<WorkerSlot>& slots) {
    slots.push_back(
        {std::make_unique<WorkerProcess>([this](std::size_t index, const std::atomic<bool>& interrupted) {
          RunContext context = options_.context;
          context.stop = StopToken(interrupted);
          return answer_of(plan_.cases[index], context);
        })});
  }

  /// Assigns cases to workers that have none, starting workers as needed, at most `jobs`.
  void dispatch(std::deque<std::size_t>& queue, std::vector<WorkerSlot>& slots, std::size_t jobs) {
    while (!queue.empty() && !options_.context.stop.stop_requested()) {
      auto idle =
          std::find_if(slots.begin(), slots.end(), [](const WorkerSlot& slot) { return !slot.index; });
      if (idle == slots.end()) {
        if (slots.size() >= jobs) return;
        try {
          start_worker(slots);
        } catch (const std::system_error& error) {
          // Those there are do all the work.
          if (slots.empty()) throw SystemError(error.what());
          return;
        }
        idle = slots.end() - 1;
      }
      idle->index = queue.front();
      idle->start = Clock::now();
      idle->worker->assign({queue.front(), plan_.cases[queue.front()].is_timed});
      queue.pop_front();
    }
  }

  /// Takes one case after the other until none is left or the user interrupts.
  void work(std::deque<std::size_t> queue, std::size_t jobs) {
    std::vector<WorkerSlot> slots;
    std::optional<Clock::time_point> interrupted_at;
    while (true) {
      std::erase_if(slots, [](const WorkerSlot& slot) { return slot.worker->has_ended(); });
      dispatch(queue, slots, jobs);
      const bool is_busy =
          std::any_of(slots.begin(), slots.end(), [](const WorkerSlot& slot) { return slot.index; });
      if (!is_busy && (queue.empty() || options_.context.stop.stop_requested())) return;
      wait_for(slots);
      for (WorkerSlot& slot : slots) {
        if (slot.index) {
          poll_case(slot, interrupted_at);
        } else {
          slot.worker->receive();  // notices its end
        }
      }
      if (options_.context.stop.stop_requested() && !interrupted_at) {
        interrupted_at = Clock::now();
        for (const WorkerSlot& slot : slots) slot.worker->interrupt();
      }
    }
  }

  void wait_for(const std::vector<WorkerSlot>& slots) {
    std::vector<pollfd> watched;
    watched.reserve(slots.size());
    for (const WorkerSlot& slot : slots) watched.push_back({slot.worker->descriptor(), POLLIN, 0});
    ::poll(watched.data(), watched.size(), 100);
    if (!options_.waiting) return;
    RunProgress progress{.done = done_, .total = plan_.cases.size()};
    for (const WorkerSlot& slot : slots) {
      if (slot.index) progress.running.push_back(plan_.cases[*slot.index].id);
    }
    options_.waiting(progress);
  }

  void poll_case(WorkerSlot& slot, const std::optional<Clock::time_point>& interrupted_at) {
    const std::size_t index = *slot.index;
    const double seconds = seconds_since(slot.start);
    if (const std::optional<std::string> answer = slot.worker->receive()) {
      slot.index.reset();
      take(index, *answer, seconds);
    } else if (slot.worker->has_ended()) {
      slot.index.reset();
      fail(index, "the process of this case " + slot.worker->how_it_ended(), seconds);
    } else if (time_limit_ > 0.0 && seconds > time_limit_) {
      slot.worker->end();
      slot.index.reset();
      fail(index, fmt::format("ran past its time limit of {} s", time_limit_), seconds);
    } else if (interrupted_at && seconds_since(*interrupted_at) > options_.patience) {
      slot.worker->end();
      slot.index.reset();
    }
  }

  void take(std::size_t index, const std::string& answer, double seconds) {
    if (answer.empty() || answer.front() == is_interrupted) return;
    if (answer.front() == is_failure) return fail(index, answer.substr(1), seconds);
    if (answer.front() == is_not_applicable) return leave_out(index, answer.substr(1), seconds);
    CaseResult result = decode(std::string_view(answer).substr(1));
    if (const std::string wrong = row_mismatch(plan_.summary, result.summary); !wrong.empty()) {
      return fail(index, "its row of the summary is not the one of its kind: " + wrong, seconds);
    }
    result.id = plan_.cases[index].id;
    result.parameters = plan_.cases[index].parameters;
    result.key = key_of(plan_.cases[index]);
    archive_.keep(result);
    finish(index, std::move(result), {.seconds = seconds});
  }

  /// A case that could not be computed has no key: it is tried again next time, when the reason may be gone.
  CaseResult without_numbers(std::size_t index, Verdict verdict, std::string reason) const {
    CaseResult result;
    result.id = plan_.cases[index].id;
    result.parameters = plan_.cases[index].parameters;
    result.summary = missing_row(plan_.summary, plan_.cases[index].known);
    result.verdict = verdict;
    result.reason = std::move(reason);
    return result;
  }

  void fail(std::size_t index, std::string reason, double seconds) {
    finish(index, without_numbers(index, Verdict::fails, std::move(reason)),
           {.computed = false, .seconds = seconds});
  }

  /// The system lacks what the method needs: no finding, and no failure of the program either.
  void leave_out(std::size_t index, std::string reason, double seconds) {
    finish(index, without_numbers(index, Verdict::not_applicable, std::move(reason)), {.seconds = seconds});
  }

  struct Outcome {
    bool kept = false, computed = true;
    double seconds = 0.0;
  };

  void finish(std::size_t index, CaseResult result, Outcome outcome) {
    ++done_;
    results_[index] = std::move(result);
    if (!options_.finished) return;
    options_.finished(
        {index, plan_.cases.size(), *results_[index], outcome.kept, outcome.computed, outcome.seconds});
  }

  StudyResult result() {
    StudyResult study{.kind = plan_.kind,
                      .title = plan_.title,
                      .spec = plan_.spec,
                      .seed = plan_.seed,
                      .quick = plan_.quick,
                      .complete = true,
                      .cases = {}};
    for (std::optional<CaseResult>& result : results_) {
      if (result) {
        study.cases.push_back(std::move(*result));
      } else {
        study.complete = false;
      }
    }
    return study;
  }

  const Plan& plan_;
  CaseArchive& archive_;
  const RunOptions& options_;
  double time_limit_;
  std::vector<std::optional<CaseResult>> results_;
  std::deque<std::size_t> untimed_, timed_;
  std::size_t done_ = 0;
};

}  // namespace

StudyResult run_plan(const Plan& plan, CaseArchive& archive, const RunOptions& options) {
  StudyResult study = Run(plan, archive, options).run();
  if (plan.conclude) plan.conclude(study);
  return study;
}

}  // namespace fw::study
