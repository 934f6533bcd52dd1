#include "integrators/loop/stepper.hpp"

#include <fmt/format.h>

#include "core/error.hpp"
#include "integrators/loop/run_loop.hpp"

namespace fw::integrators {

namespace {

/// Constant steps, numbered from the start of the run.
class FixedSteps final : public StepSource {
 public:
  FixedSteps(std::unique_ptr<Stepper> stepper, const Ivp& ivp, double h, const StepCount& count)
      : stepper_(std::move(stepper)),
        own_interpolant_(dynamic_cast<AdaptiveStepper*>(stepper_.get())),
        t0_(ivp.t0),
        h_(h),
        count_(count) {
    if (own_interpolant_ != nullptr && !own_interpolant_->has_dense_output()) own_interpolant_ = nullptr;
  }

  Status propose(LoopStep& step) override {
    const std::uint64_t n = step.index - 1;
    step.start = t0_ + static_cast<double>(n) * h_;
    step.end = t0_ + static_cast<double>(n + 1) * h_;
    step.is_last = step.index == count_.total();
    start_ = step.start;
    length_ = n < count_.whole ? h_ : count_.remainder;
    return {};
  }

  Status attempt(LoopStep& step, ConstVectorRef y, VectorRef y_new) override {
    y_new = y;
    step.is_accepted = true;
    Status status = stepper_->step(step.start, length_, y_new);
    if (!status.ok()) {
      status.message = fmt::format("step {} at t = {:.6g}: {}", step.index, step.start, status.message);
    }
    return status;
  }

  const AdaptiveStep* tolerances() const override { return nullptr; }
  void take_back(double t, ConstVectorRef y) override { stepper_->restart(t, y); }
  void shorten(double) override {}
  void accept(const LoopStep&) override {}
  bool has_dense_output() const override { return own_interpolant_ != nullptr; }
  void interpolate(double t, VectorRef out) override {
    own_interpolant_->interpolate((t - start_) / length_, out);
  }
  void restart(double t, ConstVectorRef y) override { stepper_->restart(t, y); }
  void serialise(StateArchive& archive) override {
    archive.require_equal("step", h_);
    archive.visit("start of the step", start_);
    archive.visit("length of the step", length_);
    stepper_->serialise(archive);
  }
  void collect_work(Work&) const override {}

 private:
  std::unique_ptr<Stepper> stepper_;
  AdaptiveStepper* own_interpolant_;  ///< null: none
  double t0_, h_;
  StepCount count_;
  double start_ = 0.0, length_ = 0.0;  ///< of the present step
};

}  // namespace

StepCount count_steps_of(const MethodInfo& info, const Ivp& ivp, const FixedStep& control) {
  return control.allow_short_last_step && !info.is_multistep
             ? count_steps(ivp.t0, ivp.t1, control.step)
             : count_whole_steps(info.name, ivp.t0, ivp.t1, control.step);
}

Solution run_fixed_steps(const MethodInfo& info, const StepperFactory& make_stepper, const Ivp& ivp,
                         const FixedStep& control, Observer& observer, const SolveOptions& options) {
  const StepCount count = count_steps_of(info, ivp, control);
  return run_loop(
      info, ivp,
      [&](Work& work) -> std::unique_ptr<StepSource> {
        return std::make_unique<FixedSteps>(make_stepper(ivp, control.step, work), ivp, control.step, count);
      },
      observer, options);
}

Solution FixedStepIntegrator::do_solve(const Ivp& ivp, const StepControl& control, Observer& observer,
                                       const SolveOptions& options) const {
  const auto* fixed = std::get_if<FixedStep>(&control);
  if (fixed == nullptr) {
    throw InputError(fmt::format("method \"{}\" has a fixed step: give a step, not tolerances", info_.name));
  }
  return run_fixed_steps(info_, make_stepper_, ivp, *fixed, observer, options);
}

}  // namespace fw::integrators
