#include "integrators/energy_momentum/average_vector_field.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/error.hpp"
#include "integrators/implicit/step_matrix.hpp"
#include "integrators/loop/stepper.hpp"
#include "linalg/newton.hpp"

namespace fw::integrators {

namespace {

struct Quadrature {
  std::vector<double> node{}, weight{};
};

/// Gauss–Legendre on [0, 1]: the roots of P_m by Newton's iteration from Tricomi's estimate.
Quadrature gauss_legendre(int m) {
  Quadrature rule;
  for (int i = 0; i < m; ++i) {
    double x = std::cos(std::numbers::pi * (i + 0.75) / (m + 0.5));
    double slope = 0.0;
    for (int iteration = 0; iteration < 20; ++iteration) {
      double previous = 0.0, value = 1.0;  // P_{k−1}, P_k
      for (int k = 1; k <= m; ++k) {
        const double next = ((2.0 * k - 1.0) * x * value - (k - 1.0) * previous) / k;
        previous = value;
        value = next;
      }
      slope = m * (x * value - previous) / (x * x - 1.0);
      x -= value / slope;
    }
    rule.node.push_back(0.5 * (1.0 - x));
    rule.weight.push_back(1.0 / ((1.0 - x * x) * slope * slope));
  }
  return rule;
}

class AverageVectorFieldStepper final : public Stepper, private linalg::NewtonProblem {
 public:
  AverageVectorFieldStepper(const Quadrature& rule, const Ivp& ivp, Work& work)
      : rule_(rule),
        system_(*ivp.system->second_order()),
        work_(work),
        newton_(system_.degrees_of_freedom(), linalg::LinearSolverKind::sparse_lu),
        matrix_(system_),
        sum_(system_.tangent_pattern()),
        start_position_(system_.degrees_of_freedom()),
        start_velocity_(system_.degrees_of_freedom()),
        position_(system_.degrees_of_freedom()),
        velocity_(system_.degrees_of_freedom()),
        force_(system_.degrees_of_freedom()),
        impulse_(system_.degrees_of_freedom()) {}

  Status step(double t, double h, VectorRef y) override {
    const Index n = force_.size();
    time_ = t;
    step_ = h;
    start_position_ = y.head(n);
    start_velocity_ = y.tail(n);
    auto v = y.tail(n);
    const double scale =
        std::max(v.lpNorm<Eigen::Infinity>(), 1e-4 * start_position_.lpNorm<Eigen::Infinity>() / h);
    if (Status status = newton_.solve(*this, v, scale, work_); !status.ok()) return status;
    y.head(n) = start_position_ + (0.5 * h) * (start_velocity_ + v);
    return {};
  }

  void restart(double, ConstVectorRef) override { newton_.forget_matrix(); }
  void serialise(StateArchive& archive) override { newton_.serialise(archive); }

 private:
  /// The state at c on the segment from the start to the end with velocity v.
  void move_to(double c, ConstVectorRef v) {
    position_ = start_position_ + (0.5 * c * step_) * (start_velocity_ + v);
    velocity_ = start_velocity_ + c * (v - start_velocity_);
  }

  void residual(ConstVectorRef v, VectorRef out) override {
    impulse_.setZero();
    for (std::size_t i = 0; i < rule_.node.size(); ++i) {
      move_to(rule_.node[i], v);
      system_.force(time_ + rule_.node[i] * step_, position_, velocity_, force_);
      ++work_.rhs_evaluations;
      impulse_ += (rule_.weight[i] * step_) * force_;
    }
    out = system_.mass().cwiseProduct(v - start_velocity_) - impulse_;
  }

  const SparseMatrix& matrix(ConstVectorRef v) override {
    sum_.coeffs().setZero();
    for (std::size_t i = 0; i < rule_.node.size(); ++i) {
      const double c = rule_.node[i];
      const double weight = rule_.weight[i];
      move_to(c, v);
      ++work_.jacobian_evaluations;
      sum_.coeffs() += matrix_
                           .assemble(time_ + c * step_, position_, velocity_,
                                     {.mass = weight,
                                      .damping = -weight * c * step_,
                                      .stiffness = -0.5 * weight * c * step_ * step_},
                                     TangentModel::exact)
                           .coeffs();
    }
    return sum_;
  }

  const Quadrature rule_;
  const SecondOrderSystem& system_;
  Work& work_;
  linalg::Newton newton_;
  StepMatrix matrix_;
  SparseMatrix sum_;
  Vector start_position_, start_velocity_, position_, velocity_, force_, impulse_;
  double time_ = 0.0, step_ = 0.0;
};

}  // namespace

std::unique_ptr<Integrator> make_average_vector_field(const AverageVectorFieldOptions& options) {
  if (options.quadrature_points < 1 || options.quadrature_points > 8) {
    throw InputError(fmt::format("option quadrature_points: found {}, expected a whole number from 1 to 8",
                                 options.quadrature_points));
  }
  MethodInfo info{.name = "average_vector_field",
                  .title = "Average vector field",
                  .family = "energy-momentum",
                  .order = 2,
                  .order_with_velocity_forces = 2,
                  .stages = options.quadrature_points,
                  .is_explicit = false,
                  .is_symplectic = options.quadrature_points == 1,
                  .is_symmetric = true,
                  .is_a_stable = true,
                  .needs_second_order = true,
                  .formula =
                      "q' = q + ½h (v + v');  M (v' - v) = h int_0^1 f(t + xi h, q + xi (q' - q), "
                      "v + xi (v' - v)) dxi",
                  .reference = "[Quispel, McLaren 2008; McLachlan, Quispel, Robidoux 1999]"};
  const Quadrature rule = gauss_legendre(options.quadrature_points);
  return std::make_unique<FixedStepIntegrator>(
      std::move(info), [rule](const Ivp& ivp, double, Work& work) -> std::unique_ptr<Stepper> {
        return std::make_unique<AverageVectorFieldStepper>(rule, ivp, work);
      });
}

}  // namespace fw::integrators
