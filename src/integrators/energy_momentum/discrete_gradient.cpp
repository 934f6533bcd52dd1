#include "integrators/energy_momentum/discrete_gradient.hpp"

#include "integrators/energy_momentum/implicit_velocity.hpp"
#include "integrators/loop/mass_spring_access.hpp"
#include "mechanics/mass_spring_system.hpp"

namespace fw::integrators {

namespace {

class DiscreteGradientStepper final : public ImplicitVelocityStepper {
 public:
  DiscreteGradientStepper(const mechanics::MassSpringSystem& system, Work& work)
      : ImplicitVelocityStepper(system, work),
        system_(system),
        work_(work),
        matrix_(system.tangent_pattern()),
        matrix_revision_(system.pattern_revision()),
        position_(system.degrees_of_freedom()),
        middle_position_(system.degrees_of_freedom()),
        middle_velocity_(system.degrees_of_freedom()),
        force_(system.degrees_of_freedom()) {}

 private:
  void move(ConstVectorRef v) {
    position_ = start_position() + (0.5 * length()) * (start_velocity() + v);
    middle_position_ = 0.5 * (start_position() + position_);
    middle_velocity_ = 0.5 * (start_velocity() + v);
  }

  mechanics::DiscreteStep moved() const {
    return {start_position().data(), position_.data(), middle_position_.data(), middle_velocity_.data()};
  }

  void impulse(ConstVectorRef v, VectorRef out) override {
    move(v);
    system_.elements().discrete_force(moved(), force_.data());
    system_.add_driving_force(time() + 0.5 * length(), force_);
    ++work_.rhs_evaluations;
    out = length() * force_;
  }

  const SparseMatrix& matrix(ConstVectorRef v) override {
    move(v);
    ++work_.jacobian_evaluations;
    const mechanics::BlockPattern& pattern = system_.block_pattern();
    if (pattern.revision() != matrix_revision_) {
      matrix_ = pattern.tangent();
      matrix_revision_ = pattern.revision();
    }
    matrix_.coeffs().setZero();
    for (int i = 0; i < static_cast<int>(system_.particle_count()); ++i) {
      mechanics::add_block(matrix_.valuePtr(), pattern.diagonal(i), system_.mass()[3 * i],
                           mechanics::Matrix3::Identity());
    }
    // ∂q'/∂v' = ½h, and ½ for every mean.
    system_.elements().fill_discrete(pattern, moved(),
                                     {.end = -0.5 * length() * length(),
                                      .middle = -0.25 * length() * length(),
                                      .velocity = -0.5 * length()},
                                     matrix_.valuePtr());
    return matrix_;
  }

  const mechanics::MassSpringSystem& system_;
  Work& work_;
  SparseMatrix matrix_;
  std::uint64_t matrix_revision_;
  Vector position_, middle_position_, middle_velocity_, force_;
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
                  .needs = {Capability::second_order, Capability::springs},
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
