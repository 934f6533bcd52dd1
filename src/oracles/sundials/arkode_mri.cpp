#include "oracles/sundials/arkode_mri.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "core/error.hpp"
#include "oracles/foreign_stepper.hpp"
#include "oracles/sundials/ark_step_memory.hpp"

namespace fw::oracles {

namespace {

using namespace detail;

ArkodeTables inner_tables(const MriOptions& options) {
  if (options.inner_is_implicit) {
    return built_in_diagonally_implicit_tables(options.inner_table.empty() ? "ark548l2sa_dirk_8_4_5"
                                                                           : options.inner_table);
  }
  return built_in_explicit_tables(options.inner_table.empty() ? "dormand_prince_7_4_5" : options.inner_table);
}

/// What the callback of the slow part needs.
struct SlowPart {
  std::unique_ptr<RightHandPart> part;
  Index size;
  RunReport& report;
  Work& work;
};

int evaluate_slow_part(sunrealtype t, N_Vector y, N_Vector dydt, void* user_data) {
  auto& slow = *static_cast<SlowPart*>(user_data);
  return slow.report.guard.call([&] {
    VectorMap slope = mutable_view(dydt, slow.size);
    slow.part->evaluate(t, view(y, slow.size), slope);
    ++slow.work.rhs_evaluations;
    if (slope.allFinite()) return 0;
    slow.report.met_non_finite = true;
    return 1;
  });
}

class MriStepper final : public ForeignStepper {
 public:
  MriStepper(const MriOptions& options, const ArkodeTables& tables, const Ivp& ivp, Work& work)
      : inner_steps_(options.inner_steps),
        inner_tolerance_(options.inner_tolerance),
        time_(ivp.t0),
        state_(ivp.y0),
        slow_{make_soft_right_hand_part(*ivp.system->second_order()), ivp.y0.size(), report_, work},
        context_(make_context()),
        state_vector_(wrap_eigen_vector(state_, context_.get())),
        inner_(ivp.t0, state_vector_.get(), fast_part(ivp, !options.inner_is_implicit),
               fast_part(ivp, options.inner_is_implicit), tables, report_, work, context_.get()),
        inner_stepper_(inner_stepper(inner_.get())),
        memory_(own<MriStepPointer>(MRIStepCreate(evaluate_slow_part, nullptr, ivp.t0, state_vector_.get(),
                                                  inner_stepper_.get(), context_.get()),
                                    "MRIStepCreate")) {
    set_inner_tolerances(ivp.y0);
    void* memory = memory_.get();
    require(MRIStepSetErrHandlerFn(memory, keep_message, &report_), "MRIStepSetErrHandlerFn");
    require(MRIStepSetUserData(memory, &slow_), "MRIStepSetUserData");
    const CouplingPointer coupling = built_in_coupling(options.coupling);
    require(MRIStepSetCoupling(memory, coupling.get()), "MRIStepSetCoupling");
    require(MRIStepSetMaxNumSteps(memory, -1), "MRIStepSetMaxNumSteps");
  }

  Status advance(double limit, double& t, VectorRef y) override {
    const double step = limit - time_;
    require(MRIStepSetFixedStep(memory_.get(), step), "MRIStepSetFixedStep");
    if (inner_steps_ > 0) {
      require(ARKStepSetFixedStep(inner_.get(), step / inner_steps_), "ARKStepSetFixedStep");
    }
    report_.message.clear();
    double reached = time_;
    const int flag = MRIStepEvolve(memory_.get(), limit, state_vector_.get(), &reached, ARK_ONE_STEP);
    report_.guard.rethrow();
    if (flag < 0) return failure(flag);
    time_ = reached;
    report_.met_non_finite = false;
    t = limit;  // t + h may differ from it by a rounding
    y = state_;
    return {};
  }

  void restart(double t, ConstVectorRef y) override {
    state_ = y;
    time_ = t;
    inner_.restart(t, state_vector_.get());
    set_inner_tolerances(y);
    require(MRIStepReInit(memory_.get(), evaluate_slow_part, nullptr, t, state_vector_.get()),
            "MRIStepReInit");
    report_ = {};
  }

  void collect_work(Work& work) const override { inner_.collect_work(work); }

 private:
  void set_inner_tolerances(ConstVectorRef y) {
    const double scale = std::max(y.lpNorm<Eigen::Infinity>(), std::numeric_limits<double>::min());
    if (inner_steps_ > 0) {
      inner_.take_constant_steps(scale, {});
    } else {
      inner_.choose_steps({.relative_tolerance = inner_tolerance_},
                          Vector::Constant(y.size(), inner_tolerance_ * scale), {});
    }
  }
  static std::unique_ptr<RightHandPart> fast_part(const Ivp& ivp, bool is_wanted) {
    return is_wanted ? make_stiff_right_hand_part(*ivp.system->second_order()) : nullptr;
  }
  static InnerStepperPointer inner_stepper(void* ark_memory) {
    MRIStepInnerStepper stepper = nullptr;
    require(ARKStepCreateMRIStepInnerStepper(ark_memory, &stepper), "ARKStepCreateMRIStepInnerStepper");
    return InnerStepperPointer(stepper);
  }

  /// The flag of the inner integration says more than "the inner stepper failed".
  Status failure(int flag) const {
    int inner_flag = 0;
    MRIStepGetLastInnerStepFlag(memory_.get(), &inner_flag);
    if (inner_flag < 0) {
      return describe_failure(code_of_arkode_flag(inner_flag, inner_.last_linear_flag(), report_),
                              "ARKODE's inner integration in the step", time_,
                              ARKStepGetReturnFlagName(inner_flag), report_);
    }
    return describe_failure(code_of_arkode_flag(flag, 0, report_), "ARKODE", time_,
                            MRIStepGetReturnFlagName(flag), report_);
  }

  int inner_steps_;
  double inner_tolerance_;
  double time_;  ///< as ARKODE has it
  RunReport report_;
  Vector state_;
  SlowPart slow_;
  ContextPointer context_;
  VectorPointer state_vector_;
  ArkStepMemory inner_;
  InnerStepperPointer inner_stepper_;
  MriStepPointer memory_;
};

}  // namespace

std::unique_ptr<Integrator> make_arkode_mri(const MriOptions& options) {
  if (options.inner_steps < 0) {
    throw InputError(fmt::format("inner_steps: found {}, expected a whole number >= 0", options.inner_steps));
  }
  if (!(options.inner_tolerance > 0.0)) {
    throw InputError(
        fmt::format("inner_tolerance: found {}, expected a number > 0", options.inner_tolerance));
  }
  const CouplingPointer coupling = built_in_coupling(options.coupling);
  const auto tables = std::make_shared<const ArkodeTables>(inner_tables(options));
  if (options.inner_steps == 0 && tables->embedded_order == 0) {
    throw InputError(fmt::format("inner_table \"{}\" has no error estimate: give inner_steps", tables->name));
  }
  MethodInfo info{
      .name = "sundials:arkode_mri",
      .title = fmt::format("ARKODE, multirate infinitesimal {} over {}", options.coupling, tables->name),
      .family = "oracle",
      .order = coupling->q,
      .order_with_velocity_forces = coupling->q,
      .stages = coupling->stages - 1,
      .is_explicit = !options.inner_is_implicit,
      .dense_output = DenseOutput::side_steps,
      .needs = {Capability::second_order, Capability::force_splitting},
      .formula = "v' = f_stiff(t, v) + sum_j w_ij((t - t_n)/h) f_soft(y_j) between the stages",
      .reference = "[Sandu 2019; Reynolds et al. 2023]"};
  return std::make_unique<OracleIntegrator>(
      std::move(info),
      [options, tables](const Ivp& ivp, const StepControl&, Work& work) -> std::unique_ptr<ForeignStepper> {
        return std::make_unique<MriStepper>(options, *tables, ivp, work);
      });
}

}  // namespace fw::oracles
