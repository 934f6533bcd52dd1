#include "catalog/integrator_options.hpp"

#include "linalg/linear_solver.hpp"

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
        .doc("how steps follow from error estimates"));
  a(choice("norm", options.norm,
           {{"particle", ErrorNorm::largest_particle},
            {"rms", ErrorNorm::root_mean_square},
            {"max", ErrorNorm::maximum}})
        .doc("how the error vector becomes a number; particle: the largest root mean square of a particle "
             "(rms without springs)"));
  a(setting("safety", options.safety).between(1e-3, 1.0).doc("factor of the predicted step"));
}

void declare(Archive& a, NewmarkOptions& options) {
  a(setting("beta", options.beta)
        .between(0.0, 0.5)
        .doc("0 is central differences, 0.25 average acceleration"));
  a(setting("gamma", options.gamma).between(0.5, 1.0).doc("0.5 has order 2, more is numerical damping"));
}

void declare(Archive& a, HhtAlphaOptions& options) {
  a(setting("alpha", options.alpha)
        .between(-1.0 / 3.0, 0.0)
        .doc("as in the original paper; 0: no numerical damping"));
}

void declare(Archive& a, GeneralisedAlphaOptions& options) {
  a(setting("rho_infinity", options.rho_infinity)
        .between(0.0, 1.0)
        .doc("spectral radius at infinite frequency"));
}

void declare(Archive& a, AverageVectorFieldOptions& options) {
  a(setting("quadrature_points", options.quadrature_points).integers(1, 8).doc("Gauss points"));
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
        .doc("filter of the forces"));
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

void declare(Archive& a, RungeKuttaChebyshevOptions& options) {
  a(setting("stages", options.stages)
        .integers(fewest_chebyshev_stages, most_chebyshev_stages)
        .or_word("auto", 0)
        .doc("number of stages; auto: from the step and the spectral radius of J"));
}

}  // namespace fw::integrators

namespace fw::catalog {

void declare(settings::Archive& a, LinearisedEulerCall& call) {
  using settings::choice;
  using settings::setting;
  std::vector<std::string> solvers;
  for (const linalg::LinearSolverInfo& solver : linalg::linear_solvers()) solvers.push_back(solver.name);
  a(setting("linear_solver", call.linear_solver).choices(solvers).doc("of the linear equations of a step"));
  a(setting("linear_tolerance", call.linear_tolerance)
        .above(0.0)
        .up_to(1.0)
        .doc("relative residual of iterative solvers"));
  a(setting("petsc", call.petsc)
        .doc("options of the linear solver petsc, such as -ksp_type cg -pc_type gamg, without commas"));
  a(choice("tangent", call.tangent,
           {{"exact", TangentModel::exact},
            {"tensile_geometric_term", TangentModel::tensile_geometric_term},
            {"psd_projection", TangentModel::psd_projection}})
        .doc("what the matrix has where springs are compressed"));
}

}  // namespace fw::catalog
