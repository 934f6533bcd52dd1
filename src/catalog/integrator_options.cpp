#include "catalog/integrator_options.hpp"

namespace fw::integrators {

using settings::Archive;
using settings::choice;
using settings::setting;

namespace {

/// More steps inside of a step than anybody waits for.
constexpr int most_inner_steps = 1'000'000;

}  // namespace

void declare(Archive& a, ControllerOptions& options) {
  a(choice("controller", options.kind,
           {{"i", ControllerKind::integral},
            {"pi", ControllerKind::proportional_integral},
            {"pid", ControllerKind::proportional_integral_derivative}})
        .doc("i, pi or pid (how steps follow from error estimates)"));
  a(choice("norm", options.norm, {{"rms", ErrorNorm::root_mean_square}, {"max", ErrorNorm::maximum}})
        .doc("rms or max (how the error vector becomes a number)"));
  a(setting("safety", options.safety).between(1e-3, 1.0).doc("factor of the predicted step"));
}

void declare(Archive& a, NewmarkOptions& options) {
  a(setting("beta", options.beta)
        .between(0.0, 0.5)
        .doc("0 (central differences) to 0.5; 0.25 is average acceleration"));
  a(setting("gamma", options.gamma).between(0.5, 1.0).doc("0.5 (order 2) to 1 (numerical damping)"));
}

void declare(Archive& a, HhtAlphaOptions& options) {
  a(setting("alpha", options.alpha)
        .between(-1.0 / 3.0, 0.0)
        .doc("-1/3 to 0, as in the original paper; 0: no numerical damping"));
}

void declare(Archive& a, GeneralisedAlphaOptions& options) {
  a(setting("rho_infinity", options.rho_infinity)
        .between(0.0, 1.0)
        .doc("spectral radius at infinite frequency, 0 to 1"));
}

void declare(Archive& a, AverageVectorFieldOptions& options) {
  a(setting("quadrature_points", options.quadrature_points).integers(1, 8).doc("Gauss points, 1 to 8"));
}

void declare(Archive& a, ExponentialOptions& options) {
  a(setting("krylov_tolerance", options.krylov_tolerance)
        .between(1e-16, 1.0)
        .doc("of a phi function, relative to the state"));
  a(setting("krylov_dimension", options.krylov_dimension)
        .integers(1, 2000)
        .doc("largest dimension of the Krylov space"));
}

void declare(Archive& a, GautschiOptions& options) {
  a(choice("filter", options.filter,
           {{"gautschi", TrigonometricFilter::gautschi},
            {"deuflhard", TrigonometricFilter::deuflhard},
            {"mollified_impulse", TrigonometricFilter::mollified_impulse}})
        .doc("gautschi, deuflhard or mollified_impulse"));
}

void declare(Archive& a, RespaOptions& options) {
  a(setting("inner_steps", options.inner_steps)
        .integers(1, most_inner_steps)
        .doc("steps of the stiff forces per step"));
}

void declare(Archive& a, ProjectiveDynamicsOptions& options) {
  a(setting("iterations", options.iterations)
        .integers(1, most_inner_steps)
        .doc("local-global iterations per step"));
}

void declare(Archive& a, XpbdOptions& options) {
  a(setting("substeps", options.substeps).integers(1, most_inner_steps).doc("substeps per step"));
  a(setting("iterations", options.iterations).integers(1, most_inner_steps).doc("sweeps per substep"));
}

}  // namespace fw::integrators
