#include "integrators/implicit/implicit_acceleration.hpp"

#include <algorithm>

namespace fw::integrators {

ImplicitAcceleration::ImplicitAcceleration(const SecondOrderSystem& system, Work& work)
    : system_(system),
      work_(work),
      newton_(system.degrees_of_freedom()),
      matrix_(system),
      base_position_(system.degrees_of_freedom()),
      base_velocity_(system.degrees_of_freedom()),
      load_(Vector::Zero(system.degrees_of_freedom())),
      position_(system.degrees_of_freedom()),
      velocity_(system.degrees_of_freedom()),
      force_(system.degrees_of_freedom()) {}

Status ImplicitAcceleration::solve(const Coefficients& coefficients, VectorRef a) {
  coefficients_ = coefficients;
  if (coefficients.position_weight == 0.0 && system_.force_class() == ForceClass::position) {
    evaluate(a);
    a = (load_ + coefficients.force_factor * force_).cwiseQuotient(coefficients.mass_factor * system_.mass());
    velocity_ = base_velocity_ + coefficients.velocity_weight * a;
    return {};
  }
  // Newton's tolerance is 1e-12 of this.
  double scale = 0.0;
  if (coefficients.velocity_weight > 0.0) {
    scale = base_velocity_.lpNorm<Eigen::Infinity>() / coefficients.velocity_weight;
  }
  if (coefficients.position_weight > 0.0) {
    scale = std::max(scale, 1e-4 * base_position_.lpNorm<Eigen::Infinity>() / coefficients.position_weight);
  }
  return newton_.solve(*this, a, scale, work_);
}

void ImplicitAcceleration::evaluate(ConstVectorRef a) {
  position_ = base_position_ + coefficients_.position_weight * a;
  velocity_ = base_velocity_ + coefficients_.velocity_weight * a;
  system_.force(coefficients_.time, position_, velocity_, force_);
  ++work_.rhs_evaluations;
}

void ImplicitAcceleration::residual(ConstVectorRef a, VectorRef out) {
  evaluate(a);
  out = coefficients_.mass_factor * system_.mass().cwiseProduct(a) - load_ -
        coefficients_.force_factor * force_;
}

const SparseMatrix& ImplicitAcceleration::matrix(ConstVectorRef a) {
  position_ = base_position_ + coefficients_.position_weight * a;
  velocity_ = base_velocity_ + coefficients_.velocity_weight * a;
  ++work_.jacobian_evaluations;
  return matrix_.assemble(coefficients_.time, position_, velocity_,
                          {.mass = coefficients_.mass_factor,
                           .damping = -coefficients_.force_factor * coefficients_.velocity_weight,
                           .stiffness = -coefficients_.force_factor * coefficients_.position_weight},
                          TangentModel::exact);
}

}  // namespace fw::integrators
