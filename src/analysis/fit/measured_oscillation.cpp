#include "analysis/fit/measured_oscillation.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/special_values.hpp"
#include "ode/functor_system.hpp"

namespace fw::analysis {

namespace {

/// f = −k q.
struct Spring {
  double stiffness;
  template <class S>
  void operator()(const S&, std::span<const S> q, std::span<const S>, std::span<S> f) const {
    f[0] = -S(stiffness) * q[0];
  }
};

Ivp oscillator(double mass, double stiffness, double end_time) {
  const double omega = std::sqrt(stiffness / mass);
  return {std::make_shared<FunctorSecondOrderSystem<Spring>>(Vector::Constant(1, mass), ForceClass::position,
                                                             Spring{stiffness}),
          0.0,
          end_time,
          Vector{{1.0, 0.5 * omega}},
          {}};
}

/// (q, v·scale) of every step until the amplitude leaves the range.
class StateHistory final : public Observer {
 public:
  explicit StateHistory(double velocity_scale) : scale_(velocity_scale) {}

  bool observe(const StepView& view) override {
    const double q = view.state[0], v = scale_ * view.state[1];
    const double size = std::hypot(q, v);
    if (!(size > smallest && size < largest)) return false;
    positions.push_back(q);
    velocities.push_back(v);
    return true;
  }
  std::size_t size() const { return positions.size(); }
  double norm(std::size_t n) const { return std::hypot(positions[n], velocities[n]); }

  std::vector<double> positions, velocities;

 private:
  static constexpr double smallest = 1e-60, largest = 1e60;  // norms of solvers square and multiply
  double scale_;
};

/// The first step of the window.
std::size_t window_start(const StateHistory& history, int transient_steps) {
  constexpr double smallest = 1e-30, largest = 1e30;
  const auto last = static_cast<std::size_t>(transient_steps);
  for (std::size_t n = 0; n < history.size(); ++n) {
    if (n == last || history.norm(n) < smallest || history.norm(n) > largest) return n;
  }
  return history.size();
}

/// x_{n+2L} = s x_{n+L} − p x_n by weighted least squares.
struct Recurrence {
  double s = 0.0, p = 0.0, residual = 0.0;
  int points = 0;
};

Recurrence fit_recurrence(const StateHistory& history, std::size_t start, std::size_t lag) {
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  Recurrence fit;
  const auto visit = [&](const auto& use) {
    for (std::size_t n = start; n + 2 * lag < history.size(); ++n) {
      const double weight =
          1.0 / std::max({history.norm(n), history.norm(n + lag), history.norm(n + 2 * lag)});
      for (const std::vector<double>* x : {&history.positions, &history.velocities}) {
        use(Eigen::Vector2d{weight * (*x)[n + lag], -weight * (*x)[n]}, weight * (*x)[n + 2 * lag]);
      }
    }
  };
  visit([&](const Eigen::Vector2d& row, double value) {
    normal += row * row.transpose();
    right += value * row;
    ++fit.points;
  });
  if (fit.points == 0) return fit;
  const Eigen::Vector2d solution = normal.ldlt().solve(right);
  fit.s = solution[0];
  fit.p = solution[1];
  double sum = 0.0;
  visit([&](const Eigen::Vector2d& row, double value) {
    const double defect = row.dot(solution) - value;
    sum += defect * defect;
  });
  fit.residual = std::sqrt(sum / fit.points);
  return fit;
}

}  // namespace

MeasuredOscillation measure_oscillation(const Integrator& integrator, double mass, double stiffness, double z,
                                        const OscillationRun& run) {
  constexpr int fewest_steps = 32;
  const double omega = std::sqrt(stiffness / mass), h = z / omega;
  const auto lag = static_cast<std::size_t>(std::max(1L, std::lround(0.5 * std::numbers::pi / z)));
  const double window = std::ceil(run.periods * 2.0 * std::numbers::pi / z);
  const double steps = run.transient_steps + std::max(window, static_cast<double>(fewest_steps)) +
                       2.0 * static_cast<double>(lag);
  StateHistory history(1.0 / omega);
  MeasuredOscillation measured;
  measured.status =
      integrator
          .solve(oscillator(mass, stiffness, steps * h), FixedStep{.step = h}, history, {.stop = run.stop})
          .status;
  if (measured.status.code == StatusCode::stopped_by_observer) measured.status = {};

  const Recurrence fit = fit_recurrence(history, window_start(history, run.transient_steps), lag);
  measured.points = fit.points;
  if (fit.points == 0) return measured;
  measured.residual = fit.residual;
  const double discriminant = fit.p - 0.25 * fit.s * fit.s;
  const double power = 1.0 / static_cast<double>(lag);
  measured.oscillates = discriminant > 0.0;
  if (measured.oscillates) {
    measured.spectral_radius = std::pow(fit.p, 0.5 * power);
    measured.angle = std::atan2(std::sqrt(discriminant), 0.5 * fit.s) * power;
  } else {
    const double root = 0.5 * fit.s + std::copysign(std::sqrt(-discriminant), fit.s);
    measured.spectral_radius = std::pow(std::abs(root), power);
    measured.angle = root < 0.0 ? std::numbers::pi * power : 0.0;
  }
  measured.factor = std::polar(measured.spectral_radius, measured.angle);
  return measured;
}

double measure_radius_at_infinity(const Integrator& integrator, double mass, double stiffness, double z,
                                  const OscillationRun& run) {
  constexpr double most_steps = 2000.0;
  const double h = z / std::sqrt(stiffness / mass);
  StateHistory history(h);
  const Solution solution = integrator.solve(oscillator(mass, stiffness, most_steps * h),
                                             FixedStep{.step = h}, history, {.stop = run.stop});
  const bool ran = solution.status.ok() || solution.status.code == StatusCode::stopped_by_observer;
  if (!ran || history.size() < 3) return ran && history.size() > 0 ? 0.0 : no_value;
  const std::size_t n = (history.size() - 1) / 2;
  return std::pow(history.norm(2 * n) / history.norm(n), 1.0 / static_cast<double>(n));
}

}  // namespace fw::analysis
