#pragma once

#include <vector>

#include "problems/celestial.hpp"
#include "problems/cloth.hpp"
#include "problems/fermi_pasta_ulam.hpp"
#include "problems/linear_chain.hpp"
#include "problems/oscillators.hpp"
#include "problems/spring_pendulum.hpp"
#include "problems/stiff_equations.hpp"
#include "problems/test_equations.hpp"

namespace fw::problems {

inline std::vector<ProblemEntry> every_problem() {
  return {dahlquist_entry(),         dahlquist_complex_entry(),
          rotation_entry(),          moving_centre_entry(),
          prothero_robinson_entry(), harmonic_oscillator_entry(),
          damped_oscillator_entry(), driven_duffing_entry(),
          linear_chain_entry(),      cloth_entry(),
          spring_pendulum_entry(),   kepler_entry(),
          henon_heiles_entry(),      pleiades_entry(),
          fermi_pasta_ulam_entry(),  van_der_pol_entry(),
          robertson_entry()};
}

}  // namespace fw::problems
