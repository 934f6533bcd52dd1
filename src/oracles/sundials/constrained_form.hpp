#pragma once

#include <memory>

#include "constraints/distance_constraints.hpp"
#include "oracles/sundials/dae_form.hpp"

namespace fw::oracles::detail {

/// What an initial state leaves of g(q) = 0 [m] and G(q) v = 0 [m/s], m entries each.
struct ConstraintExcess {
  Vector position, velocity;
};

ConstraintExcess excess(const constraints::DistanceConstraints& constraints, ConstVectorRef q,
                        ConstVectorRef v);

/// The stabilised index-2 form of `solve_constrained` in the unknowns (q, v, μ, λ), 2n + 2m of them, with
/// g(q) and G(q) v held at `held` in place of zero: a start that is off by rounding is then consistent to the
/// last bit, without which a small first step makes large velocities of it. System and constraints outlive
/// it.
std::unique_ptr<DaeForm> make_constrained_form(const SecondOrderSystem& system,
                                               const constraints::DistanceConstraints& constraints,
                                               ConstraintExcess held);

}  // namespace fw::oracles::detail
