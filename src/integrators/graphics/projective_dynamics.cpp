#include "integrators/graphics/projective_dynamics.hpp"

#include <fmt/format.h>

#include <array>
#include <vector>

#include "core/error.hpp"
#include "integrators/graphics/explicit_external_force.hpp"
#include "integrators/loop/mass_spring_access.hpp"
#include "integrators/loop/stepper.hpp"
#include "linalg/linear_solver.hpp"
#include "mechanics/elements/spring_force.hpp"

namespace fw::integrators {

namespace {

class ProjectiveDynamicsStepper final : public Stepper {
 public:
  ProjectiveDynamicsStepper(int iterations, const mechanics::MassSpringSystem& system, Work& work)
      : iterations_(iterations),
        system_(system),
        model_(system.model()),
        work_(work),
        external_(system, ExplicitExternalForce::Dampers::to_external, "projective_dynamics"),
        solver_(linalg::make_linear_solver({.kind = linalg::LinearSolverKind::sparse_cholesky})),
        row_(model_.mass.size(), -1),
        start_(system.degrees_of_freedom()),
        inertial_(system.degrees_of_freedom()),
        force_(system.degrees_of_freedom()) {
    for (std::size_t i = 0; i < row_.size(); ++i) {
      if (!system.fixed()[3 * i]) row_[i] = unknowns_++;
    }
    right_hand_side_.resize(unknowns_);
    for (Vector& correction : correction_) correction.resize(unknowns_);
  }

  Status step(double t, double h, VectorRef y) override {
    if (h != factorised_step_ || system_.element_revision() != factorised_revision_) {
      if (Status status = factorise(h); !status.ok()) return status;
    }
    const Index n = force_.size();
    auto q = y.head(n);
    auto v = y.tail(n);
    external_.evaluate(t + h, q, v, force_);
    ++work_.rhs_evaluations;
    start_ = q;
    inertial_ = q + h * v + (h * h) * force_.cwiseQuotient(system_.mass());
    q = inertial_;
    for (int iteration = 0; iteration < iterations_ && unknowns_ > 0; ++iteration) {
      if (Status status = descend(h, q); !status.ok()) return status;
    }
    v = (q - start_) / h;
    return {};
  }

  void restart(double, ConstVectorRef) override {
    factorised_step_ = 0.0;
    solver_->forget();
  }
  void serialise(StateArchive& archive) override {
    archive.visit("step of the matrix", factorised_step_);
    solver_->serialise(archive);
  }

 private:
  /// M + h²L over the moving particles, one row each: x, y and z have the same matrix.
  Status factorise(double h) {
    factorised_step_ = h;
    factorised_revision_ = system_.element_revision();
    std::vector<Eigen::Triplet<double, int>> entries;
    for (std::size_t i = 0; i < row_.size(); ++i) {
      if (row_[i] >= 0) entries.emplace_back(row_[i], row_[i], model_.mass[i]);
    }
    const mechanics::Springs& springs = model_.springs;
    for (std::size_t e = 0; e < springs.size(); ++e) {
      const double weight = h * h * rate(e);
      const int i = row_[static_cast<std::size_t>(springs.first[e])];
      const int j = row_[static_cast<std::size_t>(springs.second[e])];
      if (i >= 0) entries.emplace_back(i, i, weight);
      if (j >= 0) entries.emplace_back(j, j, weight);
      if (i >= 0 && j >= 0) {
        entries.emplace_back(i, j, -weight);
        entries.emplace_back(j, i, -weight);
      }
    }
    for (const mechanics::Anchor& anchor : model_.anchors) {
      const int i = row_[static_cast<std::size_t>(anchor.particle)];
      if (i >= 0) entries.emplace_back(i, i, h * h * anchor.stiffness);
    }
    SparseMatrix matrix(unknowns_, unknowns_);
    matrix.setFromTriplets(entries.begin(), entries.end());
    return unknowns_ > 0 ? solver_->factorise(matrix, work_) : Status{};
  }

  double rate(std::size_t e) const {
    return mechanics::with_spring_law(model_.springs.law_of(e), [&](auto law) {
      return mechanics::spring_rate<law()>(mechanics::spring_parameters(model_.springs, e));
    });
  }

  /// One local and one global step. The global step is solved for the correction of q', whose right-hand side
  /// is M (s − q') + h² times the elastic force at q': rounding is then relative to the correction.
  Status descend(double h, VectorRef q) {
    external_.elastic(q, force_);
    ++work_.rhs_evaluations;
    force_ = system_.mass().cwiseProduct(inertial_ - q) + (h * h) * force_;
    for (int axis = 0; axis < 3; ++axis) {
      Vector& correction = correction_[static_cast<std::size_t>(axis)];
      for (std::size_t i = 0; i < row_.size(); ++i) {
        if (row_[i] >= 0) right_hand_side_[row_[i]] = force_[3 * static_cast<Index>(i) + axis];
      }
      if (linalg::LinearSolve solve = solver_->solve(right_hand_side_, correction, work_);
          !solve.status.ok()) {
        return solve.status;
      }
      for (std::size_t i = 0; i < row_.size(); ++i) {
        if (row_[i] >= 0) q[3 * static_cast<Index>(i) + axis] += correction[row_[i]];
      }
    }
    return {};
  }

  int iterations_;
  const mechanics::MassSpringSystem& system_;
  const mechanics::MassSpringModel& model_;
  Work& work_;
  ExplicitExternalForce external_;
  std::unique_ptr<linalg::LinearSolver> solver_;
  std::vector<int> row_;  ///< row of each particle in the matrix, −1 where it is fixed
  int unknowns_ = 0;
  double factorised_step_ = 0.0;
  std::uint64_t factorised_revision_ = 0;  ///< of the elements
  Vector start_, inertial_, force_, right_hand_side_;
  std::array<Vector, 3> correction_;
};

}  // namespace

std::unique_ptr<Integrator> make_projective_dynamics(const ProjectiveDynamicsOptions& options) {
  if (options.iterations < 1) {
    throw InputError(
        fmt::format("option iterations: found {}, expected a whole number >= 1", options.iterations));
  }
  MethodInfo info{.name = "projective_dynamics",
                  .title = "Fast mass-spring (projective dynamics)",
                  .family = "graphics",
                  .order = 1,
                  .order_with_velocity_forces = 1,
                  .stages = options.iterations,
                  .is_explicit = false,
                  .needs = {Capability::second_order, Capability::springs},
                  .formula =
                      "repeat: p = l0 d'/|d'|;  (M + h²L) q' = M (q + h v) + h² (J p + f_ext);  "
                      "v' = (q' - q)/h",
                  .reference = "[Liu, Bargteil, O'Brien, Kavan 2013; Bouaziz et al. 2014]"};
  return std::make_unique<FixedStepIntegrator>(
      std::move(info), [options](const Ivp& ivp, double, Work& work) -> std::unique_ptr<Stepper> {
        return std::make_unique<ProjectiveDynamicsStepper>(
            options.iterations, require_mass_spring_system(*ivp.system, "projective_dynamics"), work);
      });
}

}  // namespace fw::integrators
