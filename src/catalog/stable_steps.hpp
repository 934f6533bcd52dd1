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

/// How well the largest eigenvalues of a large system are wanted.
enum class SpectrumQuality {
  quick,    ///< to about a hundredth (`analysis::stiffest_modes`): before every run
  thorough  ///< to at least six digits up to 20 000 unknowns, which takes seconds there; above: quick
};

/// All eigenvalues up to 400 unknowns; above, the largest, as well as asked for.
analysis::LinearModes modes_at(const OdeSystem& system, double t, ConstVectorRef y, SpectrumQuality quality);

/// Of the method of a call on a system with these modes. Throws InputError for an unknown method or option.
StableStep stable_step(const std::string& call, const analysis::LinearModes& modes, const OdeSystem& system);

}  // namespace fw::catalog
