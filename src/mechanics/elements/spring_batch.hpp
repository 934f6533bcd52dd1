#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "mechanics/elements/rope_switching.hpp"
#include "mechanics/elements/spring_discrete_gradient.hpp"
#include "mechanics/elements/spring_force.hpp"
#include "mechanics/elements/spring_tangent.hpp"
#include "mechanics/elements/tangent_blocks.hpp"

namespace fw::mechanics {

/// The springs [begin, end) of an array, all under one law [Zachmann 2011, S6-S7]. A view: the array has to
/// outlive it.
template <SpringLaw Law>
struct SpringBatch {
  static constexpr int arity = 2;
  static constexpr ElementLabels labels{.kind = "springs", .role = ElementRole::elastic, .energy = "elastic"};
  using Tangent = PairTangent;

  const Springs* springs = nullptr;
  std::size_t begin = 0, end = 0;

  std::size_t size() const { return end - begin; }
  std::array<int, 2> nodes(std::size_t e) const {
    return {springs->first[begin + e], springs->second[begin + e]};
  }
  SpringParameters parameters(std::size_t e) const { return spring_parameters(*springs, begin + e); }

  /// See `spring_force`.
  template <class Scalar>
  NodeVectors<Scalar, 2> force(std::size_t e, const NodeVectors<Scalar, 2>& x,
                               const NodeVectors<Scalar, 2>& v, std::uint64_t& degenerate) const {
    const Vec3<Scalar> f = spring_force<Law>(parameters(e), x[1] - x[0], v[1] - v[0], degenerate);
    return {f, -f};
  }
  /// The dampers alone.
  template <class Scalar>
  NodeVectors<Scalar, 2> damping_force(std::size_t e, const NodeVectors<Scalar, 2>& x,
                                       const NodeVectors<Scalar, 2>& v) const {
    const Vec3<Scalar> f = spring_damping_force(parameters(e), x[1] - x[0], v[1] - v[0]);
    return {f, -f};
  }
  /// See `spring_tangent`.
  bool tangent(std::size_t e, const NodeVectors<double, 2>& x, const NodeVectors<double, 2>& v,
               TangentModel model, Tangent& out, std::uint64_t& degenerate) const {
    out.coupling = spring_tangent<Law>(parameters(e), x[1] - x[0], v[1] - v[0], model, degenerate);
    return true;
  }
  /// [J]; a spring of length zero stores what its law says, ½ k_s l₀².
  template <class Scalar>
  Scalar energy(std::size_t e, const NodeVectors<Scalar, 2>& x) const {
    return spring_energy<Law>(parameters(e), norm(x[1] - x[0]));
  }
  /// See `spring_dissipated_power`.
  double dissipated_power(std::size_t e, const NodeVectors<double, 2>& x, const NodeVectors<double, 2>& v,
                          std::uint64_t& degenerate) const {
    return spring_dissipated_power(parameters(e), x[1] - x[0], v[1] - v[0], degenerate);
  }
  /// See `discrete_spring_force`.
  DiscreteForce<2, PairBlocks> discrete_force(std::size_t e, const NodeVectors<double, 2>& x,
                                              const NodeVectors<double, 2>& new_x,
                                              const NodeVectors<double, 2>& mean_v) const {
    const DiscreteSpringForce at =
        discrete_spring_force<Law>(parameters(e), x[1] - x[0], new_x[1] - new_x[0], mean_v[1] - mean_v[0]);
    return {{at.force, -at.force}, {at.position}, {at.velocity}};
  }
  /// dσ/dL where the spring acts [N/m].
  double rate(std::size_t e) const { return spring_rate<Law>(parameters(e)); }

  /// Of a rope, see `rope_phase`; other springs do not switch.
  template <class Scalar>
  int phase(std::size_t e, const NodeVectors<Scalar, 2>& x, const NodeVectors<Scalar, 2>&) const
      requires(Law == SpringLaw::tension_only) {
    return rope_phase(parameters(e), x[1] - x[0]);
  }
  /// See `rope_stays`.
  template <class Scalar>
  bool stays(std::size_t e, int phase, const NodePaths<Scalar, 2>& path) const {
    return rope_stays(parameters(e), phase, path);
  }
  /// A rope has a kink where its tension begins.
  Kink kink(std::size_t e, int, int to, const NodeVectors<double, 2>&, const NodeVectors<double, 2>&, double speed,
            double) const {
    const double stiffness = rate(e);
    return {.rate = stiffness * speed, .stiffness = to != 0 ? stiffness : 0.0};
  }
  std::size_t switch_number(std::size_t e) const { return begin + e; }

  ForceClass force_class() const {
    const auto damping = std::span(springs->damping).subspan(begin, size());
    return std::ranges::any_of(damping, [](double c) { return c > 0.0; }) ? ForceClass::velocity
                                                                          : ForceClass::position;
  }
  bool has_kinks() const { return Law == SpringLaw::tension_only; }
  bool is_internal() const { return true; }
  void validate(std::size_t particles) const;
};

/// Throws InputError unless the arrays are as long as one another and the groups cover them.
void validate_arrays(const Springs& springs);
/// Throws InputError that names the first entry of the springs [begin, end) that is out of its range.
void validate_springs(const Springs& springs, SpringLaw law, std::size_t begin, std::size_t end,
                      std::size_t particles);

template <SpringLaw Law>
void SpringBatch<Law>::validate(std::size_t particles) const {
  validate_springs(*springs, Law, begin, end, particles);
}

}  // namespace fw::mechanics
