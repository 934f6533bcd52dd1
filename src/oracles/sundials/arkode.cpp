#include "oracles/sundials/arkode.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "core/error.hpp"
#include "integrators/loop/particle_norm.hpp"
#include "oracles/foreign_stepper.hpp"
#include "oracles/sundials/ark_step_memory.hpp"
#include "oracles/sundials/eigen_vector.hpp"

namespace fw::oracles {

namespace {

using namespace detail;

/// ARKODE's relative tolerance has to stay above the rounding of a step.
constexpr double smallest_relative_tolerance = 1e-14;

class ArkodeStepper final : public ForeignStepper {
 public:
  ArkodeStepper(const ArkodeTables& tables, const ArkodeOptions& options, const Ivp& ivp,
                const StepControl& control, Work& work)
      : time_(ivp.t0),
        is_adaptive_(std::holds_alternative<AdaptiveStep>(control)),
        accuracy_{options.newton_tolerance, options.newton_coefficient},
        check_stall_(ivp.t0),
        state_(ivp.y0),
        context_(make_context()),
        state_vector_(wrap_state(state_, is_adaptive_ && integrators::has_particles(*ivp.system),
                                 VectorOperations::eigen, context_.get())),
        ark_(ivp.t0, state_vector_.get(), explicit_part(tables, *ivp.system),
             implicit_part(tables, *ivp.system), tables, report_, work, context_.get()) {
    if (is_adaptive_) {
      const auto& tolerances = std::get<AdaptiveStep>(control);
      ark_.choose_steps(tolerances, absolute_tolerances(tolerances, *ivp.system), accuracy_);
    } else {
      ark_.take_constant_steps(ivp.y0.lpNorm<Eigen::Infinity>(), accuracy_);
    }
  }

  Status advance(double limit, double& t, VectorRef y) override {
    if (is_adaptive_) {
      require(ARKStepSetStopTime(ark_.get(), limit), "ARKStepSetStopTime");
    } else {
      require(ARKStepSetFixedStep(ark_.get(), limit - time_), "ARKStepSetFixedStep");
    }
    report_.message.clear();
    double reached = time_;  // where it fails, the time of a stage
    int flag = ARKStepEvolve(ark_.get(), limit, state_vector_.get(), &reached, ARK_ONE_STEP);
    while (flag == ARK_CONV_FAILURE && !is_adaptive_ && !report_.met_non_finite &&
           ark_.last_linear_flag() == 0 && ark_.raise_stage_tolerance()) {
      flag = ARKStepEvolve(ark_.get(), limit, state_vector_.get(), &reached, ARK_ONE_STEP);
    }
    report_.guard.rethrow();
    if (flag < 0) {
      return describe_failure(code_of_arkode_flag(flag, ark_.last_linear_flag(), report_), "ARKODE", time_,
                              ARKStepGetReturnFlagName(flag), report_);
    }
    time_ = reached;
    if (Status status = check_stall_("ARKODE", time_, report_); !status.ok()) return status;
    t = is_adaptive_ ? time_ : limit;  // t + h may differ from it by a rounding
    y = state_;
    return {};
  }

  void restart(double t, ConstVectorRef y) override {
    state_ = y;
    time_ = t;
    ark_.restart(t, state_vector_.get());
    if (!is_adaptive_) ark_.take_constant_steps(y.lpNorm<Eigen::Infinity>(), accuracy_);
    report_ = {};
    check_stall_ = StallCheck(t);
  }

  void collect_work(Work& work) const override { ark_.collect_work(work); }

 private:
  static std::unique_ptr<RightHandPart> explicit_part(const ArkodeTables& tables, const OdeSystem& system) {
    if (!tables.explicit_part) return nullptr;
    return tables.implicit_part ? make_soft_right_hand_part(*system.second_order())
                                : make_whole_right_hand_side(system);
  }
  static std::unique_ptr<RightHandPart> implicit_part(const ArkodeTables& tables, const OdeSystem& system) {
    if (!tables.implicit_part) return nullptr;
    return tables.explicit_part ? make_stiff_right_hand_part(*system.second_order())
                                : make_whole_right_hand_side(system);
  }

  double time_;  ///< as ARKODE has it
  bool is_adaptive_;
  StageAccuracy accuracy_;
  RunReport report_;
  StallCheck check_stall_;
  Vector state_;
  ContextPointer context_;
  VectorPointer state_vector_;
  ArkStepMemory ark_;
};

std::unique_ptr<Integrator> make_arkode(std::string name, std::string title, ArkodeTables tables,
                                        const ArkodeOptions& options) {
  if (!(options.tolerance_factor > 0.0) || !(options.newton_coefficient > 0.0) ||
      !(options.newton_tolerance > 0.0)) {
    throw InputError(
        fmt::format("tolerance_factor {}, newton_coefficient {}, newton_tolerance {}: expected "
                    "numbers > 0",
                    options.tolerance_factor, options.newton_coefficient, options.newton_tolerance));
  }
  const bool is_additive = tables.explicit_part && tables.implicit_part;
  const ARKodeButcherTable any =
      tables.explicit_part ? tables.explicit_part.get() : tables.implicit_part.get();
  MethodInfo info{.name = std::move(name),
                  .title = fmt::format("{}, {}", title, tables.name),
                  .family = "oracle",
                  .order = tables.order,
                  .order_with_velocity_forces = tables.order,
                  .stages = any->stages,
                  .is_explicit = !tables.implicit_part,
                  .is_adaptive = tables.embedded_order > 0,
                  .embedded_order = tables.embedded_order,
                  .dense_output = DenseOutput::side_steps,
                  .needs = is_additive ? Capabilities{Capability::second_order, Capability::force_splitting}
                                       : Capabilities{},
                  .formula = is_additive
                                 ? "y_i = y + h sum_{j<=i} a_ij f_stiff(y_j) + h sum_{j<i} e_ij f_soft(y_j)"
                             : tables.implicit_part ? "y_i = y + h sum_{j<=i} a_ij f(t + c_j h, y_j)"
                                                    : "y_i = y + h sum_{j<i} a_ij f(t + c_j h, y_j)",
                  .reference = "[Reynolds et al. 2023]"};
  // Read by all runs; ARKODE copies what it is given.
  const auto shared = std::make_shared<const ArkodeTables>(std::move(tables));
  return std::make_unique<OracleIntegrator>(
      std::move(info),
      [shared, options](const Ivp& ivp, const StepControl& control,
                        Work& work) -> std::unique_ptr<ForeignStepper> {
        return std::make_unique<ArkodeStepper>(*shared, options, ivp, control, work);
      },
      ToleranceScaling{options.tolerance_factor, smallest_relative_tolerance});
}

constexpr const char* erk_name = "sundials:arkode_erk";
constexpr const char* erk_title = "ARKODE, explicit Runge-Kutta";
constexpr const char* dirk_name = "sundials:arkode_dirk";
constexpr const char* dirk_title = "ARKODE, diagonally implicit Runge-Kutta with Newton and KLU";
constexpr const char* imex_name = "sundials:arkode_imex";
constexpr const char* imex_title = "ARKODE, additive Runge-Kutta, stiff springs implicit";

}  // namespace

std::unique_ptr<Integrator> make_arkode_erk(const std::string& table, const ArkodeOptions& options) {
  return make_arkode(erk_name, erk_title, built_in_explicit_tables(table), options);
}
std::unique_ptr<Integrator> make_arkode_erk(const schemes::ButcherTableau& tableau,
                                            const ArkodeOptions& options) {
  return make_arkode(erk_name, erk_title, explicit_tables(tableau), options);
}

std::unique_ptr<Integrator> make_arkode_dirk(const std::string& table, const ArkodeOptions& options) {
  return make_arkode(dirk_name, dirk_title, built_in_diagonally_implicit_tables(table), options);
}
std::unique_ptr<Integrator> make_arkode_dirk(const schemes::ButcherTableau& tableau,
                                             const ArkodeOptions& options) {
  return make_arkode(dirk_name, dirk_title, diagonally_implicit_tables(tableau), options);
}

std::unique_ptr<Integrator> make_arkode_imex(const std::string& table, const ArkodeOptions& options) {
  return make_arkode(imex_name, imex_title, built_in_additive_tables(table), options);
}
std::unique_ptr<Integrator> make_arkode_imex(const schemes::AdditiveTableau& tableau,
                                             const ArkodeOptions& options) {
  return make_arkode(imex_name, imex_title, additive_tables(tableau), options);
}

}  // namespace fw::oracles
