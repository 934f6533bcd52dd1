#include "integrators/special/predicted_velocity_verlet.hpp"

#include "integrators/loop/stepper.hpp"

namespace fw::integrators {

namespace {

class PredictedVelocityVerletStepper final : public Stepper {
 public:
  PredictedVelocityVerletStepper(const Ivp& ivp, Work& work)
      : system_(*ivp.system->second_order()),
        work_(work),
        inverse_mass_(system_.mass().cwiseInverse()),
        acceleration_(system_.degrees_of_freedom()),
        predicted_(system_.degrees_of_freedom()),
        force_(system_.degrees_of_freedom()) {
    restart(ivp.t0, ivp.y0);
  }

  Status step(double t, double h, VectorRef y) override {
    const Index n = force_.size();
    auto x = y.head(n);
    auto v = y.tail(n);
    x += h * v + (0.5 * h * h) * acceleration_;
    predicted_ = v + h * acceleration_;
    v += (0.5 * h) * acceleration_;
    accelerate(t + h, x, predicted_);
    v += (0.5 * h) * acceleration_;
    return {};
  }

  void restart(double t, ConstVectorRef y) override {
    const Index n = force_.size();
    accelerate(t, y.head(n), y.tail(n));
  }
  void serialise(StateArchive& archive) override { archive.visit("acceleration", acceleration_); }

 private:
  void accelerate(double t, ConstVectorRef x, ConstVectorRef v) {
    system_.force(t, x, v, force_);
    ++work_.rhs_evaluations;
    acceleration_ = inverse_mass_.cwiseProduct(force_);
  }

  const SecondOrderSystem& system_;
  Work& work_;
  Vector inverse_mass_;
  Vector acceleration_;  ///< a_n
  Vector predicted_, force_;
};

}  // namespace

std::unique_ptr<Integrator> make_predicted_velocity_verlet() {
  MethodInfo info{.name = "velocity_verlet_predicted",
                  .title = "velocity Verlet, dampers at a predicted velocity",
                  .family = "symplectic",
                  .order = 2,
                  .order_with_velocity_forces = 2,
                  .stages = 1,
                  .is_explicit = true,
                  .is_symplectic = true,
                  .is_symmetric = true,
                  .needs = {Capability::second_order},
                  .formula =
                      "x_{n+1} = x_n + h v_n + h²/2 a_n, v_{n+1} = v_n + h/2 (a_n + a_{n+1}), "
                      "a_{n+1} = M^-1 f(t_{n+1}, x_{n+1}, v_n + h a_n)",
                  .reference = "[Groot, Warren 1997, J. Chem. Phys. 107, with lambda = 1]"};
  return std::make_unique<FixedStepIntegrator>(
      std::move(info), [](const Ivp& ivp, double, Work& work) -> std::unique_ptr<Stepper> {
        return std::make_unique<PredictedVelocityVerletStepper>(ivp, work);
      });
}

}  // namespace fw::integrators
