#include "integrators/structural/hht_alpha.hpp"

#include <fmt/format.h>

#include "core/error.hpp"

namespace fw::integrators {

AlphaParameters alpha_parameters(const HhtAlphaOptions& options) {
  const double alpha = options.alpha;
  constexpr double rounding = 1e-12;  // of −1/3 as a decimal number
  if (!(alpha >= -1.0 / 3.0 - rounding && alpha <= 0.0)) {
    throw InputError(fmt::format("option alpha: found {}, expected a number in [-1/3, 0]", alpha));
  }
  return {.alpha_f = -alpha, .beta = 0.25 * (1.0 - alpha) * (1.0 - alpha), .gamma = 0.5 - alpha};
}

std::unique_ptr<Integrator> make_hht_alpha(const HhtAlphaOptions& options) {
  const AlphaParameters parameters = alpha_parameters(options);
  MethodInfo info{.name = "hht_alpha",
                  .title = "Hilber-Hughes-Taylor alpha",
                  .family = "structural dynamics",
                  .order = parameters.order(),
                  .order_with_velocity_forces = parameters.order(),
                  .stages = 1,
                  .is_explicit = false,
                  .carries_more_than_state = true,
                  .is_a_stable = parameters.is_unconditionally_stable(),
                  .needs = {Capability::second_order},
                  .formula =
                      "M a' = (1 + alpha) f(t+h, q', v') - alpha f(t, q, v);  Newmark with "
                      "gamma = ½ - alpha, beta = ¼(1 - alpha)²",
                  .reference = "[Hilber, Hughes, Taylor 1977; Hughes 1987, 9.3]"};
  return std::make_unique<FixedStepIntegrator>(std::move(info), alpha_family_stepper(parameters));
}

}  // namespace fw::integrators
