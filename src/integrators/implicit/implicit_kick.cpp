#include "integrators/implicit/implicit_kick.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace fw::integrators {

namespace {

constexpr int max_newton_iterations = 50;
/// Relative to ‖v‖∞ + ‖c M⁻¹f‖∞: what is left is rounding, so that the kick never limits the observed order.
constexpr double newton_tolerance = 1e-14;
constexpr double linear_tolerance = 1e-13;

/// Backwards in time dampers drive: M − c D of c < 0 loses its definiteness where |c| D exceeds M.
Status explained(const Status& status, double c) {
  if (c >= 0.0 || status.code != StatusCode::matrix_indefinite) return status;
  return {
      status.code,
      fmt::format(
          "a substep goes back in time by {:.3g} s, longer than mass / damping, so that its matrix is not "
          "positive definite; expected a shorter step, or a method without negative substeps such as "
          "velocity_verlet ({})",
          -c, status.message)};
}

}  // namespace

ImplicitKick::ImplicitKick(const SecondOrderSystem& system, Work& work) : system_(system), work_(work) {
  const Index n = system.degrees_of_freedom();
  inverse_mass_ = system.mass().cwiseInverse();
  if (system.force_class() == ForceClass::position) return;
  residual_.resize(n);
  correction_.resize(n);
  candidate_.resize(n);
  zero_ = Vector::Zero(n);
  product_.resize(n);
  held_velocity_.resize(n);
  workspace_.resize(n);
}

Status ImplicitKick::solve(double t, double c, ConstVectorRef q, ConstVectorRef w, VectorRef v,
                           VectorRef force) {
  if (system_.force_class() == ForceClass::position) {
    system_.force(t, q, w, force);
    ++work_.rhs_evaluations;
    v = w + c * inverse_mass_.cwiseProduct(force);
    return {};
  }
  double previous = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < max_newton_iterations; ++iteration) {
    system_.force(t, q, v, force);
    ++work_.rhs_evaluations;
    candidate_ = w + c * inverse_mass_.cwiseProduct(force);
    residual_ = system_.mass().cwiseProduct(candidate_ - v);  // M (w − v) + c f
    const double scale = v.lpNorm<Eigen::Infinity>() + (candidate_ - w).lpNorm<Eigen::Infinity>();
    if (!std::isfinite(scale)) {
      return {StatusCode::non_finite, "the velocity of the implicit kick is not finite"};
    }
    const double defect = (candidate_ - v).lpNorm<Eigen::Infinity>();
    // The fixed-point map amplifies rounding by c‖M⁻¹D‖, so a tiny defect that has stopped falling is the
    // end.
    const bool stagnates = defect >= 0.5 * previous && defect <= 1e-9 * scale;
    if (defect <= newton_tolerance * scale || stagnates) {
      v = candidate_;
      return {};
    }
    previous = defect;
    held_velocity_ = v;
    const auto apply = [&](ConstVectorRef p, VectorRef out) {
      system_.tangent_product(t, q, held_velocity_, zero_, p, product_);
      ++work_.jacobian_products;
      out = system_.mass().cwiseProduct(p) - c * product_;
    };
    const auto precondition = [&](ConstVectorRef r, VectorRef out) { out = inverse_mass_.cwiseProduct(r); };
    correction_.setZero();
    const linalg::LinearSolve solve =
        linalg::conjugate_gradient(apply, precondition, residual_, correction_, linear_tolerance,
                                   10 * static_cast<std::uint64_t>(v.size()), workspace_);
    ++work_.linear_solves;
    work_.linear_iterations += solve.iterations;
    if (!solve.status.ok()) return explained(solve.status, c);
    v += correction_;
    ++work_.newton_iterations;
  }
  return {StatusCode::newton_failed,
          fmt::format("the implicit kick did not converge in {} Newton iterations", max_newton_iterations)};
}

}  // namespace fw::integrators
