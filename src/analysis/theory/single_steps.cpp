#include "analysis/theory/single_steps.hpp"

#include <Eigen/Dense>
#include <limits>

#include "analysis/theory/growth_matrices.hpp"
#include "core/special_values.hpp"
#include "ode/functor_system.hpp"

namespace fw::analysis {

namespace {

/// ẏ = λ y as a real system.
struct PlanarFlow {
  double real, imaginary;
  template <class S>
  void operator()(const S&, std::span<const S> y, std::span<S> dydt) const {
    dydt[0] = S(real) * y[0] - S(imaginary) * y[1];
    dydt[1] = S(imaginary) * y[0] + S(real) * y[1];
  }
};

struct Decay {
  double lambda;
  template <class S>
  void operator()(const S&, std::span<const S> y, std::span<S> dydt) const {
    dydt[0] = S(lambda) * y[0];
  }
};

struct Vibration {
  double omega_squared, damping;
  template <class S>
  void operator()(const S&, std::span<const S> q, std::span<const S> v, std::span<S> f) const {
    f[0] = -(S(omega_squared) * q[0] + S(damping) * v[0]);
  }
};

/// The matrix of a step on the moving part of a linear system, velocities in units of 1/h.
///
/// A scheme that keeps more than the state is known by its positions: x_{n+1} = P x_n + Q x_{n−1} is fitted
/// to three steps from every unit state. A fourth step tells whether there is such a recurrence.
Matrix step_matrix(const Integrator& integrator, const std::shared_ptr<const OdeSystem>& system, double h) {
  const SecondOrderSystem* second_order = system->second_order();
  const Index size = system->size(), n = second_order != nullptr ? size / 2 : size;
  std::vector<Index> moving;
  for (Index i = 0; i < size; ++i) {
    if (second_order == nullptr || !second_order->fixed()[static_cast<std::size_t>(i % n)])
      moving.push_back(i);
  }
  const auto unit = [&](Index i) { return second_order != nullptr && i >= n ? 1.0 / h : 1.0; };
  const auto m = static_cast<Index>(moving.size());
  const bool fits_positions = carries_more(integrator.info()) && second_order != nullptr;
  const int steps = fits_positions ? 4 : 1;
  std::vector<Matrix> after(static_cast<std::size_t>(steps) + 1, Matrix(m, m));
  for (Index j = 0; j < m; ++j) {
    const Index column = moving[static_cast<std::size_t>(j)];
    Vector start = Vector::Zero(size);
    start[column] = unit(column);
    const std::vector<Vector> states = states_after(integrator, system, h, steps, start);
    if (states.empty()) return Matrix::Constant(m, m, infinity);
    for (std::size_t k = 0; k < states.size(); ++k) {
      for (Index i = 0; i < m; ++i) {
        const Index row = moving[static_cast<std::size_t>(i)];
        after[k](i, j) = states[k][row] / unit(row);
      }
    }
  }
  if (!fits_positions) return after[1];
  const Index half = m / 2;
  Matrix window(m, m), next(m, m);
  window << after[2].topRows(half), after[1].topRows(half);
  next << after[3].topRows(half), after[2].topRows(half);
  const Matrix transition = window.transpose().fullPivLu().solve(next.transpose()).transpose();
  const Matrix predicted = (transition * next).topRows(half);
  const double size_of_step = after[4].topRows(half).cwiseAbs().maxCoeff();
  constexpr double allowed = 1e-6;
  if (!((predicted - after[4].topRows(half)).cwiseAbs().maxCoeff() <= allowed * (size_of_step + 1.0)))
    return Matrix::Constant(m, m, no_value);
  return transition;
}

}  // namespace

std::shared_ptr<const OdeSystem> planar_flow(Complex lambda) {
  return std::make_shared<FunctorSystem<PlanarFlow>>(2, PlanarFlow{lambda.real(), lambda.imag()});
}

std::shared_ptr<const OdeSystem> decay(double lambda) {
  return std::make_shared<FunctorSystem<Decay>>(1, Decay{lambda});
}

std::shared_ptr<const OdeSystem> vibration(double a, double b) {
  return std::make_shared<FunctorSecondOrderSystem<Vibration>>(
      Vector::Ones(1), b == 0.0 ? ForceClass::position : ForceClass::velocity, Vibration{a, b});
}

std::vector<Vector> states_after(const Integrator& integrator, const std::shared_ptr<const OdeSystem>& system,
                                 double h, int steps, const Vector& start) {
  TrajectoryRecorder recorder;
  const Solution solution =
      integrator.solve({system, 0.0, h * steps, start, {}}, FixedStep{.step = h}, recorder);
  return solution.status.ok() ? recorder.states() : std::vector<Vector>{};
}

bool carries_more(const MethodInfo& info) {
  return info.is_multistep || info.carries_more_than_state;
}

double growth_of_steps(const Integrator& integrator, const std::shared_ptr<const OdeSystem>& system,
                       double h) {
  const Matrix m = step_matrix(integrator, system, h);
  if (m.hasNaN()) return no_value;
  if (m.rows() == 2 && m.cols() == 2) return spectral_radius(Eigen::Matrix2d(m));
  return spectral_radius(m);
}

}  // namespace fw::analysis
