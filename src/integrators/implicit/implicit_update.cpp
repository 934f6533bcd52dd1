#include "integrators/implicit/implicit_update.hpp"

#include "integrators/implicit/implicit_acceleration.hpp"
#include "integrators/implicit/implicit_stage.hpp"

namespace fw::integrators {

namespace {

class FirstOrderUpdate final : public ImplicitUpdate {
 public:
  FirstOrderUpdate(const OdeSystem& system, Work& work)
      : work_(work), newton_(system.size()), equation_(system, work) {}

  Status solve(double t, double c, ConstVectorRef w, VectorRef y, VectorRef slope) override {
    equation_.set(t, c, w);
    Status status = newton_.solve(equation_, y, 0.0, work_);
    slope = (y - equation_.start()) / c;
    return status;
  }
  void forget_matrix() override { newton_.forget_matrix(); }
  void serialise(StateArchive& archive) override { newton_.serialise(archive); }

 private:
  Work& work_;
  linalg::Newton newton_;
  ImplicitStage equation_;
};

/// With y = (q, v): q' = w_q + c v', v' = w_v + c a, hence q' = w_q + c w_v + c² a.
class SecondOrderUpdate final : public ImplicitUpdate {
 public:
  SecondOrderUpdate(const SecondOrderSystem& system, Work& work)
      : equation_(system, work), acceleration_(system.degrees_of_freedom()) {}

  Status solve(double t, double c, ConstVectorRef w, VectorRef y, VectorRef slope) override {
    const Index n = acceleration_.size();
    equation_.base_velocity() = w.tail(n);
    equation_.base_position() = w.head(n) + c * w.tail(n);
    acceleration_ = (y.tail(n) - w.tail(n)) / c;
    Status status =
        equation_.solve({.time = t, .velocity_weight = c, .position_weight = c * c}, acceleration_);
    if (!status.ok()) return status;
    slope.tail(n) = acceleration_;
    slope.head(n) = w.tail(n) + c * acceleration_;
    y = w + c * slope;
    return {};
  }
  void forget_matrix() override { equation_.forget_matrix(); }
  void serialise(StateArchive& archive) override { equation_.serialise(archive); }

 private:
  ImplicitAcceleration equation_;
  Vector acceleration_;
};

}  // namespace

std::unique_ptr<ImplicitUpdate> make_implicit_update(const OdeSystem& system, Work& work) {
  if (system.second_order() != nullptr)
    return std::make_unique<SecondOrderUpdate>(*system.second_order(), work);
  return std::make_unique<FirstOrderUpdate>(system, work);
}

}  // namespace fw::integrators
