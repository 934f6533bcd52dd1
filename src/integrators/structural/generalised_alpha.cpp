#include "integrators/structural/generalised_alpha.hpp"

#include <fmt/format.h>

#include "core/error.hpp"

namespace fw::integrators {

AlphaParameters alpha_parameters(const GeneralisedAlphaOptions& options) {
  const double rho = options.rho_infinity;
  if (!(rho >= 0.0 && rho <= 1.0)) {
    throw InputError(fmt::format("option rho_infinity: found {}, expected a number in [0, 1]", rho));
  }
  AlphaParameters parameters;
  parameters.alpha_m = (2.0 * rho - 1.0) / (rho + 1.0);
  parameters.alpha_f = rho / (rho + 1.0);
  const double difference = parameters.alpha_f - parameters.alpha_m;
  parameters.gamma = 0.5 + difference;
  parameters.beta = 0.25 * (1.0 + difference) * (1.0 + difference);
  return parameters;
}

std::unique_ptr<Integrator> make_generalised_alpha(const GeneralisedAlphaOptions& options) {
  const AlphaParameters parameters = alpha_parameters(options);
  MethodInfo info{
      .name = "generalised_alpha",
      .title = "Generalised alpha (Chung-Hulbert)",
      .family = "structural dynamics",
      .order = parameters.order(),
      .order_with_velocity_forces = parameters.order(),
      .stages = 1,
      .is_explicit = false,
      .carries_more_than_state = true,
      .is_a_stable = parameters.is_unconditionally_stable(),
      .is_l_stable = options.rho_infinity == 0.0,
      .needs = {Capability::second_order},
      .formula =
          "M ((1 - alpha_m) a' + alpha_m a) = (1 - alpha_f) f(t+h, q', v') + alpha_f f(t, q, v);  "
          "q', v' as Newmark's",
      .reference = "[Chung, Hulbert 1993]"};
  return std::make_unique<FixedStepIntegrator>(std::move(info), alpha_family_stepper(parameters));
}

}  // namespace fw::integrators
