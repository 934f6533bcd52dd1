#include "integrators/special/implicit_euler_linearised.hpp"

#include "integrators/implicit/step_matrix.hpp"
#include "integrators/loop/stepper.hpp"

namespace fw::integrators {

namespace {

/// Springs live in space: their positions tell a multigrid solver the rigid body modes.
linalg::LinearSolverOptions with_coordinates(linalg::LinearSolverOptions options, const Ivp& ivp) {
  const SecondOrderSystem& system = *ivp.system->second_order();
  if (system.has_springs()) options.coordinates = ivp.y0.head(system.degrees_of_freedom());
  return options;
}

class LinearisedStepper final : public Stepper {
 public:
  LinearisedStepper(const LinearisedOptions& options, const Ivp& ivp, Work& work)
      : options_(options),
        system_(*ivp.system->second_order()),
        work_(work),
        needs_symmetry_(linalg::find_linear_solver(options.linear_solver.kind).needs_symmetric ||
                        options.linear_solver.kind == linalg::LinearSolverKind::petsc),
        solver_(linalg::make_linear_solver(with_coordinates(options.linear_solver, ivp))),
        matrix_(system_),
        right_hand_side_(system_.degrees_of_freedom()),
        product_(system_.degrees_of_freedom()),
        increment_(Vector::Zero(system_.degrees_of_freedom())),
        zero_(Vector::Zero(system_.degrees_of_freedom())) {}

  Status step(double t, double h, VectorRef y) override {
    const Index n = increment_.size();
    auto x = y.head(n);
    auto v = y.tail(n);
    const SparseMatrix& A = needs_symmetry_ ? matrix_.assemble_symmetric(t + h, x, v, h, options_.tangent)
                                            : matrix_.assemble(t + h, x, v, h, options_.tangent);
    ++work_.jacobian_evaluations;
    if (Status status = solver_->factorise(A, work_); !status.ok()) return advise(std::move(status));

    system_.force(t + h, x, v, right_hand_side_);
    ++work_.rhs_evaluations;
    system_.tangent_product(t + h, x, v, v, zero_, product_);
    ++work_.jacobian_products;
    right_hand_side_ = h * (right_hand_side_ + h * product_);
    linalg::LinearSolve solve = solver_->solve(right_hand_side_, increment_, work_);
    if (!solve.status.ok()) return advise(std::move(solve.status));
    v += increment_;
    x += h * v;
    return {};
  }

  void restart(double, ConstVectorRef) override {
    increment_.setZero();
    solver_->forget();
  }
  void serialise(StateArchive& archive) override {
    archive.visit("increment", increment_);  // where an iterative solver starts
    solver_->serialise(archive);
  }

 private:
  Status advise(Status status) const {
    if (status.code == StatusCode::matrix_indefinite && options_.tangent != TangentModel::psd_projection) {
      status.message +=
          "; compressed springs make the tangent stiffness indefinite (erratum E5): a smaller step, the "
          "tangent "
          "model psd_projection, or the linear solver lu go on";
    }
    return status;
  }

  LinearisedOptions options_;
  const SecondOrderSystem& system_;
  Work& work_;
  bool needs_symmetry_;
  std::unique_ptr<linalg::LinearSolver> solver_;
  StepMatrix matrix_;
  Vector right_hand_side_, product_, increment_, zero_;
};

}  // namespace

std::unique_ptr<Integrator> make_implicit_euler_linearised(const LinearisedOptions& options) {
  MethodInfo info{
      .name = "implicit_euler_linearised",
      .title = "Linearised implicit Euler (one solve)",
      .family = "implicit",
      .order = 1,
      .order_with_velocity_forces = 1,
      .stages = 1,
      .is_explicit = false,
      .is_a_stable = true,
      .is_l_stable = true,
      // The tangents other than the exact one are of spring elements.
      .needs = options.tangent == TangentModel::exact
                   ? Capabilities{Capability::second_order}
                   : Capabilities{Capability::second_order, Capability::springs},
      .iteration_tolerance = linalg::find_linear_solver(options.linear_solver.kind).is_iterative
                                 ? options.linear_solver.relative_tolerance
                                 : 0.0,
      .formula = "(M - hD - h²K) (v' - v) = h (f + h K v);  x' = x + h v';  f, K, D at (t+h, x, v)",
      .reference = "[Zachmann 2011, S25-S31; Baraff, Witkin 1998]"};
  return std::make_unique<FixedStepIntegrator>(
      std::move(info), [options](const Ivp& ivp, double, Work& work) -> std::unique_ptr<Stepper> {
        return std::make_unique<LinearisedStepper>(options, ivp, work);
      });
}

}  // namespace fw::integrators
