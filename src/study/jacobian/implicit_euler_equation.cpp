#include "study/jacobian/implicit_euler_equation.hpp"

namespace fw::study {

ImplicitEulerEquation::ImplicitEulerEquation(const Ivp& ivp, double step, TangentModel model,
                                             bool is_symmetric)
    : system_(*ivp.system->second_order()),
      ivp_(ivp),
      step_(step),
      model_(model),
      is_symmetric_(is_symmetric),
      assembly_(system_),
      position_(system_.degrees_of_freedom()),
      velocity_(system_.degrees_of_freedom()),
      force_(system_.degrees_of_freedom()) {}

void ImplicitEulerEquation::move(ConstVectorRef increment) {
  const Index n = increment.size();
  velocity_ = ivp_.y0.tail(n) + increment;
  position_ = ivp_.y0.head(n) + step_ * velocity_;
}

void ImplicitEulerEquation::residual(ConstVectorRef increment, VectorRef out) {
  move(increment);
  system_.force(ivp_.t0 + step_, position_, velocity_, force_);
  out = system_.mass().cwiseProduct(increment) - step_ * force_;
}

const SparseMatrix& ImplicitEulerEquation::matrix(ConstVectorRef increment) {
  move(increment);
  const double t = ivp_.t0 + step_;
  return is_symmetric_ ? assembly_.assemble_symmetric(t, position_, velocity_, step_, model_)
                       : assembly_.assemble(t, position_, velocity_, step_, model_);
}

}  // namespace fw::study
