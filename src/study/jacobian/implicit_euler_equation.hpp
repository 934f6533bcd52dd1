#pragma once

#include <memory>

#include "integrators/implicit/step_matrix.hpp"
#include "linalg/newton.hpp"
#include "ode/ivp.hpp"

namespace fw::study {

/// The equation of one step of implicit Euler on M q̈ = f(t, q, v) from the initial state of a problem, in the
/// increment δ of the velocity: g(δ) = M δ − h f(t + h, q + h(v + δ), v + δ). Its derivative A = M − h D − h²
/// K is made with a tangent model, so that Newton's iteration is a modified one unless that is the exact one.
class ImplicitEulerEquation final : public linalg::NewtonProblem {
 public:
  /// `is_symmetric`: A is symmetrised and restricted, for conjugate gradients.
  ImplicitEulerEquation(const Ivp& ivp, double step, TangentModel model, bool is_symmetric);

  void residual(ConstVectorRef increment, VectorRef out) override;
  const SparseMatrix& matrix(ConstVectorRef increment) override;

 private:
  const SecondOrderSystem& system_;
  const Ivp& ivp_;
  double step_;
  TangentModel model_;
  bool is_symmetric_;
  integrators::StepMatrix assembly_;
  Vector position_, velocity_, force_;

  void move(ConstVectorRef increment);
};

}  // namespace fw::study
