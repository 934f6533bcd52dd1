#include "integrators/explicit_runge_kutta.hpp"

#include <stdexcept>
#include <vector>

#include "integrators/stepper.hpp"

namespace fw::integrators {

namespace {

class ExplicitRungeKuttaStepper final : public Stepper {
 public:
  ExplicitRungeKuttaStepper(const ButcherTableau& tableau, const Ivp& ivp, Work& work)
      : tableau_(tableau),
        system_(*ivp.system),
        work_(work),
        slopes_(static_cast<std::size_t>(tableau.stages()), Vector(ivp.y0.size())),
        stage_(ivp.y0.size()) {}

  Status step(double t, double h, VectorRef y) override {
    const Index s = tableau_.b.size();
    for (Index i = 0; i < s; ++i) {
      stage_ = y;
      for (Index j = 0; j < i; ++j) {
        if (tableau_.A(i, j) != 0.0) stage_ += (h * tableau_.A(i, j)) * slope(j);
      }
      system_.rhs(t + tableau_.c[i] * h, stage_, slope(i));
      ++work_.rhs_evaluations;
    }
    for (Index i = 0; i < s; ++i) {
      if (tableau_.b[i] != 0.0) y += (h * tableau_.b[i]) * slope(i);
    }
    return {};
  }

 private:
  Vector& slope(Index i) { return slopes_[static_cast<std::size_t>(i)]; }

  ButcherTableau tableau_;
  const OdeSystem& system_;
  Work& work_;
  std::vector<Vector> slopes_;
  Vector stage_;
};

}  // namespace

std::unique_ptr<Integrator> make_explicit_runge_kutta(const ButcherTableau& tableau) {
  if (!tableau.is_explicit()) throw std::logic_error("tableau \"" + tableau.name + "\" is not explicit");
  const int order = order_of_accuracy(tableau);
  MethodInfo info{.name = tableau.name,
                  .title = tableau.title,
                  .family = "explicit Runge-Kutta",
                  .order = order,
                  .order_with_velocity_forces = order,
                  .stages = tableau.stages(),
                  .formula = "k_i = f(t + c_i h, y + h sum_j a_ij k_j);  y' = y + h sum_i b_i k_i",
                  .reference = tableau.reference};
  return std::make_unique<FixedStepIntegrator>(
      std::move(info), [tableau](const Ivp& ivp, double, Work& work) -> std::unique_ptr<Stepper> {
        return std::make_unique<ExplicitRungeKuttaStepper>(tableau, ivp, work);
      });
}

}  // namespace fw::integrators
