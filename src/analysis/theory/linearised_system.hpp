#pragma once

#include <memory>
#include <vector>

#include "ode/first_order_jacobian.hpp"
#include "ode/ode_system.hpp"

namespace fw::analysis {

/// A second-order system linearised about a state: M q̈ = K q + D q̇ with the constant K = ∂f/∂q and D = ∂f/∂v
/// of the original there; q is the displacement from that state, and what does not change with it (gravity,
/// the tension at rest) is left out. Fixed degrees of freedom stay fixed. Where the original has its forces
/// in a stiff and a soft part, so has this one.
class LinearisedSystem final : public OdeSystem, public SecondOrderSystem {
 public:
  /// About the state (q, v) at time t.
  LinearisedSystem(const SecondOrderSystem& original, double t, ConstVectorRef q, ConstVectorRef v);

  Index size() const override { return 2 * mass_.size(); }
  void rhs(double t, ConstVectorRef y, VectorRef dydt) const override;
  void rhs(const Float128& t, std::span<const Float128> y, std::span<Float128> dydt) const override;
  void rhs(double t, std::span<const Complex> y, std::span<Complex> dydt) const override;
  SparseMatrix jacobian_pattern() const override;
  void jacobian(double t, ConstVectorRef y, SparseMatrix& J) const override;
  void jacobian_product(double t, ConstVectorRef y, ConstVectorRef w, VectorRef out) const override;
  const SecondOrderSystem* second_order() const override { return this; }

  Index degrees_of_freedom() const override { return mass_.size(); }
  const Vector& mass() const override { return mass_; }
  const std::vector<char>& fixed() const override { return fixed_; }
  ForceClass force_class() const override { return force_class_; }
  void force(double t, ConstVectorRef q, ConstVectorRef v, VectorRef f) const override;
  SparseMatrix tangent_pattern() const override { return pattern_; }
  void stiffness(double t, ConstVectorRef q, ConstVectorRef v, TangentModel model,
                 SparseMatrix& K) const override;
  void damping(double t, ConstVectorRef q, ConstVectorRef v, SparseMatrix& D) const override;
  void tangent_product(double t, ConstVectorRef q, ConstVectorRef v, ConstVectorRef dq, ConstVectorRef dv,
                       VectorRef out) const override;
  const ForceSplitting* force_splitting() const override { return splitting_.get(); }

 private:
  class Splitting;
  template <class S>
  void evaluate(std::span<const S> y, std::span<S> dydt) const;

  Vector mass_;
  std::vector<char> fixed_;
  ForceClass force_class_;
  SparseMatrix pattern_;
  FirstOrderJacobian blocks_;
  SparseMatrix stiffness_, damping_;
  std::shared_ptr<const ForceSplitting> splitting_;
};

/// ẏ = Jy of a linear system ẏ = Jy + g(t): the system itself where g vanishes, else a LinearisedSystem or,
/// of first order, a dense system with the J at (t, y).
std::shared_ptr<const OdeSystem> homogeneous_part(const std::shared_ptr<const OdeSystem>& system, double t,
                                                  ConstVectorRef y);

}  // namespace fw::analysis
