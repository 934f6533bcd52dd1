#pragma once

#include <memory>

#include "constraints/distance_constraints.hpp"
#include "oracles/sundials/dae_form.hpp"

namespace fw::oracles::detail {

/// The stabilised index-2 form of `solve_constrained` in the unknowns (q, v, μ, λ), 2n + 2m of them. System
/// and constraints outlive it.
std::unique_ptr<DaeForm> make_constrained_form(const SecondOrderSystem& system,
                                               const constraints::DistanceConstraints& constraints);

}  // namespace fw::oracles::detail
