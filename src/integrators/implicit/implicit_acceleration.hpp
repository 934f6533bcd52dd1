#pragma once

#include "core/work.hpp"
#include "integrators/implicit/step_matrix.hpp"
#include "linalg/newton.hpp"

namespace fw::integrators {

/// Solves the equation of one implicit step on M q̈ = f(t, q, v) for the acceleration a,
///   μ M a = r + φ f(t, q̂ + β₂ a, v̂ + β₁ a),
/// by Newton's iteration with the matrix μ M − φ (β₁ D + β₂ K) of half the size of the first-order system.
/// Where β₂ = 0 and forces depend on position only, the equation is explicit and costs one force.
///
/// Newton's corrections of a are driven below 1e-12·‖v̂‖∞/β₁ or 1e-16·‖q̂‖∞/β₂, that is, below what the step
/// can resolve in velocities or positions, or below 1e-12·‖a‖∞.
class ImplicitAcceleration final : private linalg::NewtonProblem {
 public:
  struct Coefficients {
    double time = 0.0;             ///< t
    double mass_factor = 1.0;      ///< μ
    double force_factor = 1.0;     ///< φ
    double velocity_weight = 0.0;  ///< β₁ [s]
    double position_weight = 0.0;  ///< β₂ [s²]
  };

  ImplicitAcceleration(const SecondOrderSystem& system, Work& work);

  Vector& base_position() { return base_position_; }  ///< q̂, set by the caller
  Vector& base_velocity() { return base_velocity_; }  ///< v̂, set by the caller
  Vector& load() { return load_; }                    ///< r, set by the caller; zero at construction

  /// `a` holds the initial guess and receives the solution. Fails with Newton's Status.
  Status solve(const Coefficients& coefficients, VectorRef a);

  /// Forgets the factors of Newton's iteration.
  void forget_matrix() { newton_.forget_matrix(); }
  void serialise(StateArchive& archive) { newton_.serialise(archive); }

  const Vector& position() const { return position_; }  ///< q̂ + β₂ a at the solution
  const Vector& velocity() const { return velocity_; }  ///< v̂ + β₁ a at the solution
  const Vector& force() const { return force_; }        ///< f there

 private:
  void residual(ConstVectorRef a, VectorRef out) override;
  const SparseMatrix& matrix(ConstVectorRef a) override;
  std::uint64_t pattern_revision() const override { return system_.pattern_revision(); }
  void evaluate(ConstVectorRef a);

  const SecondOrderSystem& system_;
  Work& work_;
  linalg::Newton newton_;
  StepMatrix matrix_;
  Coefficients coefficients_;
  Vector base_position_, base_velocity_, load_, position_, velocity_, force_;
};

}  // namespace fw::integrators
