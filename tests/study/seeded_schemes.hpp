#pragma once

#include <functional>
#include <memory>

#include "integrators/loop/stepper.hpp"

namespace fw::study {

/// A scheme with a mistake in it, for checking that the verifier notices: `step` advances (q, v) of a
/// second-order system by h.
class SeededStepper final : public integrators::Stepper {
 public:
  using Step = std::function<void(const SecondOrderSystem&, double t, double h, VectorRef q, VectorRef v,
                                  Vector& memory)>;

  SeededStepper(const Ivp& ivp, Step step) : system_(*ivp.system->second_order()), step_(std::move(step)) {}
  Status step(double t, double h, VectorRef y) override {
    const Index n = system_.degrees_of_freedom();
    step_(system_, t, h, y.head(n), y.tail(n), memory_);
    return {};
  }
  void restart(double, ConstVectorRef) override { memory_.resize(0); }
  void serialise(StateArchive&) override {}

 private:
  const SecondOrderSystem& system_;
  Step step_;
  Vector memory_;
};

inline std::unique_ptr<Integrator> seeded_scheme(MethodInfo info, SeededStepper::Step step) {
  return std::make_unique<integrators::FixedStepIntegrator>(
      std::move(info), [step](const Ivp& ivp, double, Work&) -> std::unique_ptr<integrators::Stepper> {
        return std::make_unique<SeededStepper>(ivp, step);
      });
}

inline std::unique_ptr<Integrator> seeded_scheme(std::string name, int order, SeededStepper::Step step) {
  return seeded_scheme(MethodInfo{.name = name,
                                  .title = name,
                                  .family = "seeded",
                                  .order = order,
                                  .order_with_velocity_forces = order,
                                  .needs = {Capability::second_order}},
                       std::move(step));
}

}  // namespace fw::study
