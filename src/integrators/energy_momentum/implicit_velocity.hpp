#pragma once

#include "integrators/loop/stepper.hpp"
#include "linalg/newton.hpp"

namespace fw::integrators {

/// A step of the energy-momentum schemes on M q̈ = f(t, q, v): with the impulse p(v') of a mean force between
/// the two ends of the step,
///   M (v' − v) = p(v'),   q' = q + ½h (v + v'),
/// solved for v' by Newton's iteration. The schemes differ in the mean.
class ImplicitVelocityStepper : public Stepper, private linalg::NewtonProblem {
 public:
  Status step(double t, double h, VectorRef y) final;
  void restart(double, ConstVectorRef) final { newton_.forget_matrix(); }
  void serialise(StateArchive& archive) final { newton_.serialise(archive); }

 protected:
  /// `system` and `work` outlive the stepper.
  ImplicitVelocityStepper(const SecondOrderSystem& system, Work& work);

  /// out = p(v') [N·s]. Counts its evaluations.
  virtual void impulse(ConstVectorRef v, VectorRef out) = 0;
  /// ∂(M v' − p)/∂v' [kg]. Counts its evaluations.
  const SparseMatrix& matrix(ConstVectorRef v) override = 0;
  std::uint64_t pattern_revision() const override { return system_.pattern_revision(); }

  double time() const { return time_; }                             ///< t at the start of the step
  double length() const { return length_; }                         ///< h
  const Vector& start_position() const { return start_position_; }  ///< q
  const Vector& start_velocity() const { return start_velocity_; }  ///< v

 private:
  void residual(ConstVectorRef v, VectorRef out) final;

  const SecondOrderSystem& system_;
  Work& work_;
  linalg::Newton newton_;
  Vector start_position_, start_velocity_, impulse_;
  double time_ = 0.0, length_ = 0.0;
};

}  // namespace fw::integrators
