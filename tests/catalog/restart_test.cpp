#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "catalog/method_runs.hpp"
#include "integrators/loop/adaptive_integrator.hpp"
#include "integrators/saved_run.hpp"

namespace fw::catalog {
namespace {

using integrators::AdaptiveIntegrator;
using integrators::FixedStepIntegrator;
using integrators::Stepper;
using integrators::StepRecord;
using ::testing::HasSubstr;

/// Moves what moves, at the k-th accepted step.
class Kick final : public StepHook {
 public:
  Kick(const OdeSystem& system, int at_step) : system_(system), at_step_(at_step) {}

  Change on_accepted(double t, VectorRef y) override {
    if (++steps_ != at_step_) return Change::none;
    const SecondOrderSystem* second_order = system_.second_order();
    const Index n = second_order != nullptr ? y.size() / 2 : y.size();
    for (Index i = 0; i < y.size(); ++i) {
      if (second_order != nullptr && second_order->fixed()[static_cast<std::size_t>(i % n)] != 0) continue;
      y[i] += (i < n ? 0.01 : 0.3) * std::sin(static_cast<double>(i + 1));
    }
    time = t;
    state = y;
    return Change::state;
  }

  double time = 0.0;
  Vector state;

 private:
  const OdeSystem& system_;
  int at_step_, steps_ = 0;
};

/// The step that an own adaptive run tries after the step that ended at `t`.
double step_to_come(const integrators::EveryStep& checkpoints, double t) {
  for (const auto& [time, saved] : checkpoints.saved) {
    if (time != t) continue;
    for (const integrators::SavedItem& item : integrators::items_of(saved)) {
      double value = 0.0;
      if (item.name != "step to come") continue;
      std::memcpy(&value, saved.data() + item.begin, sizeof value);
      return value;
    }
  }
  return 0.0;
}

/// Empty if the run goes on after the kick as a new run from the changed state does, bit for bit.
std::string difference_from_a_new_run(const MethodRun& run, int at_step) {
  Kick kick(*run.ivp.system, at_step);
  StepRecord whole, fresh;
  integrators::EveryStep checkpoints;
  SolveOptions options{.hook = &kick};
  if (!run.is_foreign() && !run.is_fixed()) options.checkpoints = &checkpoints;
  const Solution kicked = run.integrator->solve(run.ivp, run.control, whole, options);
  if (!kicked.status.ok()) return kicked.status.describe();
  if (kick.state.size() == 0 || kick.time >= run.ivp.t1) return "too few steps to compare";
  Ivp rest = run.ivp;
  rest.t0 = kick.time;
  rest.y0 = kick.state;
  StepControl control = run.control;
  if (auto* adaptive = std::get_if<AdaptiveStep>(&control); adaptive != nullptr && !run.is_foreign())
    adaptive->initial_step = step_to_come(checkpoints, kick.time);
  const Solution anew = run.integrator->solve(rest, control, fresh);
  if (!anew.status.ok()) return anew.status.describe();
  if (fresh.times.size() < 4) return "too few steps to compare";
  return difference_from_end(whole, fresh);
}

TEST(Restart, OfEveryMethodGoesOnAsANewRunFromTheChangedState) {
  int compared = 0;
  for (const MethodRun& run : method_runs(24, false, true)) {
    EXPECT_EQ(difference_from_a_new_run(run, 7), "") << run.name();
    ++compared;
  }
  EXPECT_GT(compared, 150);
}

TEST(Restart, AtTheFirstAndAtASecondStepIsOneAsWell) {
  for (const MethodRun& run : method_runs(16, true, true)) {
    if (!run.integrator->info().is_multistep && !run.integrator->info().carries_more_than_state) continue;
    EXPECT_EQ(difference_from_a_new_run(run, 1), "") << run.name();
    EXPECT_EQ(difference_from_a_new_run(run, 2), "") << run.name();
  }
}

/// A right stepper that does not hear of a restart.
class ForgetfulStepper final : public Stepper {
 public:
  explicit ForgetfulStepper(std::unique_ptr<Stepper> stepper) : stepper_(std::move(stepper)) {}
  Status step(double t, double h, VectorRef y) override { return stepper_->step(t, h, y); }
  void restart(double, ConstVectorRef) override {}
  void serialise(StateArchive& archive) override { stepper_->serialise(archive); }

 private:
  std::unique_ptr<Stepper> stepper_;
};

std::shared_ptr<const Integrator> that_forgets_to_restart(const std::string& call) {
  const std::shared_ptr<const Integrator> right = make_method(call);
  return std::make_shared<FixedStepIntegrator>(
      right->info(), [right](const Ivp& ivp, double h, Work& work) -> std::unique_ptr<Stepper> {
        if (const auto* fixed = dynamic_cast<const FixedStepIntegrator*>(right.get()))
          return std::make_unique<ForgetfulStepper>(fixed->make_stepper(ivp, h, work));
        return std::make_unique<ForgetfulStepper>(
            dynamic_cast<const AdaptiveIntegrator&>(*right).make_stepper(ivp, work));
      });
}

TEST(Restart, ThatIsForgottenIsCaught) {
  int tried = 0;
  const std::vector<MethodRun> runs = method_runs(24, true, true);
  // A slope that is the last of the step before, differences, histories, accelerations, guesses and matrices.
  for (const char* call : {"dormand_prince_54", "tr_bdf2", "verlet", "velocity_verlet", "adams_bashforth3",
                           "bdf3", "newmark", "gauss2", "r_respa", "gautschi", "implicit_euler_linearised"}) {
    for (MethodRun run : runs) {
      if (run.call != call || !run.is_fixed()) continue;
      run.integrator = that_forgets_to_restart(call);
      ++tried;
      EXPECT_THAT(difference_from_a_new_run(run, 7), HasSubstr("step")) << call;
    }
  }
  EXPECT_EQ(tried, 11);
}

}  // namespace
}  // namespace fw::catalog
