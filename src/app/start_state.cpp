#include "app/start_state.hpp"

#include <fmt/format.h>

#include <cmath>

#include "catalog/equilibrium.hpp"
#include "catalog/stable_steps.hpp"
#include "core/error.hpp"
#include "store/last_state.hpp"

namespace fw::app {

Vector start_state(const scene::Scene& scene, const mechanics::MassSpringSystem& system,
                   const std::string& from) {
  Vector state = initial_state(scene);
  const Index n = system.degrees_of_freedom();
  if (!from.empty()) {
    const store::LastState last = store::read_last_state(from);
    if (last.state.size() != state.size()) {
      throw InputError(fmt::format("--from: \"{}\" has {} particles, expected {} as in the scene", from,
                                   last.state.size() / 6, state.size() / 6));
    }
    state = last.state;
    for (Index i = 0; i < n; ++i) {
      if (!system.fixed()[static_cast<std::size_t>(i)]) continue;
      state[n + i] = 0.0;
    }
  } else if (scene.starts_at_equilibrium) {
    state.head(n) = catalog::require_equilibrium(system, scene.position);
  }
  return state;
}

StepAdvice advise_on_step(const std::string& call, double step, const mechanics::MassSpringSystem& system,
                          ConstVectorRef start) {
  const catalog::StableStep stable = catalog::stable_step(
      call, catalog::modes_at(system, 0.0, start, catalog::SpectrumQuality::quick), system);
  StepAdvice advice;
  if (std::isnan(stable.step) || std::isinf(stable.step)) return advice;
  if (stable.step == 0.0) {
    advice.note = "no step is stable at the start, in theory: an undamped mode grows at every step";
    return advice;
  }
  advice.note = fmt::format("the step is {:.3g} of the largest stable one at the start, {:.3g} s in theory",
                            step / stable.step, stable.step);
  if (step > stable.step) {
    advice.warning = fmt::format(
        "the step {} s is above the largest stable one at the start, {:.3g} s in theory: expect growth; take "
        "a shorter step or an implicit method",
        step, stable.step);
  }
  return advice;
}

}  // namespace fw::app
