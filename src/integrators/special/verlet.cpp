#include "integrators/special/verlet.hpp"

#include "integrators/implicit/implicit_kick.hpp"
#include "integrators/loop/stepper.hpp"

namespace fw::integrators {

namespace {

class VerletStepper final : public Stepper {
 public:
  VerletStepper(VerletVelocity velocity, const Ivp& ivp, Work& work)
      : velocity_(velocity),
        system_(*ivp.system->second_order()),
        work_(work),
        kick_(system_, work),
        inverse_mass_(system_.mass().cwiseInverse()),
        force_(system_.degrees_of_freedom()),
        displacement_(Vector::Zero(system_.degrees_of_freedom())),
        mean_velocity_(system_.degrees_of_freedom()) {
    restart(ivp.t0, ivp.y0);
  }

  Status step(double t, double h, VectorRef y) override {
    const Index n = force_.size();
    auto x = y.head(n);
    auto v = y.tail(n);
    if (first_) {
      displacement_ = h * v + (0.5 * h * h) * inverse_mass_.cwiseProduct(force_);
      first_ = false;
    } else {
      displacement_ += (h * h) * inverse_mass_.cwiseProduct(force_);
    }
    x += displacement_;
    mean_velocity_ = displacement_ / h;
    if (velocity_ == VerletVelocity::central) {
      v = mean_velocity_ + (0.5 * h) * inverse_mass_.cwiseProduct(force_);
      return kick_.solve(t + h, 0.5 * h, x, mean_velocity_, v, force_);
    }
    system_.force(t + h, x, mean_velocity_, force_);
    ++work_.rhs_evaluations;
    v = mean_velocity_ + (0.5 * h) * inverse_mass_.cwiseProduct(force_);
    return {};
  }

  void restart(double t, ConstVectorRef y) override {
    const Index n = force_.size();
    system_.force(t, y.head(n), y.tail(n), force_);
    ++work_.rhs_evaluations;
    first_ = true;
  }
  void serialise(StateArchive& archive) override {
    archive.visit("force", force_);
    archive.visit("displacement", displacement_);
    archive.visit("first step", first_);
  }

 private:
  VerletVelocity velocity_;
  const SecondOrderSystem& system_;
  Work& work_;
  ImplicitKick kick_;
  Vector inverse_mass_, force_;
  Vector displacement_;   ///< d_n = x_n − x_{n−1}
  Vector mean_velocity_;  ///< d_n/h
  bool first_ = true;
};

}  // namespace

std::unique_ptr<Integrator> make_verlet(VerletVelocity velocity) {
  const bool central = velocity == VerletVelocity::central;
  MethodInfo info{.name = central ? "verlet" : "verlet_backward_velocity",
                  .title = central ? "Verlet (two-step), dampers at the central velocity"
                                   : "Verlet (two-step), dampers at the backward difference",
                  .family = "symplectic",
                  .order = 2,
                  .order_with_velocity_forces = central ? 2 : 1,
                  .stages = 1,
                  .is_multistep = true,
                  .is_symplectic = true,
                  .is_symmetric = true,
                  .needs = {Capability::second_order},
                  .formula = central
                                 ? "x_{n+1} = 2x_n - x_{n-1} + h² M^-1 f(t_n, x_n, (x_{n+1} - x_{n-1})/(2h))"
                                 : "x_{n+1} = 2x_n - x_{n-1} + h² M^-1 f(t_n, x_n, (x_n - x_{n-1})/h)",
                  .reference = "[Zachmann 2011, S17-S18; Verlet 1967; Hairer, Lubich, Wanner 2003]"};
  return std::make_unique<FixedStepIntegrator>(
      std::move(info), [velocity](const Ivp& ivp, double, Work& work) -> std::unique_ptr<Stepper> {
        return std::make_unique<VerletStepper>(velocity, ivp, work);
      });
}

}  // namespace fw::integrators
