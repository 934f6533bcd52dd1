#include "catalog/problems.hpp"

#include <fmt/format.h>

#include "core/error.hpp"
#include "problems/celestial.hpp"
#include "problems/cloth.hpp"
#include "problems/fermi_pasta_ulam.hpp"
#include "problems/linear_chain.hpp"
#include "problems/oscillators.hpp"
#include "problems/spring_pendulum.hpp"
#include "problems/stiff_equations.hpp"
#include "problems/test_equations.hpp"
#include "text/closest_name.hpp"

namespace fw::catalog {

const std::vector<ProblemEntry>& problems() {
  using namespace fw::problems;
  static const std::vector<ProblemEntry> list = {dahlquist_entry(),
                                                 dahlquist_complex_entry(),
                                                 rotation_entry(),
                                                 moving_centre_entry(),
                                                 prothero_robinson_entry(),
                                                 harmonic_oscillator_entry(),
                                                 damped_oscillator_entry(),
                                                 driven_duffing_entry(),
                                                 spring_pendulum_entry(),
                                                 linear_chain_entry(),
                                                 cloth_entry(),
                                                 kepler_entry(),
                                                 henon_heiles_entry(),
                                                 pleiades_entry(),
                                                 fermi_pasta_ulam_entry(),
                                                 van_der_pol_entry(),
                                                 robertson_entry()};
  return list;
}

const ProblemEntry& find_problem(const std::string& name) {
  std::vector<std::string> names;
  for (const ProblemEntry& entry : problems()) {
    if (entry.name == name) return entry;
    names.push_back(entry.name);
  }
  throw InputError(fmt::format("unknown problem \"{}\"{}; \"federwerk list problems\" shows all", name,
                               did_you_mean(name, names)));
}

}  // namespace fw::catalog
