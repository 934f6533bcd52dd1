#pragma once

#include <functional>
#include <memory>

#include "ode/ode_system.hpp"

namespace fw::conformance {

/// What a wrong scheme sees in place of the system: every entry that is set replaces or corrects an answer.
struct Alteration {
  std::function<double(double t)> time{};
  /// Corrects f(t, q, v).
  std::function<void(const SecondOrderSystem&, ConstVectorRef q, ConstVectorRef v, VectorRef f)> force{};
  /// Corrects ∂f/∂q and ∂f/∂v. The forces stay what they are, so that only matrices are wrong.
  std::function<void(const SecondOrderSystem&, ConstVectorRef q, SparseMatrix& K)> stiffness{};
  std::function<void(const SecondOrderSystem&, SparseMatrix& D)> damping{};
};

/// A system that answers wrongly, as a scheme would compute with a mistake in its code. A mistake that the
/// run in binary128 does not make: its right-hand side is passed on as it is.
class AlteredSystem final : public OdeSystem, public SecondOrderSystem {
 public:
  AlteredSystem(std::shared_ptr<const OdeSystem> system, Alteration alteration)
      : system_(std::move(system)), second_(system_->second_order()), alteration_(std::move(alteration)) {}

  Index size() const override { return system_->size(); }
  void rhs(double t, ConstVectorRef y, VectorRef dydt) const override {
    system_->rhs(time(t), y, dydt);
    if (second_ == nullptr || !alteration_.force) return;
    const Index n = degrees_of_freedom();
    Vector f(n);
    force(t, y.head(n), y.tail(n), f);
    dydt.tail(n) = f.cwiseQuotient(mass());
  }
  void rhs(const Float128& t, std::span<const Float128> y, std::span<Float128> dydt) const override {
    system_->rhs(t, y, dydt);
  }
  void rhs(double t, std::span<const Complex> y, std::span<Complex> dydt) const override {
    system_->rhs(time(t), y, dydt);
  }
  SparseMatrix jacobian_pattern() const override { return system_->jacobian_pattern(); }
  void jacobian(double t, ConstVectorRef y, SparseMatrix& J) const override {
    system_->jacobian(time(t), y, J);
  }
  void jacobian_product(double t, ConstVectorRef y, ConstVectorRef w, VectorRef out) const override {
    system_->jacobian_product(time(t), y, w, out);
  }
  const SecondOrderSystem* second_order() const override { return second_ == nullptr ? nullptr : this; }

  Index degrees_of_freedom() const override { return second_->degrees_of_freedom(); }
  const Vector& mass() const override { return second_->mass(); }
  const std::vector<char>& fixed() const override { return second_->fixed(); }
  ForceClass force_class() const override { return second_->force_class(); }
  bool has_springs() const override { return second_->has_springs(); }
  void force(double t, ConstVectorRef q, ConstVectorRef v, VectorRef f) const override {
    second_->force(time(t), q, v, f);
    if (alteration_.force) alteration_.force(*second_, q, v, f);
  }
  SparseMatrix tangent_pattern() const override { return second_->tangent_pattern(); }
  void stiffness(double t, ConstVectorRef q, ConstVectorRef v, TangentModel model,
                 SparseMatrix& K) const override {
    second_->stiffness(time(t), q, v, model, K);
    if (alteration_.stiffness) alteration_.stiffness(*second_, q, K);
  }
  void damping(double t, ConstVectorRef q, ConstVectorRef v, SparseMatrix& D) const override {
    second_->damping(time(t), q, v, D);
    if (alteration_.damping) alteration_.damping(*second_, D);
  }
  void tangent_product(double t, ConstVectorRef q, ConstVectorRef v, ConstVectorRef dq, ConstVectorRef dv,
                       VectorRef out) const override {
    second_->tangent_product(time(t), q, v, dq, dv, out);
  }
  const ForceSplitting* force_splitting() const override { return second_->force_splitting(); }

 private:
  double time(double t) const { return alteration_.time ? alteration_.time(t) : t; }

  std::shared_ptr<const OdeSystem> system_;
  const SecondOrderSystem* second_;
  Alteration alteration_;
};

}  // namespace fw::conformance
