#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ode/integrator.hpp"

namespace fw::oracles {

struct GslOptions {
  /// As in CvodeOptions: the tolerances that GSL gets, as a fraction of those given.
  double tolerance_factor = 1.0;
};

/// A stepper of GSL's odeiv2 and what is known of it.
struct GslStepper {
  std::string name;               ///< as GSL calls it, for example "rk8pd"
  double tolerance_factor = 1.0;  ///< the default: below 1 for the multistep ones (decision 0017)
};

/// Every stepper: rk2, rk4, rkf45, rkck, rk8pd, rk1imp, rk2imp, rk4imp, bsimp, msadams, msbdf.
const std::vector<GslStepper>& gsl_steppers();

/// The stepper `name` of GSL [Galassi et al. 2009, ch. 27] as the method "gsl:<name>", with our Jacobian
/// where it asks for one. GSL's Jacobians are dense: such a stepper refuses systems of more than 10 000
/// unknowns.
///
/// rk4 and the implicit Runge-Kutta steppers estimate their error by step doubling and go on with the two
/// half steps, so that a step h of theirs is two steps h/2 of the scheme. With a constant step nothing looks
/// at the error estimate; Newton's iteration of the implicit ones then has tolerances at the level of
/// rounding.
std::unique_ptr<Integrator> make_gsl_stepper(const std::string& name, const GslOptions& options);

}  // namespace fw::oracles
