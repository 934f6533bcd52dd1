#include "integrators/energy_momentum/discrete_gradient.hpp"

#include <algorithm>
#include <variant>

#include "integrators/loop/mass_spring_access.hpp"
#include "integrators/loop/stepper.hpp"
#include "linalg/newton.hpp"
#include "mechanics/mass_spring_force.hpp"
#include "mechanics/mass_spring_system.hpp"
#include "mechanics/obstacle_tangent.hpp"
#include "mechanics/spring_discrete_gradient.hpp"
#include "mechanics/tangent_fill.hpp"

namespace fw::integrators {

namespace {

using mechanics::add_block;
using mechanics::Matrix3;

class DiscreteGradientStepper final : public Stepper, private linalg::NewtonProblem {
 public:
  DiscreteGradientStepper(const mechanics::MassSpringSystem& system, Work& work)
      : system_(system),
        model_(system.model()),
        work_(work),
        newton_(system.degrees_of_freedom(), linalg::LinearSolverKind::sparse_lu),
        pattern_(static_cast<int>(system.particle_count()), model_.springs.first, model_.springs.second),
        matrix_(pattern_.tangent()),
        start_position_(system.degrees_of_freedom()),
        start_velocity_(system.degrees_of_freedom()),
        position_(system.degrees_of_freedom()),
        middle_position_(system.degrees_of_freedom()),
        middle_velocity_(system.degrees_of_freedom()),
        force_(system.degrees_of_freedom()) {}

  Status step(double, double h, VectorRef y) override {
    const Index n = force_.size();
    step_ = h;
    start_position_ = y.head(n);
    start_velocity_ = y.tail(n);
    auto v = y.tail(n);
    const double scale =
        std::max(v.lpNorm<Eigen::Infinity>(), 1e-4 * start_position_.lpNorm<Eigen::Infinity>() / h);
    if (Status status = newton_.solve(*this, v, scale, work_); !status.ok()) return status;
    y.head(n) = start_position_ + (0.5 * h) * (start_velocity_ + v);
    return {};
  }

  void restart(double, ConstVectorRef) override { newton_.forget_matrix(); }
  void serialise(StateArchive& archive) override { newton_.serialise(archive); }

 private:
  bool is_free(int i) const { return system_.fixed()[3 * static_cast<std::size_t>(i)] == 0; }

  void move(ConstVectorRef v) {
    position_ = start_position_ + (0.5 * step_) * (start_velocity_ + v);
    middle_position_ = 0.5 * (start_position_ + position_);
    middle_velocity_ = 0.5 * (start_velocity_ + v);
  }

  /// Calls `visit(e, i, j, force)` with the discrete force of each spring.
  template <class Visit>
  void for_each_spring(Visit visit) const {
    const mechanics::Springs& springs = model_.springs;
    mechanics::with_spring_law(springs.law, [&](auto law) {
      for (std::size_t e = 0; e < springs.size(); ++e) {
        const int i = springs.first[e];
        const int j = springs.second[e];
        const auto difference = [&](const Vector& x) { return load3(x.data(), j) - load3(x.data(), i); };
        visit(e, i, j,
              mechanics::discrete_spring_force<law()>(mechanics::spring_parameters(springs, e),
                                                      difference(start_position_), difference(position_),
                                                      difference(middle_velocity_)));
      }
    });
  }

  void residual(ConstVectorRef v, VectorRef out) override {
    move(v);
    const auto particles = static_cast<int>(system_.particle_count());
    const double* x = middle_position_.data();
    const double* w = middle_velocity_.data();
    double* f = force_.data();
    for (int i = 0; i < particles; ++i) {
      store3(f, i, model_.mass[static_cast<std::size_t>(i)] * model_.gravity - model_.drag * load3(w, i));
    }
    for_each_spring([&](std::size_t, int i, int j, const mechanics::DiscreteSpringForce& spring) {
      add3(f, i, spring.force);
      add3(f, j, -spring.force);
    });
    for (const mechanics::Anchor& anchor : model_.anchors) {
      add3(f, anchor.particle,
           mechanics::anchor_force(anchor, load3(x, anchor.particle), load3(w, anchor.particle)));
    }
    for (const mechanics::Obstacle& obstacle : model_.obstacles) {
      std::visit(
          [&](const auto& shape) {
            for (int i = 0; i < particles; ++i) {
              add3(f, i, mechanics::obstacle_force(obstacle, shape, load3(x, i), load3(w, i)));
            }
          },
          obstacle.shape);
    }
    for (const int i : model_.fixed) store3(f, i, Vec3<double>{});
    ++work_.rhs_evaluations;
    out = system_.mass().cwiseProduct(v - start_velocity_) - step_ * force_;
  }

  const SparseMatrix& matrix(ConstVectorRef v) override {
    move(v);
    ++work_.jacobian_evaluations;
    matrix_.coeffs().setZero();
    double* values = matrix_.valuePtr();
    // ∂q'/∂v' = ½h, and ½ for every mean.
    const double per_end = -0.5 * step_ * step_, per_mean = -0.25 * step_ * step_,
                 per_velocity = -0.5 * step_;
    const auto add_point = [&](int i, const Matrix3& block) {
      if (is_free(i)) add_block(values, pattern_.diagonal(i), 1.0, block);
    };
    for (int i = 0; i < static_cast<int>(system_.particle_count()); ++i) {
      const double mass = model_.mass[static_cast<std::size_t>(i)];
      const double drag = is_free(i) ? -per_velocity * model_.drag : 0.0;
      add_block(values, pattern_.diagonal(i), mass + drag, Matrix3::Identity());
    }
    for_each_spring([&](std::size_t e, int i, int j, const mechanics::DiscreteSpringForce& spring) {
      const Matrix3 block = per_end * spring.position + per_velocity * spring.velocity;
      add_point(i, -block);
      add_point(j, -block);
      if (is_free(i)) add_block(values, pattern_.upper(e, j), 1.0, block);
      if (is_free(j)) add_block(values, pattern_.lower(e, i), 1.0, block);
    });
    for (const mechanics::Anchor& anchor : model_.anchors) {
      add_point(anchor.particle,
                (-per_mean * anchor.stiffness - per_velocity * anchor.damping) * Matrix3::Identity());
    }
    for (const mechanics::Obstacle& obstacle : model_.obstacles) {
      std::visit(
          [&](const auto& shape) {
            for (int i = 0; i < static_cast<int>(system_.particle_count()); ++i) {
              const mechanics::CentralForceTangent tangent =
                  mechanics::obstacle_tangent(obstacle, shape, load3(middle_position_.data(), i),
                                              load3(middle_velocity_.data(), i), TangentModel::exact);
              add_point(i, per_mean * tangent.position_block() + per_velocity * tangent.velocity_block());
            }
          },
          obstacle.shape);
    }
    return matrix_;
  }

  const mechanics::MassSpringSystem& system_;
  const mechanics::MassSpringModel& model_;
  Work& work_;
  linalg::Newton newton_;
  mechanics::BlockPattern pattern_;
  SparseMatrix matrix_;
  Vector start_position_, start_velocity_, position_, middle_position_, middle_velocity_, force_;
  double step_ = 0.0;
};

}  // namespace

std::unique_ptr<Integrator> make_discrete_gradient() {
  MethodInfo info{.name = "discrete_gradient",
                  .title = "Discrete gradient (energy-momentum)",
                  .family = "energy-momentum",
                  .order = 2,
                  .order_with_velocity_forces = 2,
                  .stages = 1,
                  .is_explicit = false,
                  .is_symmetric = true,
                  .conserves_energy = true,
                  .is_a_stable = true,
                  .needs_second_order = true,
                  .needs_springs = true,
                  .formula =
                      "q' = q + ½h (v + v');  M (v' - v) = h f;  spring force "
                      "(V(L') - V(L))/(L' - L) (d + d')/(L + L')",
                  .reference = "[LaBudde, Greenspan 1976; Gonzalez 1996; Simo, Tarnow, Wong 1992]"};
  return std::make_unique<FixedStepIntegrator>(
      std::move(info), [](const Ivp& ivp, double, Work& work) -> std::unique_ptr<Stepper> {
        return std::make_unique<DiscreteGradientStepper>(
            require_mass_spring_system(*ivp.system, "discrete_gradient"), work);
      });
}

}  // namespace fw::integrators
