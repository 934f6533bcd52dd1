#include "mechanics/spring_parameter_derivative.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/error.hpp"
#include "mechanics/elements/spring_force.hpp"

namespace fw::mechanics {

namespace {

/// ∂(σ + k_d w·r)/∂p of one spring.
template <SpringLaw Law>
double tension_derivative(SpringParameter parameter, const SpringParameters& spring, double length,
                          double lengthening) {
  constexpr bool is_strain = Law == SpringLaw::strain;
  if (parameter == SpringParameter::damping) return lengthening;
  if (!spring_acts<Law>(spring, length)) return 0.0;
  const double l0 = spring.rest_length;
  if (parameter == SpringParameter::stiffness) return is_strain ? (length - l0) / l0 : length - l0;
  return is_strain ? -spring.stiffness * length / (l0 * l0) : -spring.stiffness;
}

}  // namespace

void validate(const SpringParameterGroup& group, const Springs& springs) {
  for (const int e : group.springs) {
    if (e < 0 || static_cast<std::size_t>(e) >= springs.size()) {
      throw InputError(
          fmt::format("spring of a parameter: found index {}, expected 0 to {}", e, springs.size() - 1));
    }
  }
}

void parameter_derivative(const MassSpringModel& model, const SpringParameterGroup& group, ConstVectorRef q,
                          ConstVectorRef v, VectorRef out) {
  const Springs& springs = model.springs;
  out.setZero();
  const auto add = [&](std::size_t e, SpringLaw law_of_spring) {
    const int i = springs.first[e];
    const int j = springs.second[e];
    const Vec3<double> d = load3(q.data(), j) - load3(q.data(), i);
    const double length = norm(d);
    if (length == 0.0) return;
    const Vec3<double> r = (1.0 / length) * d;
    const double lengthening = dot(load3(v.data(), j) - load3(v.data(), i), r);
    const double slope = with_spring_law(law_of_spring, [&](auto law) {
      return tension_derivative<decltype(law)::value>(group.parameter, spring_parameters(springs, e), length,
                                                      lengthening);
    });
    add3(out.data(), i, slope * r);
    add3(out.data(), j, -slope * r);
  };
  if (group.springs.empty()) {
    springs.for_each_group([&](const SpringGroup& of_one_law, std::size_t begin) {
      for (std::size_t e = begin; e < begin + of_one_law.size; ++e) add(e, of_one_law.law);
    });
  }
  for (const int e : group.springs) {
    add(static_cast<std::size_t>(e), springs.law_of(static_cast<std::size_t>(e)));
  }
  for (const int i : model.fixed) store3(out.data(), i, Vec3<double>{});
}

}  // namespace fw::mechanics
