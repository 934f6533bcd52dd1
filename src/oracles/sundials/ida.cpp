#include "oracles/sundials/ida.hpp"

#include "oracles/foreign_stepper.hpp"
#include "oracles/sundials/ida_memory.hpp"

namespace fw::oracles {

namespace {

using namespace detail;

class IdaStepper final : public ForeignStepper {
 public:
  IdaStepper(const Ivp& ivp, const AdaptiveStep& tolerances, Work& work)
      : system_(*ivp.system),
        work_(work),
        ida_(make_residual_form(system_), ivp.t0, ivp.t1, ivp.y0, slope(ivp.t0, ivp.y0), tolerances, work) {}

  Status advance(double limit, double& t, VectorRef y) override {
    Status status = ida_.advance(limit, t);
    if (status.ok()) y = ida_.state();
    return status;
  }
  void restart(double t, ConstVectorRef y) override { ida_.restart(t, y, slope(t, y)); }
  void interpolate(double t, VectorRef out) override { ida_.interpolate(t, out); }
  void collect_work(Work& work) const override { ida_.collect_work(work); }

 private:
  Vector slope(double t, ConstVectorRef y) {
    Vector slope(y.size());
    system_.rhs(t, y, slope);
    ++work_.rhs_evaluations;
    return slope;
  }

  const OdeSystem& system_;
  Work& work_;
  IdaMemory ida_;
};

}  // namespace

std::unique_ptr<Integrator> make_ida(const IdaOptions& options) {
  MethodInfo info{.name = "sundials:ida",
                  .title = "IDA, variable-order BDF on the residual form with Newton and KLU",
                  .family = "oracle",
                  .order = 0,
                  .order_with_velocity_forces = 0,
                  .stages = 1,
                  .is_explicit = false,
                  .is_multistep = true,
                  .is_adaptive = true,
                  .has_fixed_step = false,
                  .dense_output = DenseOutput::library,
                  .formula = "backward differentiation formulas of orders 1-5 on q' - v = 0, M v' - f = 0",
                  .reference = "[Hindmarsh et al. 2005]"};
  return std::make_unique<OracleIntegrator>(
      std::move(info),
      [](const Ivp& ivp, const StepControl& control, Work& work) -> std::unique_ptr<ForeignStepper> {
        return std::make_unique<IdaStepper>(ivp, std::get<AdaptiveStep>(control), work);
      },
      ToleranceScaling{.factor = options.tolerance_factor});
}

}  // namespace fw::oracles
