#include "integrators/velocity_verlet.hpp"

#include "integrators/implicit_kick.hpp"
#include "integrators/stepper.hpp"

namespace fw::integrators {

namespace {

class VelocityVerletStepper final : public Stepper {
 public:
  VelocityVerletStepper(const Ivp& ivp, Work& work)
      : system_(*ivp.system->second_order()),
        kick_(system_, work),
        inverse_mass_(system_.mass().cwiseInverse()),
        force_(system_.degrees_of_freedom()),
        half_velocity_(system_.degrees_of_freedom()) {
    const Index n = force_.size();
    system_.force(ivp.t0, ivp.y0.head(n), ivp.y0.tail(n), force_);
    ++work.rhs_evaluations;
  }

  Status step(double t, double h, VectorRef y) override {
    const Index n = force_.size();
    auto x = y.head(n);
    auto v = y.tail(n);
    half_velocity_ = v + (0.5 * h) * inverse_mass_.cwiseProduct(force_);
    x += h * half_velocity_;
    // Predicts the second half-kick by the first: the iteration then starts with an error of O(h²).
    v = half_velocity_ + (0.5 * h) * inverse_mass_.cwiseProduct(force_);
    return kick_.solve(t + h, 0.5 * h, x, half_velocity_, v, force_);
  }

 private:
  const SecondOrderSystem& system_;
  ImplicitKick kick_;
  Vector inverse_mass_, force_, half_velocity_;
};

}  // namespace

std::unique_ptr<Integrator> make_velocity_verlet() {
  MethodInfo info{.name = "velocity_verlet",
                  .title = "Velocity Verlet",
                  .family = "symplectic",
                  .order = 2,
                  .order_with_velocity_forces = 2,
                  .stages = 1,
                  .is_symplectic = true,
                  .needs_second_order = true,
                  .formula = "v½ = v + ½h M^-1 f(t, x, v);  x' = x + h v½;  v' = v½ + ½h M^-1 f(t+h, x', v')",
                  .reference = "[Swope et al. 1982; Hairer, Lubich, Wanner 2003]"};
  return std::make_unique<FixedStepIntegrator>(
      std::move(info), [](const Ivp& ivp, double, Work& work) -> std::unique_ptr<Stepper> {
        return std::make_unique<VelocityVerletStepper>(ivp, work);
      });
}

}  // namespace fw::integrators
