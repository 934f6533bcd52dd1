#include "analysis/theory/method_theory.hpp"

#include <utility>

namespace fw::analysis {

Theory theory_of(schemes::SchemeData coefficients) {
  const ModifiedEnergyRule modified_energy = modified_energy_rule(coefficients);
  return {.coefficients = coefficients,
          .on_position_forces = coefficients,
          .on_linear_systems = {std::move(coefficients)},
          .modified_energy = modified_energy};
}

Theory theory_on_linear_systems(LinearScheme scheme) {
  Theory theory;
  theory.on_linear_systems = std::move(scheme);
  return theory;
}

AmplificationFactors oscillator_factors(const Theory& theory) {
  if (AmplificationFactors factors = amplification_factors(theory.on_position_forces)) return factors;
  return amplification_factors(theory.on_linear_systems);
}

}  // namespace fw::analysis
