#include "integrators/loop/adaptive_integrator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "integrators/loop/initial_step.hpp"
#include "integrators/loop/run_loop.hpp"
#include "integrators/loop/side_steps.hpp"

namespace fw::integrators {

namespace {

/// The largest relative distance from the end that is taken in one step instead of leaving a sliver.
constexpr double stretch_to_end = 1.01;
/// Steps below this many units in the last place of t do not advance it reliably.
constexpr double smallest_step_in_ulps = 16.0;
constexpr int most_failures_in_a_row = 100;

/// Without a tolerance of velocities where the system has none.
AdaptiveStep for_system(AdaptiveStep control, const OdeSystem& system) {
  if (!control.has_velocity_tolerance(system)) control.absolute_velocity_tolerance = 0.0;
  return control;
}

/// Steps chosen by the error estimate.
class AdaptiveSteps final : public StepSource {
 public:
  AdaptiveSteps(const MethodInfo& info, const ControllerOptions& options,
                const AdaptiveStepperFactory& make_stepper, const Ivp& ivp, const AdaptiveStep& control,
                bool is_resumed, Work& work)
      : norm_(norm_on(options.norm, *ivp.system)),
        stepper_(make_stepper(ivp, work)),
        has_dense_output_(info.dense_output != DenseOutput::cubic_hermite),
        inside_(*ivp.system, side_step_nodes(info),
                side_step_of([&make_stepper, &ivp, &work] { return make_stepper(ivp, work); }), work,
                dynamic_cast<ContinuousExtension*>(stepper_.get())),
        control_(for_system(control, *ivp.system)),
        t1_(ivp.t1),
        work_(work),
        controller_(options, std::min(info.order, info.embedded_order) + 1),
        error_(ivp.y0.size()),
        h_(is_resumed ? 0.0
           : control.initial_step > 0.0
               ? std::min({control.initial_step, control.maximum_step, ivp.t1 - ivp.t0})
               : std::max(initial_step(ivp, control_, norm_, info.order, work), control.minimum_step)) {}

  Status propose(LoopStep& step) override {
    const double t = step.start;
    const double rest = t1_ - t;
    step.is_last = h_ * stretch_to_end >= rest && rest <= control_.maximum_step;
    const double smallest = std::max(
        control_.minimum_step, smallest_step_in_ulps * (std::nextafter(std::abs(t), 1e300) - std::abs(t)));
    if (!step.is_last && h_ < smallest) {
      return {StatusCode::step_too_small,
              fmt::format(
                  "at t = {:.6g} the error test asks for a step of {:.3g}, below the smallest of {:.3g}{}", t,
                  h_, smallest, last_failure_.empty() ? "" : "; last failure: " + last_failure_)};
    }
    if (step.is_last) {
      h_ = rest;
    } else if (2.0 * h_ > rest) {
      h_ = std::max(0.5 * rest, smallest);  // two even steps instead of a long and a short one
    }
    taken_ = h_;
    step.end = t + h_;
    is_cut_ = step.limit < (step.is_last ? t1_ : step.end);
    if (is_cut_) {
      step.end = step.limit;
      step.is_last = false;
      taken_ = step.end - t;
    }
    return {};
  }

  Status attempt(LoopStep& step, ConstVectorRef y, VectorRef y_new) override {
    estimate_ = estimate(step.start, y, y_new);
    step.is_accepted = estimate_ <= 1.0;
    if (step.is_accepted) {
      failures_ = 0;
      last_failure_.clear();
      return {};
    }
    ++work_.rejected_steps;
    if (++failures_ > most_failures_in_a_row) {
      return {StatusCode::step_too_small,
              fmt::format("at t = {:.6g} the step failed {} times in a row{}", step.start, failures_,
                          last_failure_.empty() ? "" : "; last failure: " + last_failure_)};
    }
    h_ = taken_ * controller_.after_rejection(estimate_);
    return {};
  }

  const AdaptiveStep* tolerances() const override { return &control_; }
  /// An attempt leaves no trace.
  void take_back(double, ConstVectorRef) override {}
  void shorten(double h) override { h_ = std::min(h_, h); }

  void accept(const LoopStep& step) override {
    stepper_->accept();
    start_ = step.start;
    end_ = step.end;
    if (is_cut_) return;  // what was wished for stays
    h_ = std::min(h_ * controller_.after_acceptance(estimate_), control_.maximum_step);
  }

  bool has_dense_output() const override { return has_dense_output_; }
  void set_ends(ConstVectorRef start, ConstVectorRef end) override {
    inside_.set_step(start_, end_, start, end);
  }
  void interpolate(double t, VectorRef out) override { inside_(t, out); }

  /// The length of the step to come stays: a projection at each step must not cost a search for it. What the
  /// controller remembers of errors before goes.
  void restart(double t, ConstVectorRef y) override {
    controller_.restart();
    stepper_->restart(t, y);
  }

  void serialise(StateArchive& archive) override {
    archive.require_equal("relative tolerance", control_.relative_tolerance);
    archive.require_equal("absolute tolerance", control_.absolute_tolerance);
    archive.require_equal("absolute tolerance of velocities", control_.absolute_velocity_tolerance);
    archive.require_equal("minimum step", control_.minimum_step);
    archive.require_equal("maximum step", control_.maximum_step);
    archive.visit("step to come", h_);
    archive.visit("start of the step", start_);
    archive.visit("end of the step", end_);
    controller_.serialise(archive);
    stepper_->serialise(archive);
  }
  void collect_work(Work&) const override {}

 private:
  /// The error in units of the tolerance; NaN where the step could not be made.
  double estimate(double t, ConstVectorRef y, VectorRef y_new) {
    const Status status = stepper_->attempt(t, taken_, y, y_new, error_);
    if (!status.ok()) {
      last_failure_ = status.describe();
      return std::numeric_limits<double>::quiet_NaN();
    }
    const double estimate = error_in_tolerances(norm_, control_, error_, y, y_new);
    if (!std::isfinite(estimate)) last_failure_ = "the error estimate is not finite";
    return estimate;
  }

  ErrorNorm norm_;
  std::unique_ptr<AdaptiveStepper> stepper_;
  bool has_dense_output_;
  SideSteps inside_;
  AdaptiveStep control_;
  double t1_;
  Work& work_;
  StepSizeController controller_;
  Vector error_;
  double h_;
  double taken_ = 0.0;              ///< length of the last attempt: h_, or what is left of it
  bool is_cut_ = false;             ///< it ends where the loop wants it to
  double start_ = 0.0, end_ = 0.0;  ///< of the step accepted last
  double estimate_ = 0.0;           ///< of the last attempt
  int failures_ = 0;                ///< in a row
  std::string last_failure_;
};

}  // namespace

AdaptiveIntegrator::AdaptiveIntegrator(MethodInfo info, ControllerOptions options,
                                       AdaptiveStepperFactory make_stepper, ExtendedSolver extended_solver)
    : info_(std::move(info)),
      options_(options),
      make_stepper_(std::move(make_stepper)),
      extended_solver_(std::move(extended_solver)) {
  // Slopes amplify the errors of states where the problem is stiff: implicit schemes go without them.
  info_.dense_output = !info_.is_explicit ? DenseOutput::side_steps
                       : info_.order > 3  ? DenseOutput::side_step_polynomial
                                          : DenseOutput::cubic_hermite;
}

Solution AdaptiveIntegrator::do_solve(const Ivp& ivp, const StepControl& control, Observer& observer,
                                      const SolveOptions& options) const {
  if (const auto* fixed = std::get_if<FixedStep>(&control)) {
    return run_fixed_steps(
        info_,
        [this](const Ivp& problem, double, Work& work) -> std::unique_ptr<Stepper> {
          return make_stepper_(problem, work);
        },
        ivp, *fixed, observer, options);
  }
  const auto& adaptive = std::get<AdaptiveStep>(control);
  check_tolerances(info_.name, adaptive);
  return run_loop(
      info_, ivp,
      [&](Work& work) -> std::unique_ptr<StepSource> {
        return std::make_unique<AdaptiveSteps>(info_, options_, make_stepper_, ivp, adaptive,
                                               !options.resume.empty(), work);
      },
      observer, options, adaptive.maximum_steps);
}

}  // namespace fw::integrators
