#pragma once

#include <memory>
#include <string>
#include <vector>

#include "analysis/theory/linear_modes.hpp"
#include "ode/integrator.hpp"

namespace fw::catalog {

/// The largest step of a method that is stable on a system linearised at one state, in theory.
struct StableStep {
  std::string call;   ///< the method
  double step = 0.0;  ///< [s]; infinite: no limit, 0: no step is stable, NaN: not known
  std::string why{};  ///< why it is not known
};

/// All eigenvalues up to 400 unknowns, the largest above.
analysis::LinearModes modes_at(const OdeSystem& system, double t, ConstVectorRef y);

/// Of the method of a call on a system with these modes. Throws InputError for an unknown method or option.
StableStep stable_step(const std::string& call, const analysis::LinearModes& modes, const OdeSystem& system);

}  // namespace fw::catalog
