#include "integrators/energy_momentum/average_vector_field.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/error.hpp"
#include "integrators/energy_momentum/implicit_velocity.hpp"
#include "integrators/implicit/step_matrix.hpp"

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

class AverageVectorFieldStepper final : public ImplicitVelocityStepper {
 public:
  AverageVectorFieldStepper(const Quadrature& rule, const SecondOrderSystem& system, Work& work)
      : ImplicitVelocityStepper(system, work),
        rule_(rule),
        system_(system),
        work_(work),
        matrix_(system),
        sum_(system.tangent_pattern()),
        position_(system.degrees_of_freedom()),
        velocity_(system.degrees_of_freedom()),
        force_(system.degrees_of_freedom()) {}

 private:
  /// The state at c on the segment from the start to the end with velocity v.
  void move_to(double c, ConstVectorRef v) {
    position_ = start_position() + (0.5 * c * length()) * (start_velocity() + v);
    velocity_ = start_velocity() + c * (v - start_velocity());
  }

  void impulse(ConstVectorRef v, VectorRef out) override {
    out.setZero();
    for (std::size_t i = 0; i < rule_.node.size(); ++i) {
      move_to(rule_.node[i], v);
      system_.force(time() + rule_.node[i] * length(), position_, velocity_, force_);
      ++work_.rhs_evaluations;
      out += (rule_.weight[i] * length()) * force_;
    }
  }

  const SparseMatrix& matrix(ConstVectorRef v) override {
    const double h = length();
    for (std::size_t i = 0; i < rule_.node.size(); ++i) {
      const double c = rule_.node[i];
      const double weight = rule_.weight[i];
      move_to(c, v);
      ++work_.jacobian_evaluations;
      const SparseMatrix& part = matrix_.assemble(
          time() + c * h, position_, velocity_,
          {.mass = weight, .damping = -weight * c * h, .stiffness = -0.5 * weight * c * h * h},
          TangentModel::exact);
      if (i == 0) {
        sum_ = part;  // takes the pattern as well
      } else {
        sum_.coeffs() += part.coeffs();
      }
    }
    return sum_;
  }

  const Quadrature rule_;
  const SecondOrderSystem& system_;
  Work& work_;
  StepMatrix matrix_;
  SparseMatrix sum_;
  Vector position_, velocity_, force_;
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
                  .needs = {Capability::second_order},
                  .formula =
                      "q' = q + ½h (v + v');  M (v' - v) = h int_0^1 f(t + xi h, q + xi (q' - q), "
                      "v + xi (v' - v)) dxi",
                  .reference = "[Quispel, McLaren 2008; McLachlan, Quispel, Robidoux 1999]"};
  const Quadrature rule = gauss_legendre(options.quadrature_points);
  return std::make_unique<FixedStepIntegrator>(
      std::move(info), [rule](const Ivp& ivp, double, Work& work) -> std::unique_ptr<Stepper> {
        return std::make_unique<AverageVectorFieldStepper>(rule, *ivp.system->second_order(), work);
      });
}

}  // namespace fw::integrators
