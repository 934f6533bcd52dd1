#include "integrators/structural/newmark.hpp"

#include <fmt/format.h>

#include "core/error.hpp"

namespace fw::integrators {

AlphaParameters alpha_parameters(const NewmarkOptions& options) {
  if (!(options.beta >= 0.0 && options.beta <= 0.5)) {
    throw InputError(fmt::format("option beta: found {}, expected a number in [0, 0.5]", options.beta));
  }
  if (!(options.gamma >= 0.5 && options.gamma <= 1.0)) {
    throw InputError(fmt::format("option gamma: found {}, expected a number in [0.5, 1]", options.gamma));
  }
  return {.beta = options.beta, .gamma = options.gamma};
}

std::unique_ptr<Integrator> make_newmark(const NewmarkOptions& options) {
  const AlphaParameters parameters = alpha_parameters(options);
  MethodInfo info{.name = "newmark",
                  .title = "Newmark's beta scheme",
                  .family = "structural dynamics",
                  .order = parameters.order(),
                  .order_with_velocity_forces = parameters.order(),
                  .stages = 1,
                  .is_explicit = options.beta == 0.0,
                  .is_symplectic = options.beta == 0.0 && options.gamma == 0.5,
                  .is_symmetric = options.gamma == 0.5,
                  .is_a_stable = parameters.is_unconditionally_stable(),
                  .needs = {Capability::second_order},
                  .formula =
                      "q' = q + h v + h² ((½ - beta) a + beta a');  v' = v + h ((1 - gamma) a + gamma a');  "
                      "M a' = f(t+h, q', v')",
                  .reference = "[Newmark 1959; Hughes 1987, 9.1]"};
  return std::make_unique<FixedStepIntegrator>(std::move(info), alpha_family_stepper(parameters));
}

}  // namespace fw::integrators
