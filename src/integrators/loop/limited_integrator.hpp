#pragma once

#include <memory>

#include "ode/integrator.hpp"

namespace fw::integrators {

/// An adaptive method, own or foreign, whose steps are never longer than `maximum_step` [s], or than what the
/// step control allows where that is less. Constant steps stay as they are. Throws InputError unless
/// the method chooses steps and the length is a number > 0.
std::unique_ptr<Integrator> make_limited(std::unique_ptr<Integrator> method, double maximum_step);

}  // namespace fw::integrators
