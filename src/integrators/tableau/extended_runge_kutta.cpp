#include "integrators/tableau/extended_runge_kutta.hpp"

#include <limits>
#include <vector>

#include "integrators/implicit/stage_matrix.hpp"
#include "linalg/linear_solver.hpp"

namespace fw::integrators {

namespace {

constexpr int most_iterations = 120;

class ExtendedSteps {
 public:
  ExtendedSteps(const schemes::ButcherTableau& tableau, const Ivp& ivp, std::uint64_t steps)
      : exact_(schemes::values<Float128>(tableau)),
        rounded_(schemes::values<double>(tableau)),
        system_(*ivp.system),
        step_((Float128(ivp.t1) - Float128(ivp.t0)) / steps),
        size_(static_cast<std::size_t>(ivp.y0.size())),
        jacobian_(system_.jacobian_pattern()),
        matrix_(jacobian_, exact_.stages, std::vector<char>(rounded_.a.size(), 1)),
        solver_(linalg::default_direct_solver()),
        slopes_(size_ * static_cast<std::size_t>(exact_.stages), Float128(0)),
        stage_(size_),
        value_(size_),
        residual_(static_cast<Index>(slopes_.size())),
        correction_(residual_) {}

  /// False where the iteration does not converge.
  bool advance(const Float128& t, std::vector<Float128>& y) {
    Vector rounded(static_cast<Index>(size_));
    for (std::size_t k = 0; k < size_; ++k) rounded[static_cast<Index>(k)] = static_cast<double>(y[k]);
    system_.jacobian(static_cast<double>(t), rounded, jacobian_);
    const double h = static_cast<double>(step_);
    if (!solver_
             ->factorise(matrix_.assemble(Vector::Ones(rounded.size()), {{jacobian_, rounded_.a, -h}}), work_)
             .ok()) {
      return false;
    }
    double previous = std::numeric_limits<double>::infinity();
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
      evaluate_residual(t, y);
      if (!residual_.allFinite() || !solver_->solve(residual_, correction_, work_).status.ok()) return false;
      double scale = 0.0;
      for (std::size_t k = 0; k < slopes_.size(); ++k) {
        slopes_[k] -= Float128(correction_[static_cast<Index>(k)]);
        scale = std::max(scale, std::abs(static_cast<double>(slopes_[k])));
      }
      const double size = correction_.lpNorm<Eigen::Infinity>();
      if (size <= 1e-33 * scale || (size >= 0.5 * previous && size <= 1e-27 * scale)) {
        const auto s = static_cast<std::size_t>(exact_.stages);
        for (std::size_t i = 0; i < s; ++i) {
          for (std::size_t k = 0; k < size_; ++k) y[k] += step_ * exact_.b[i] * slopes_[i * size_ + k];
        }
        return true;
      }
      previous = size;
    }
    return false;
  }

  const Float128& step() const { return step_; }

 private:
  void evaluate_residual(const Float128& t, const std::vector<Float128>& y) {
    const auto s = static_cast<std::size_t>(exact_.stages);
    for (std::size_t i = 0; i < s; ++i) {
      stage_ = y;
      for (std::size_t j = 0; j < s; ++j) {
        const Float128 weight = step_ * exact_.a[i * s + j];
        if (weight == 0) continue;
        for (std::size_t k = 0; k < size_; ++k) stage_[k] += weight * slopes_[j * size_ + k];
      }
      system_.rhs(Float128(t + exact_.c[i] * step_), stage_, value_);
      for (std::size_t k = 0; k < size_; ++k) {
        residual_[static_cast<Index>(i * size_ + k)] =
            static_cast<double>(slopes_[i * size_ + k] - value_[k]);
      }
    }
  }

  schemes::TableauValues<Float128> exact_;
  schemes::TableauValues<double> rounded_;
  const OdeSystem& system_;
  Float128 step_;
  std::size_t size_;
  SparseMatrix jacobian_;
  StageMatrix matrix_;
  std::unique_ptr<linalg::LinearSolver> solver_;
  std::vector<Float128> slopes_, stage_, value_;
  Vector residual_, correction_;
  Work work_;
};

}  // namespace

ExtendedSolver make_extended_runge_kutta(const schemes::ButcherTableau& tableau) {
  return [tableau](const Ivp& ivp, std::uint64_t steps) {
    std::vector<Float128> y = initial_state_extended(ivp);
    ExtendedSteps run(tableau, ivp, steps);
    for (std::uint64_t n = 0; n < steps; ++n) {
      if (!run.advance(Float128(ivp.t0) + n * run.step(), y)) {
        return std::vector<Float128>(y.size(), std::numeric_limits<Float128>::quiet_NaN());
      }
    }
    return y;
  };
}

}  // namespace fw::integrators
