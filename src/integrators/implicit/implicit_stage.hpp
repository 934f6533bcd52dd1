#pragma once

#include "core/work.hpp"
#include "integrators/implicit/step_matrix.hpp"
#include "linalg/newton.hpp"

namespace fw::integrators {

/// The equation y − w − c f(t, y) = 0 of one implicit stage or step on a first-order system, with the matrix
/// I − cJ(t, y), for Newton's iterations.
class ImplicitStage final : public linalg::NewtonProblem {
 public:
  /// `system` and `work`, which counts right-hand sides and Jacobians, outlive the equation.
  ImplicitStage(const OdeSystem& system, Work& work)
      : system_(system), work_(work), matrix_(system), start_(system.size()), slope_(system.size()) {}

  /// The equation to be solved next: t [s], the weight c [s] and w, N entries.
  void set(double t, double c, ConstVectorRef w) {
    time_ = t;
    weight_ = c;
    start_ = w;
  }
  const Vector& start() const { return start_; }  ///< w

  void residual(ConstVectorRef y, VectorRef out) override {
    system_.rhs(time_, y, slope_);
    ++work_.rhs_evaluations;
    out = y - start_ - weight_ * slope_;
  }
  const SparseMatrix& matrix(ConstVectorRef y) override {
    ++work_.jacobian_evaluations;
    return matrix_.assemble(time_, y, weight_);
  }
  std::uint64_t pattern_revision() const override { return system_.pattern_revision(); }

 private:
  const OdeSystem& system_;
  Work& work_;
  ShiftedMatrix matrix_;
  Vector start_, slope_;
  double time_ = 0.0, weight_ = 0.0;
};

}  // namespace fw::integrators
