#include "integrators/structural/alpha_family.hpp"

#include <cmath>

#include "integrators/implicit/implicit_acceleration.hpp"

namespace fw::integrators {

namespace {

/// What decimal parameters leave of an equality.
constexpr double rounding = 1e-12;

class AlphaStepper final : public Stepper {
 public:
  AlphaStepper(const AlphaParameters& parameters, const Ivp& ivp, Work& work)
      : parameters_(parameters),
        system_(*ivp.system->second_order()),
        work_(work),
        equation_(system_, work),
        force_(system_.degrees_of_freedom()),
        acceleration_(system_.degrees_of_freedom()),
        new_acceleration_(system_.degrees_of_freedom()) {
    restart(ivp.t0, ivp.y0);
  }

  Status step(double t, double h, VectorRef y) override {
    const auto& [alpha_m, alpha_f, beta, gamma] = parameters_;
    const Index n = force_.size();
    auto q = y.head(n);
    auto v = y.tail(n);
    equation_.base_position() = q + h * v + (h * h * (0.5 - beta)) * acceleration_;
    equation_.base_velocity() = v + (h * (1.0 - gamma)) * acceleration_;
    equation_.load() = alpha_f * force_ - alpha_m * system_.mass().cwiseProduct(acceleration_);
    new_acceleration_ = acceleration_;
    const Status status = equation_.solve({.time = t + h,
                                           .mass_factor = 1.0 - alpha_m,
                                           .force_factor = 1.0 - alpha_f,
                                           .velocity_weight = h * gamma,
                                           .position_weight = h * h * beta},
                                          new_acceleration_);
    acceleration_ = new_acceleration_;
    force_ = equation_.force();
    q = equation_.position();
    v = equation_.velocity();
    return status;
  }

  void restart(double t, ConstVectorRef y) override {
    const Index n = force_.size();
    system_.force(t, y.head(n), y.tail(n), force_);
    ++work_.rhs_evaluations;
    acceleration_ = force_.cwiseQuotient(system_.mass());
    equation_.forget_matrix();
  }
  void serialise(StateArchive& archive) override {
    archive.visit("force", force_);
    archive.visit("acceleration", acceleration_);
    equation_.serialise(archive);
  }

 private:
  AlphaParameters parameters_;
  const SecondOrderSystem& system_;
  Work& work_;
  ImplicitAcceleration equation_;
  Vector force_, acceleration_, new_acceleration_;
};

}  // namespace

int AlphaParameters::order() const {
  return std::abs(gamma - (0.5 - alpha_m + alpha_f)) <= rounding ? 2 : 1;
}

bool AlphaParameters::is_unconditionally_stable() const {
  return alpha_m <= alpha_f + rounding && alpha_f <= 0.5 + rounding &&
         gamma >= 0.5 - alpha_m + alpha_f - rounding && beta >= 0.25 + 0.5 * (alpha_f - alpha_m) - rounding &&
         beta >= 0.5 * gamma - rounding;
}

StepperFactory alpha_family_stepper(const AlphaParameters& parameters) {
  return [parameters](const Ivp& ivp, double, Work& work) -> std::unique_ptr<Stepper> {
    return std::make_unique<AlphaStepper>(parameters, ivp, work);
  };
}

}  // namespace fw::integrators
