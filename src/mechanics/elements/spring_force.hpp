#pragma once

#include <cmath>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "core/error.hpp"
#include "core/extended_precision.hpp"
#include "core/vec3.hpp"
#include "mechanics/elements/springs.hpp"

namespace fw::mechanics {

/// Calls `function(std::integral_constant<SpringLaw, law>{})`: the law becomes a constant of the loop that
/// the function contains, so that no loop branches on it per spring.
template <class Function>
decltype(auto) with_spring_law(SpringLaw law, Function&& function) {
  switch (law) {
    case SpringLaw::hooke:
      return std::forward<Function>(function)(std::integral_constant<SpringLaw, SpringLaw::hooke>{});
    case SpringLaw::strain:
      return std::forward<Function>(function)(std::integral_constant<SpringLaw, SpringLaw::strain>{});
    case SpringLaw::tension_only:
      return std::forward<Function>(function)(std::integral_constant<SpringLaw, SpringLaw::tension_only>{});
  }
  throw InputError(
      "springs.law: found a value outside the enumeration, expected hooke, strain or tension_only");
}

/// The slope dσ/dL of the tension where the spring acts [N/m]: k_s, or k_s/l₀ under SpringLaw::strain.
template <SpringLaw Law>
double spring_rate(const SpringParameters& spring) {
  return Law == SpringLaw::strain ? spring.stiffness / spring.rest_length : spring.stiffness;
}

/// Whether a spring of length L exerts an elastic force; only a slack rope does not.
template <SpringLaw Law, class Scalar>
bool spring_acts(const SpringParameters& spring, const Scalar& length) {
  return Law != SpringLaw::tension_only || !(real_part(length) < spring.rest_length);
}

/// The tension σ(L) [N], negative in compression [Zachmann 2011, S6-S7].
template <SpringLaw Law, class Scalar>
Scalar spring_tension(const SpringParameters& spring, const Scalar& length) {
  if (!spring_acts<Law>(spring, length)) return Scalar(0);
  if constexpr (Law == SpringLaw::strain) {
    return spring.stiffness * (length - spring.rest_length) / spring.rest_length;
  } else {
    return spring.stiffness * (length - spring.rest_length);
  }
}

/// The elastic energy ∫ σ dL from l₀ to L [J]. It needs no direction and is defined at L = 0 too.
template <SpringLaw Law, class Scalar>
Scalar spring_energy(const SpringParameters& spring, const Scalar& length) {
  return 0.5 * spring_tension<Law>(spring, length) * (length - spring.rest_length);
}

/// The force on point i of a spring (i, j), σ(L) r + k_d (w·r) r [N]; the force on j is its negative
/// [Zachmann 2011, S6-S7].
///
/// d = x_j − x_i, w = v_j − v_i, L = ‖d‖, r = d/L. Where dᵀd is zero in the working arithmetic the direction
/// is undefined: the force is zero and `degenerate` goes up by one. (A spring with l₀ = 0 has the force k_s d
/// there, which needs no direction and vanishes with d, but keeps its derivative.) Finite wherever dᵀd and
/// wᵀd are finite, that is, up to lengths of about 1e154.
template <SpringLaw Law, class Scalar>
Vec3<Scalar> spring_force(const SpringParameters& spring, const Vec3<Scalar>& d, const Vec3<Scalar>& w,
                          std::uint64_t& degenerate) {
  using std::sqrt;
  const Scalar length_squared = dot(d, d);
  if (real_part(length_squared) == 0) {
    ++degenerate;
    return spring.rest_length == 0.0 ? Scalar(spring.stiffness) * d : Vec3<Scalar>{};
  }
  const Scalar length = sqrt(length_squared);
  const Vec3<Scalar> r = (Scalar(1) / length) * d;
  return (spring_tension<Law>(spring, length) + spring.damping * dot(w, r)) * r;
}

/// The damper's part of `spring_force` alone, k_d (w·r) r [N]; zero at L = 0.
template <class Scalar>
Vec3<Scalar> spring_damping_force(const SpringParameters& spring, const Vec3<Scalar>& d,
                                  const Vec3<Scalar>& w) {
  using std::sqrt;
  const Scalar length_squared = dot(d, d);
  if (real_part(length_squared) == 0) return {};
  const Vec3<Scalar> r = (Scalar(1) / sqrt(length_squared)) * d;
  return (spring.damping * dot(w, r)) * r;
}

/// The power that the damper of a spring dissipates, k_d (w·r)² [W]; zero, and counted, at L = 0.
inline double spring_dissipated_power(const SpringParameters& spring, const Vec3<double>& d,
                                      const Vec3<double>& w, std::uint64_t& degenerate) {
  const double length_squared = dot(d, d);
  if (length_squared == 0.0) {
    ++degenerate;
    return 0.0;
  }
  const double closing = dot(w, (1.0 / std::sqrt(length_squared)) * d);
  return spring.damping * closing * closing;
}

}  // namespace fw::mechanics
