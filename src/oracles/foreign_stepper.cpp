#include "oracles/foreign_stepper.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "integrators/loop/run_loop.hpp"
#include "integrators/loop/stepper.hpp"

namespace fw::oracles {

namespace {

/// The steps of a library. They have to end at each multiple of a constant step, or at the end time only.
class ForeignSteps final : public integrators::StepSource {
 public:
  /// `given_to_library` outlives the steps.
  ForeignSteps(const MethodInfo& info, const Ivp& ivp, const StepControl& control,
               const StepControl& given_to_library, std::unique_ptr<ForeignStepper> stepper)
      : info_(info),
        start_(ivp.t0),
        end_(ivp.t1),
        tolerances_(std::get_if<AdaptiveStep>(&given_to_library)),
        stepper_(std::move(stepper)) {
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
  void accept(const integrators::LoopStep&) override {}
  bool has_dense_output() const override { return stepper_->has_dense_output(); }
  void interpolate(double t, VectorRef out) override { stepper_->interpolate(t, out); }
  void restart(double t, ConstVectorRef y) override { stepper_->restart(t, y); }
  void serialise(StateArchive&) override {
    throw InputError(
        fmt::format("method \"{}\" cannot be saved: the library does not give out its memory", info_.name));
  }
  void collect_work(Work& work) const override { stepper_->collect_work(work); }

 private:
  const MethodInfo& info_;
  double start_, end_;
  double step_ = 0.0;  ///< 0: the library chooses
  std::uint64_t total_ = 0;
  const AdaptiveStep* tolerances_;  ///< null: constant steps
  std::unique_ptr<ForeignStepper> stepper_;
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
  return tolerances;
}

}  // namespace

Solution OracleIntegrator::do_solve(const Ivp& ivp, const StepControl& control, Observer& observer,
                                    const SolveOptions& options) const {
  const StepControl given_to_library = checked(info_, scaling_, control);
  // Refused before the observer sees the start.
  if (const auto* fixed = std::get_if<FixedStep>(&control)) integrators::count_steps_of(info_, ivp, *fixed);
  const auto* tolerances = std::get_if<AdaptiveStep>(&control);
  return integrators::run_loop(
      info_, ivp,
      [&](Work& work) -> std::unique_ptr<integrators::StepSource> {
        return std::make_unique<ForeignSteps>(info_, ivp, control, given_to_library,
                                              make_stepper_(ivp, given_to_library, work));
      },
      observer, options,
      tolerances != nullptr ? tolerances->maximum_steps : std::numeric_limits<std::uint64_t>::max());
}

}  // namespace fw::oracles
