#include "oracles/foreign_stepper.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/error.hpp"
#include "core/work_counters.hpp"
#include "integrators/loop/run_loop.hpp"
#include "integrators/loop/side_steps.hpp"
#include "integrators/loop/stepper.hpp"

namespace fw::oracles {

namespace {

/// A second solver of the same library for states inside a step: one constant step to each, or a run with the
/// tolerances where the library takes no constant steps. Made when the first state is asked for.
class SideSolver {
 public:
  SideSolver(const MethodInfo& info, const ForeignStepperFactory& make_stepper, const Ivp& ivp,
             const StepControl& for_library)
      : make_stepper_(make_stepper), ivp_(ivp), control_(for_library) {
    if (info.dense_output == DenseOutput::side_steps) control_ = FixedStep{.step = ivp.t1 - ivp.t0};
    tries_whole_ = info.dense_output == DenseOutput::side_runs && !info.is_multistep;
  }

  Status reach(double t, double t_end, ConstVectorRef y, VectorRef out) {
    start(t, t_end, y);
    out = y;
    for (int steps = 0; t < t_end; ++steps) {
      if (steps == most_steps) return {StatusCode::step_limit, "too many steps inside a step"};
      if (Status status = stepper_->advance(t_end, t, out); !status.ok()) return status;
    }
    return {};
  }

  /// Adds what it has evaluated and solved. Steps are those of the run: its own are not counted.
  void collect_work(Work& work) const {
    Work done = work_;
    if (stepper_) stepper_->collect_work(done);
    done.accepted_steps = done.rejected_steps = 0;
    for (const WorkCounter& counter : work_counters) work.*counter.count += done.*counter.count;
  }

 private:
  static constexpr int most_steps = 10'000;

  /// A method without history may well reach the end in one step: the first that it tries.
  void start(double t, double t_end, ConstVectorRef y) {
    if (tries_whole_) {
      if (stepper_) stepper_->collect_work(work_);
      ivp_.t0 = t;
      ivp_.y0 = y;
      std::get<AdaptiveStep>(control_).initial_step = t_end - t;
      stepper_ = make_stepper_(ivp_, control_, work_);
    } else {
      if (!stepper_) stepper_ = make_stepper_(ivp_, control_, work_);
      stepper_->restart(t, y);
    }
  }

  const ForeignStepperFactory& make_stepper_;
  Ivp ivp_;
  StepControl control_;
  Work work_;
  bool tries_whole_ = false;
  std::unique_ptr<ForeignStepper> stepper_;
};

/// The steps of a library. They have to end at each multiple of a constant step, or at the end time only.
class ForeignSteps final : public integrators::StepSource {
 public:
  /// `for_library` is `control` with the tolerances that the library gets; it outlives the steps.
  ForeignSteps(const MethodInfo& info, const ForeignStepperFactory& make_stepper, const Ivp& ivp,
               const StepControl& control, const StepControl& for_library, Work& work)
      : info_(info),
        start_(ivp.t0),
        end_(ivp.t1),
        tolerances_(std::get_if<AdaptiveStep>(&for_library)),
        stepper_(make_stepper(ivp, for_library, work)),
        side_(info, make_stepper, ivp, for_library),
        inside_(
            *ivp.system, 0,
            [this](double t, double t_end, ConstVectorRef y, VectorRef out) {
              return side_.reach(t, t_end, y, out);
            },
            work) {
    if (const auto* fixed = std::get_if<FixedStep>(&control)) {
      step_ = fixed->step;
      total_ = integrators::count_steps_of(info, ivp, *fixed).total();
    }
  }

  Status propose(integrators::LoopStep& step) override {
    if (step_ == 0.0) {
      step.end = std::min(end_, step.limit);
    } else {
      step.end = step.index >= total_ ? end_ : start_ + static_cast<double>(step.index) * step_;
    }
    return {};
  }

  Status attempt(integrators::LoopStep& step, ConstVectorRef y, VectorRef y_new) override {
    y_new = y;
    const double limit = step.end;
    double t = step.start;
    if (Status status = stepper_->advance(limit, t, y_new); !status.ok()) return status;
    if (step_ != 0.0 && std::abs(t - limit) > 1e-6 * std::abs(limit - step.start)) {
      return {StatusCode::library_failure,
              fmt::format("at t = {:.6g} the library stepped to {:.17g} instead of {:.17g}", step.start, t,
                          limit)};
    }
    step.end = t;
    step.is_last = t >= end_;
    step.is_accepted = true;
    return {};
  }

  const AdaptiveStep* tolerances() const override { return tolerances_; }
  /// The library is past it: it starts anew.
  void take_back(double t, ConstVectorRef y) override { stepper_->restart(t, y); }
  /// The limit of the step tells the library.
  void shorten(double) override {}
  void accept(const integrators::LoopStep& step) override {
    step_start_ = step.start;
    step_end_ = step.end;
  }
  bool has_dense_output() const override { return info_.dense_output != DenseOutput::cubic_hermite; }
  void set_ends(ConstVectorRef start, ConstVectorRef end) override {
    inside_.set_step(step_start_, step_end_, start, end);
  }
  void interpolate(double t, VectorRef out) override {
    if (info_.dense_output == DenseOutput::library) {
      stepper_->interpolate(t, out);
    } else {
      inside_(t, out);
    }
  }
  void restart(double t, ConstVectorRef y) override { stepper_->restart(t, y); }
  void serialise(StateArchive&) override {
    throw InputError(
        fmt::format("method \"{}\" cannot be saved: the library does not give out its memory", info_.name));
  }
  void collect_work(Work& work) const override {
    stepper_->collect_work(work);
    side_.collect_work(work);
  }

 private:
  const MethodInfo& info_;
  double start_, end_;
  double step_ = 0.0;  ///< 0: the library chooses
  std::uint64_t total_ = 0;
  const AdaptiveStep* tolerances_;  ///< null: constant steps
  std::unique_ptr<ForeignStepper> stepper_;
  SideSolver side_;
  integrators::SideSteps inside_;
  double step_start_ = 0.0, step_end_ = 0.0;  ///< of the step accepted last
};

StepControl checked(const MethodInfo& info, const ToleranceScaling& scaling, const StepControl& control) {
  if (std::holds_alternative<FixedStep>(control)) {
    if (!info.has_fixed_step) {
      throw InputError(
          fmt::format("method \"{}\" chooses its own steps: give tolerances, not a step", info.name));
    }
    return control;
  }
  if (!info.is_adaptive) {
    throw InputError(fmt::format("method \"{}\" has a fixed step: give a step, not tolerances", info.name));
  }
  AdaptiveStep tolerances = std::get<AdaptiveStep>(control);
  check_tolerances(info.name, tolerances);
  tolerances.relative_tolerance =
      std::min(tolerances.relative_tolerance,
               std::max(tolerances.relative_tolerance * scaling.factor, scaling.smallest_relative));
  tolerances.absolute_tolerance *= scaling.factor;
  tolerances.absolute_velocity_tolerance *= scaling.factor;
  return tolerances;
}

}  // namespace

void ForeignStepper::interpolate(double, VectorRef) {
  throw std::logic_error("the library has no interpolant that is used");
}

Solution OracleIntegrator::do_solve(const Ivp& ivp, const StepControl& control, Observer& observer,
                                    const SolveOptions& options) const {
  const StepControl given_to_library = checked(info_, scaling_, control);
  // Refused before the observer sees the start.
  if (const auto* fixed = std::get_if<FixedStep>(&control)) integrators::count_steps_of(info_, ivp, *fixed);
  const auto* tolerances = std::get_if<AdaptiveStep>(&control);
  return integrators::run_loop(
      info_, ivp,
      [&](Work& work) -> std::unique_ptr<integrators::StepSource> {
        return std::make_unique<ForeignSteps>(info_, make_stepper_, ivp, control, given_to_library, work);
      },
      observer, options,
      tolerances != nullptr ? tolerances->maximum_steps : std::numeric_limits<std::uint64_t>::max());
}

}  // namespace fw::oracles
