#pragma once

#include "integrators/energy_momentum/average_vector_field.hpp"
#include "integrators/exponential/exponential_rosenbrock_euler.hpp"
#include "integrators/exponential/gautschi.hpp"
#include "integrators/graphics/projective_dynamics.hpp"
#include "integrators/graphics/xpbd.hpp"
#include "integrators/loop/step_size_controller.hpp"
#include "integrators/special/r_respa.hpp"
#include "integrators/structural/generalised_alpha.hpp"
#include "integrators/structural/hht_alpha.hpp"
#include "integrators/structural/newmark.hpp"
#include "integrators/tableau/runge_kutta_chebyshev.hpp"
#include "ode/second_order_system.hpp"
#include "settings/archive.hpp"

namespace fw::integrators {

/// The options of our schemes, as they stand in brackets.
void declare(settings::Archive& a, ControllerOptions& options);
void declare(settings::Archive& a, NewmarkOptions& options);
void declare(settings::Archive& a, HhtAlphaOptions& options);
void declare(settings::Archive& a, GeneralisedAlphaOptions& options);
void declare(settings::Archive& a, AverageVectorFieldOptions& options);
void declare(settings::Archive& a, ExponentialOptions& options);
void declare(settings::Archive& a, GautschiOptions& options);
void declare(settings::Archive& a, RespaOptions& options);
void declare(settings::Archive& a, ProjectiveDynamicsOptions& options);
void declare(settings::Archive& a, XpbdOptions& options);
void declare(settings::Archive& a, RungeKuttaChebyshevOptions& options);

}  // namespace fw::integrators

namespace fw::catalog {

/// The options of implicit_euler_linearised as they stand in brackets.
struct LinearisedEulerCall {
  std::string linear_solver = "cg";  ///< of `linalg::linear_solvers`
  double linear_tolerance = 1e-10;   ///< ‖b − A x‖₂/‖b‖₂ of iterative solvers
  std::string petsc{};               ///< options of the linear solver petsc, in its own notation
  TangentModel tangent = TangentModel::exact;
};
void declare(settings::Archive& a, LinearisedEulerCall& call);

}  // namespace fw::catalog
