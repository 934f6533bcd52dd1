#pragma once

#include <memory>

#include "ode/integrator.hpp"
#include "schemes/splitting_scheme.hpp"

namespace fw::integrators {

/// A composition of drifts and kicks, see `schemes::SplittingScheme`, with constant steps.
///
/// Where forces depend on position each kick costs one force, and where the scheme begins and ends with a
/// kick the last force of a step is the first of the next. Where they depend on velocity the kicks with α_i ≠
/// 0 are implicit and solved (see `ImplicitKick`). The orders are those of the order conditions, per class of
/// forces.
std::unique_ptr<Integrator> make_splitting(const schemes::SplittingScheme& scheme);

}  // namespace fw::integrators
