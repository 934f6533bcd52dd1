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

}  // namespace fw::integrators
