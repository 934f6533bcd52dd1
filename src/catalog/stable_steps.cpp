#include "catalog/stable_steps.hpp"

#include "analysis/theory/scheme_growth.hpp"
#include "analysis/theory/stability_limit.hpp"
#include "catalog/methods.hpp"
#include "core/special_values.hpp"

namespace fw::catalog {

namespace {

constexpr Index largest_dense = 400, largest_thorough = 20'000;
/// In units of one over the spectral radius: the first step that is looked at, and the last, beyond which a
/// scheme counts as one without a limit.
constexpr double first_step = 0.05, farthest_step = 1000.0;

}  // namespace

analysis::LinearModes modes_at(const OdeSystem& system, double t, ConstVectorRef y, SpectrumQuality quality) {
  const SecondOrderSystem* second_order = system.second_order();
  const Index limit = quality == SpectrumQuality::quick ? largest_dense : largest_thorough;
  if (second_order != nullptr && system.size() > limit) return analysis::stiffest_modes(*second_order, t, y);
  analysis::LinearModes modes = analysis::linear_modes(system, t, y, largest_dense);
  // Where eigenvalues lie dense, their vectors take long to converge, not they.
  if (second_order != nullptr && !modes.status.ok()) return analysis::stiffest_modes(*second_order, t, y);
  return modes;
}

StableStep stable_step(const std::string& call, const analysis::LinearModes& modes, const OdeSystem& system) {
  StableStep result{.call = call, .step = no_value};
  const std::shared_ptr<const Integrator> integrator = make_method(call);
  result.why = why_not_applicable(integrator->info(), system);
  if (result.why.empty() && !integrator->info().has_fixed_step) result.why = "it chooses its own steps";
  if (result.why.empty() && !modes.status.ok()) result.why = modes.status.describe();
  if (!result.why.empty()) return result;
  if (!(modes.spectral_radius > 0.0)) {
    result.step = infinity;
    return result;
  }
  const analysis::Theory theory = theory_of_call(call);
  analysis::LinearScheme scheme = theory.on_linear_systems;
  const analysis::SchemeGrowth growth(integrator, scheme);
  const double unit = 1.0 / modes.spectral_radius;
  result.step = analysis::predicted_limit(growth, modes, nullptr, integrator->info().is_explicit,
                                          first_step * unit, farthest_step * unit);
  if (std::isnan(result.step)) result.why = "theory has no answer for this scheme on this system";
  return result;
}

}  // namespace fw::catalog
