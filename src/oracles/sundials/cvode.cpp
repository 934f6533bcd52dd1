#include "oracles/sundials/cvode.hpp"

#include <fmt/format.h>

#include "core/error.hpp"
#include "oracles/sundials/cvode_session.hpp"

namespace fw::oracles {

namespace detail {

CvodeIteration iteration_of(CvodeFormula formula, const CvodeOptions& options) {
  return options.iteration.value_or(formula == CvodeFormula::bdf ? CvodeIteration::newton
                                                                 : CvodeIteration::fixed_point);
}

MethodInfo cvode_info(CvodeFormula formula, const CvodeOptions& options) {
  const bool is_bdf = formula == CvodeFormula::bdf;
  const int highest = is_bdf ? 5 : 12;
  if (options.maximum_order < 0 || options.maximum_order > highest) {
    throw InputError(fmt::format("maximum order: found {}, expected 1 to {}, or 0 for the formula's own",
                                 options.maximum_order, highest));
  }
  if (options.krylov_dimension < 1) {
    throw InputError(
        fmt::format("Krylov dimension: found {}, expected a number >= 1", options.krylov_dimension));
  }
  if (!(options.tolerance_factor > 0.0)) {
    throw InputError(
        fmt::format("tolerance factor: found {}, expected a number > 0", options.tolerance_factor));
  }
  if (options.stability_limit_detection && !is_bdf) {
    throw InputError("stability limit detection: found it on, expected off: CVODE has it for BDF only");
  }
  return {.name = is_bdf ? "sundials:cvode_bdf" : "sundials:cvode_adams",
          .title = is_bdf ? "CVODE, variable-order BDF" : "CVODE, variable-order Adams-Moulton",
          .family = "oracle",
          .order = 0,
          .order_with_velocity_forces = 0,
          .stages = 1,
          .is_explicit = false,
          .is_multistep = true,
          .is_adaptive = true,
          .has_fixed_step = false,
          .dense_output = DenseOutput::library,
          .formula = is_bdf
                         ? "backward differentiation formulas of orders 1-5, steps and order chosen by error"
                         : "Adams-Moulton formulas of orders 1-12, steps and order chosen by error",
          .reference = "[Hindmarsh et al. 2005]"};
}

}  // namespace detail

namespace {

std::unique_ptr<Integrator> make_cvode(CvodeFormula formula, const CvodeOptions& options) {
  return std::make_unique<OracleIntegrator>(
      detail::cvode_info(formula, options),
      [formula, options](const Ivp& ivp, const StepControl& control, Work& work) {
        return std::make_unique<detail::CvodeStepper>(formula, options, ivp, control, work);
      },
      ToleranceScaling{.factor = options.tolerance_factor});
}

}  // namespace

std::unique_ptr<Integrator> make_cvode_bdf(const CvodeOptions& options) {
  return make_cvode(CvodeFormula::bdf, options);
}

std::unique_ptr<Integrator> make_cvode_adams(const CvodeOptions& options) {
  return make_cvode(CvodeFormula::adams, options);
}

}  // namespace fw::oracles
