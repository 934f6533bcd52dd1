#include "integrators/loop/stepper.hpp"

#include <fmt/format.h>

#include "core/error.hpp"
#include "integrators/loop/run_loop.hpp"
#include "integrators/loop/side_steps.hpp"

namespace fw::integrators {

namespace {

/// Constant steps, numbered from the start of the run.
class FixedSteps final : public StepSource {
 public:
  FixedSteps(const MethodInfo& info, const StepperFactory& make_stepper, const Ivp& ivp, double h,
             const StepCount& count, Work& work)
      : stepper_(make_stepper(ivp, h, work)),
        has_dense_output_(info.dense_output != DenseOutput::cubic_hermite),
        inside_(*ivp.system, side_step_nodes(info),
                side_step_of([&make_stepper, &ivp, h, &work] { return make_stepper(ivp, h, work); }), work,
                dynamic_cast<ContinuousExtension*>(stepper_.get())),
        t0_(ivp.t0),
        h_(h),
        count_(count) {}

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
  void accept(const LoopStep& step) override { end_ = step.end; }
  bool has_dense_output() const override { return has_dense_output_; }
  void set_ends(ConstVectorRef start, ConstVectorRef end) override {
    inside_.set_step(start_, end_, start, end);
  }
  void interpolate(double t, VectorRef out) override { inside_(t, out); }
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
  bool has_dense_output_;
  SideSteps inside_;
  double t0_, h_;
  StepCount count_;
  double start_ = 0.0, end_ = 0.0, length_ = 0.0;  ///< of the present step
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
        return std::make_unique<FixedSteps>(info, make_stepper, ivp, control.step, count, work);
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
