#pragma once

#include <algorithm>
#include <cmath>

#include "ode/ode_system.hpp"
#include "ode/second_order_system.hpp"

namespace fw::integrators {

/// Whether states are [q; v] of particles in space that springs join.
inline bool has_particles(const SecondOrderSystem& system) {
  return system.has_springs() && system.degrees_of_freedom() % 3 == 0;
}
inline bool has_particles(const OdeSystem& system) {
  return system.second_order() != nullptr && has_particles(*system.second_order());
}

/// The largest root mean square of a particle's six components in a state [q; v] of particles in space,
/// max_i √((|q_i|² + |v_i|²)/6), of the numbers value(0), ..., value(size − 1). NaN where one is.
///
/// Equal to the root mean square over all components where all particles have the same; it does not fall with
/// the number of particles that rest while one moves.
template <class Value>
double largest_particle_norm(Index size, const Value& value) {
  const Index half = size / 2;
  double largest = 0.0;
  for (Index k = 0; k < half; k += 3) {
    double sum = 0.0;
    for (Index i = k; i < k + 3; ++i) {
      const double x = value(i), v = value(half + i);
      sum += x * x + v * v;
    }
    if (std::isnan(sum)) return sum;
    largest = std::max(largest, sum);
  }
  return std::sqrt(largest / 6.0);
}

}  // namespace fw::integrators
