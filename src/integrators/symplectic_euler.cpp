#include "integrators/symplectic_euler.hpp"

#include "integrators/stepper.hpp"

namespace fw::integrators {

namespace {

class SymplecticEulerStepper final : public Stepper {
 public:
  SymplecticEulerStepper(const Ivp& ivp, Work& work)
      : system_(*ivp.system->second_order()),
        work_(work),
        inverse_mass_(system_.mass().cwiseInverse()),
        force_(system_.degrees_of_freedom()) {}

  Status step(double t, double h, VectorRef y) override {
    const Index n = force_.size();
    auto x = y.head(n);
    auto v = y.tail(n);
    system_.force(t, x, v, force_);
    ++work_.rhs_evaluations;
    v += h * inverse_mass_.cwiseProduct(force_);
    x += h * v;
    return {};
  }

 private:
  const SecondOrderSystem& system_;
  Work& work_;
  Vector inverse_mass_, force_;
};

}  // namespace

std::unique_ptr<Integrator> make_symplectic_euler() {
  MethodInfo info{.name = "symplectic_euler",
                  .title = "Symplectic (semi-implicit) Euler",
                  .family = "symplectic",
                  .order = 1,
                  .order_with_velocity_forces = 1,
                  .stages = 1,
                  .is_symplectic = true,
                  .needs_second_order = true,
                  .formula = "v' = v + h M^-1 f(t, x, v);  x' = x + h v'",
                  .reference = "[Zachmann 2011, S9; Hairer, Lubich, Wanner 2006, I.1]"};
  return std::make_unique<FixedStepIntegrator>(
      std::move(info), [](const Ivp& ivp, double, Work& work) -> std::unique_ptr<Stepper> {
        return std::make_unique<SymplecticEulerStepper>(ivp, work);
      });
}

}  // namespace fw::integrators
