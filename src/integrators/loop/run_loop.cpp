#include "integrators/loop/run_loop.hpp"

#include <fmt/format.h>

#include <optional>

#include "core/error.hpp"
#include "core/run_clock.hpp"
#include "core/work_counters.hpp"
#include "integrators/loop/hermite_interpolant.hpp"
#include "integrators/loop/progress_watch.hpp"
#include "integrators/loop/run_checks.hpp"
#include "integrators/loop/switch_guard.hpp"

namespace fw::integrators {

namespace {

void serialise(StateArchive& archive, Work& work) {
  for (const WorkCounter& counter : work_counters) archive.visit(counter.words, work.*counter.count);
  archive.visit("seconds", work.seconds);
}

/// One run on its way.
class Loop {
 public:
  Loop(const MethodInfo& info, const Ivp& ivp, Observer& observer, const SolveOptions& options,
       std::uint64_t maximum_steps)
      : info_(info), ivp_(ivp), observer_(observer), options_(options), maximum_steps_(maximum_steps) {}

  Solution run(const StepSourceFactory& make_source) {
    solution_.time = ivp_.t0;
    solution_.state = ivp_.y0;
    const std::function<void(double, VectorRef)> nothing_yet;
    if (options_.resume.empty() && !observer_.observe({0, ivp_.t0, ivp_.y0, false, nothing_yet})) {
      solution_.status = {StatusCode::stopped_by_observer, "stopped at the start"};
      return std::move(solution_);
    }
    const std::unique_ptr<StepSource> source = make_source(solution_.work);
    guard_.emplace(ivp_, *source, options_);
    progress_.emplace(info_, ivp_, source->tolerances());
    if (!options_.resume.empty()) load(*source);
    if (options_.checkpoints != nullptr) save(*source);  // refused now rather than after an hour
    solution_.status = advance(*source);
    source->collect_work(solution_.work);
    guard_->report(solution_);
    return std::move(solution_);
  }

 private:
  Status advance(StepSource& source) {
    Vector y_new(ivp_.y0.size()), as_made;
    const bool has_dense_output = source.has_dense_output();
    HermiteInterpolant hermite(*ivp_.system, solution_.work);
    const std::function<void(double, VectorRef)> interpolate = [&](double t, VectorRef out) {
      if (has_dense_output) {
        source.interpolate(t, out);
      } else {
        hermite(t, out);
      }
    };
    double& t = solution_.time;
    Vector& y = solution_.state;
    for (;;) {
      if (options_.stop.stop_requested()) {
        return {StatusCode::interrupted, fmt::format("interrupted by the user at t = {:.6g}", t)};
      }
      LoopStep step{.index = steps_ + 1, .start = t, .limit = guard_->limit()};
      if (Status status = source.propose(step); !status.ok()) return status;
      if (steps_ + solution_.work.rejected_steps >= maximum_steps_) {
        return {StatusCode::step_limit,
                fmt::format("{} steps did not reach the end: stopped at t = {:.6g}", maximum_steps_, t)};
      }
      if (Status status = source.attempt(step, y, y_new); !status.ok()) return status;
      if (!step.is_accepted) continue;
      if (step.is_last) step.end = ivp_.t1;
      if (Status status = check_state(y_new, step.end, step.index); !status.ok()) return status;
      if (Status status = progress_->judge(step, y, y_new); !status.ok()) return status;
      const SwitchGuard::Verdict verdict = guard_->judge(step, y, y_new);
      if (verdict == SwitchGuard::Verdict::again) {
        ++solution_.work.rejected_steps;
        source.take_back(t, y);
        continue;
      }
      source.accept(step);
      ++steps_;
      ++solution_.work.accepted_steps;

      Change change = Change::none;
      if (options_.hook != nullptr) {
        as_made = y_new;
        change = options_.hook->on_accepted(step.end, y_new);
        if (Status status = check_state(y_new, step.end, step.index); !status.ok()) return status;
      }
      const ConstVectorRef end = options_.hook != nullptr ? as_made : y_new;
      if (has_dense_output) {
        source.set_ends(y, end);
      } else {
        hermite.set_step(step.start, step.end, y, end);
      }
      const bool go_on = observer_.observe({steps_, step.end, y_new, step.is_last, interpolate});
      t = step.end;
      y.swap(y_new);
      if (step.is_last) return {};
      if (!go_on) return {StatusCode::stopped_by_observer, fmt::format("stopped at t = {:.6g}", t)};
      if (verdict == SwitchGuard::Verdict::chatters) return chatter();
      if (change != Change::none || verdict == SwitchGuard::Verdict::crossed) source.restart(t, y);
      if (verdict == SwitchGuard::Verdict::crossed) source.shorten(guard_->limit() - t);
      if (options_.checkpoints != nullptr && options_.checkpoints->is_due(t)) {
        save(source);
        options_.checkpoints->take(t, writer_.bytes());
      }
    }
  }

  Status chatter() const {
    return {StatusCode::step_too_small,
            fmt::format("at t = {:.6g} the right-hand side switches without end, last at {}", solution_.time,
                        guard_->last())};
  }

  void save(StepSource& source) {
    writer_.clear();
    const double seconds_before = solution_.work.seconds;  // of the run that this one continues
    solution_.work.seconds += clock_.seconds();
    serialise(writer_, source);
    solution_.work.seconds = seconds_before;
  }

  void load(StepSource& source) {
    StateReader reader(options_.resume);
    serialise(reader, source);
    reader.finish();
  }

  void serialise(StateArchive& archive, StepSource& source) {
    archive.require_equal("method", info_.name);
    archive.require_equal("start", ivp_.t0);
    archive.require_equal("end time", ivp_.t1);
    archive.visit("time", solution_.time);
    archive.visit("state", solution_.state);
    archive.visit("steps", steps_);
    progress_->serialise(archive);
    guard_->serialise(archive);
    source.serialise(archive);
    // Last: what a source evaluates to put itself back is not counted.
    integrators::serialise(archive, solution_.work);
  }

  const RunClock clock_;
  const MethodInfo& info_;
  const Ivp& ivp_;
  Observer& observer_;
  const SolveOptions& options_;
  std::uint64_t maximum_steps_;
  std::uint64_t steps_ = 0;
  std::optional<SwitchGuard> guard_;
  std::optional<ProgressWatch> progress_;
  Solution solution_;
  StateWriter writer_;
};

}  // namespace

Solution run_loop(const MethodInfo& info, const Ivp& ivp, const StepSourceFactory& make_source,
                  Observer& observer, const SolveOptions& options, std::uint64_t maximum_steps) {
  return Loop(info, ivp, observer, options, maximum_steps).run(make_source);
}

}  // namespace fw::integrators
