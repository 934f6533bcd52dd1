#include "oracles/sundials/constrained_ida.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "constraints/consistent_state.hpp"
#include "core/error.hpp"
#include "oracles/foreign_stepper.hpp"
#include "oracles/sundials/constrained_form.hpp"
#include "oracles/sundials/ida_memory.hpp"

namespace fw::oracles {

namespace {

using namespace detail;
using constraints::DistanceConstraints;

double largest(const Vector& values) {
  return values.size() == 0 ? 0.0 : values.lpNorm<Eigen::Infinity>();
}

/// What the start leaves of the constraints, where that is below the tolerance; zero otherwise.
ConstraintExcess within_tolerance(const DistanceConstraints& constraints, const Vector& y0,
                                  double tolerance) {
  const Index n = constraints.degrees_of_freedom();
  ConstraintExcess start = excess(constraints, y0.head(n), y0.segment(n, n));
  if (largest(start.position) > tolerance) start.position.setZero();
  if (largest(start.velocity) > tolerance) start.velocity.setZero();
  return start;
}

/// (q₀, v₀, 0, 0)
Vector with_multipliers(const Vector& y0, Index count) {
  Vector unknowns = Vector::Zero(y0.size() + 2 * count);
  unknowns.head(y0.size()) = y0;
  return unknowns;
}

class ConstrainedStepper final : public ForeignStepper {
 public:
  ConstrainedStepper(const Ivp& ivp, const DistanceConstraints& constraints, const AdaptiveStep& tolerances,
                     const ConstrainedOptions& options, ConstrainedSolution& result, Work& work)
      : constraints_(constraints),
        options_(options),
        result_(result),
        end_(ivp.t1),
        // From ẏ = 0 and λ = μ = 0 the first correction of IDACalcIC is an infinitesimal step of the
        // linearised equations: it satisfies g = 0 and G v = 0 at its end too, and thereby what is hidden in
        // them, G v̇ + G(v) v = 0.
        ida_(make_constrained_form(*ivp.system->second_order(), constraints,
                                   within_tolerance(constraints, ivp.y0, tolerances.absolute_tolerance)),
             ivp.t0, ivp.t1, with_multipliers(ivp.y0, constraints.size()),
             Vector::Zero(ivp.y0.size() + 2 * constraints.size()), tolerances, work) {
    Vector kinds = Vector::Ones(ida_.form().size());
    kinds.tail(2 * constraints.size()).setZero();
    ida_.set_kinds(kinds);
    // δλ moves velocities by h M⁻¹Gᵀδλ and δμ positions likewise: the smaller the step, the less of their
    // digits matter, and the more of them are lost to rounding.
    Vector scale = Vector::Zero(ida_.form().size());
    scale.tail(2 * constraints.size()).setConstant(ivp.system->second_order()->mass().mean());
    ida_.set_tolerances_per_step(scale);
    const Index n = constraints.degrees_of_freedom();
    start_ = check_independence(*ivp.system->second_order(), constraints, ivp.y0.head(n));
    if (!start_.ok()) return;
    start_ = ida_.correct_initial_values(ivp.t1);
    if (!start_.ok()) {
      const ConstraintExcess off = excess(constraints, ivp.y0.head(n), ivp.y0.segment(n, n));
      start_.message += fmt::format("; at the start |g| = {:.3g} m, |G v| = {:.3g} m/s",
                                    largest(off.position), largest(off.velocity));
      return;
    }
    result_.initial_multipliers = lambda();
    show(ivp.t0);
  }

  Status advance(double limit, double& t, VectorRef y) override {
    if (!start_.ok()) return start_;
    if (Status status = ida_.advance(limit, t); !status.ok()) return status;
    y = ida_.state().head(y.size());
    show(t);
    return {};
  }
  void restart(double t, ConstVectorRef y) override {
    ida_.restart(t, with_multipliers(y, constraints_.size()),
                 Vector::Zero(y.size() + 2 * constraints_.size()));
    start_ = ida_.correct_initial_values(end_);
  }
  void interpolate(double t, VectorRef out) override { ida_.interpolate(t, out); }
  void collect_work(Work& work) const override { ida_.collect_work(work); }

 private:
  Vector lambda() const { return ida_.state().tail(constraints_.size()); }

  void show(double t) {
    const Index n = constraints_.degrees_of_freedom();
    const ConstraintExcess drift = excess(constraints_, ida_.state().head(n), ida_.state().segment(n, n));
    result_.position_drift = std::max(result_.position_drift, largest(drift.position));
    result_.velocity_drift = std::max(result_.velocity_drift, largest(drift.velocity));
    result_.multipliers = lambda();
    if (options_.observe_multipliers) options_.observe_multipliers(t, result_.multipliers);
  }

  const DistanceConstraints& constraints_;
  const ConstrainedOptions& options_;
  ConstrainedSolution& result_;
  double end_;
  Status start_;  ///< of the last start
  IdaMemory ida_;
};

MethodInfo constrained_info() {
  return {.name = "sundials:ida",
          .title = "IDA on the stabilised index-2 form of distance constraints",
          .family = "oracle",
          .order = 0,
          .order_with_velocity_forces = 0,
          .stages = 1,
          .is_explicit = false,
          .is_multistep = true,
          .is_adaptive = true,
          .has_fixed_step = false,
          .dense_output = DenseOutput::library,
          .needs = {Capability::second_order},
          .formula = "M q' = M v + G^T mu, M v' = f + G^T lambda, g(q) = 0, G v = 0",
          .reference = "[Gear, Gupta, Leimkuhler 1985; Hindmarsh et al. 2005]"};
}

}  // namespace

ConstrainedSolution solve_constrained(const Ivp& ivp, const DistanceConstraints& constraints,
                                      const AdaptiveStep& control, const ConstrainedOptions& options,
                                      Observer& observer) {
  ConstrainedSolution result;
  const OracleIntegrator integrator(
      constrained_info(),
      [&](const Ivp& checked_ivp, const StepControl& step_control,
          Work& work) -> std::unique_ptr<ForeignStepper> {
        return std::make_unique<ConstrainedStepper>(
            checked_ivp, constraints, std::get<AdaptiveStep>(step_control), options, result, work);
      },
      ToleranceScaling{.factor = options.tolerance_factor});
  const SecondOrderSystem* system = ivp.system ? ivp.system->second_order() : nullptr;
  if (system != nullptr && system->degrees_of_freedom() != constraints.degrees_of_freedom()) {
    throw InputError(fmt::format("distance constraints on {} degrees of freedom, the system has {}",
                                 constraints.degrees_of_freedom(), system->degrees_of_freedom()));
  }
  Ivp start = ivp;
  if (options.project_initial_state && system != nullptr && ivp.y0.size() == ivp.system->size()) {
    const Index n = constraints.degrees_of_freedom();
    Status status = project_on_constraints(*system, constraints, start.y0.head(n), start.y0.tail(n));
    if (!status.ok()) {
      result.solution = {.time = ivp.t0, .state = ivp.y0, .status = std::move(status), .work = {}};
      return result;
    }
  }
  result.solution = integrator.solve(start, control, observer);
  return result;
}

}  // namespace fw::oracles
