#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "analysis/verification/verification.hpp"
#include "dense/factorisations.hpp"
#include "ode/functor_system.hpp"
#include "schemes/linear_form.hpp"
#include "schemes/property_list.hpp"

namespace fw::analysis {

namespace {

/// ẏ = J y with J = ((a, b), (c, d)).
struct LinearFlow {
  double a, b, c, d;
  template <class S>
  void operator()(const S&, std::span<const S> y, std::span<S> dydt) const {
    dydt[0] = S(a) * y[0] + S(b) * y[1];
    dydt[1] = S(c) * y[0] + S(d) * y[1];
  }
};

constexpr double oscillator_mass = 1.75;

/// m q̈ = −m (ω² q + 2δ q̇).
struct LinearOscillator {
  double omega_squared, delta;
  template <class S>
  void operator()(const S&, std::span<const S> q, std::span<const S> v, std::span<S> f) const {
    f[0] = -S(oscillator_mass) * (S(omega_squared) * q[0] + S(2.0 * delta) * v[0]);
  }
};

std::shared_ptr<const OdeSystem> linear_oscillator(double omega_squared, double delta) {
  return std::make_shared<FunctorSecondOrderSystem<LinearOscillator>>(
      Vector::Constant(1, oscillator_mass), delta == 0.0 ? ForceClass::position : ForceClass::velocity,
      LinearOscillator{omega_squared, delta});
}

Status steps_of(const Integrator& integrator, const std::shared_ptr<const OdeSystem>& system, int count,
                Eigen::Vector2d& y) {
  NullObserver observer;
  const Solution solution = integrator.solve({system, 0.0, static_cast<double>(count), Vector(y), {}},
                                             FixedStep{.step = 1.0}, observer);
  y = solution.state;
  return solution.status;
}

/// The matrix of one black-box step of length 1.
Eigen::Matrix2d step_matrix(const Integrator& integrator, const std::shared_ptr<const OdeSystem>& system,
                            Status& status) {
  Eigen::Matrix2d result;
  for (Index j = 0; j < 2; ++j) {
    Eigen::Vector2d y = Eigen::Vector2d::Unit(j);
    const Status step_status = steps_of(integrator, system, 1, y);
    if (!step_status.ok()) status = step_status;
    result.col(j) = y;
  }
  return result;
}

Eigen::Matrix2d evaluated(const std::vector<Float128>& p, const Eigen::Matrix2d& x) {
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  for (std::size_t k = p.size(); k-- > 0;)
    sum = sum * x + static_cast<double>(p[k]) * Eigen::Matrix2d::Identity();
  return sum;
}

/// Q(J)⁻¹ P(J).
Eigen::Matrix2d evaluated(const schemes::StabilityFunction& R, const Eigen::Matrix2d& J) {
  return evaluated(R.denominator, J).partialPivLu().solve(evaluated(R.numerator, J));
}

/// The largest difference of R(J) and the black box, relative to 1 + |R|, over matrices J with real and
/// complex eigenvalues in both half-planes.
double compare_runge_kutta(const Integrator& integrator, const schemes::StabilityFunction& R,
                           Status& status) {
  double largest = 0.0;
  const auto compare = [&](const std::shared_ptr<const OdeSystem>& system, const Eigen::Matrix2d& J) {
    const Eigen::Matrix2d expected = evaluated(R, J);
    const Eigen::Matrix2d found = step_matrix(integrator, system, status);
    largest =
        std::max(largest, (expected - found).cwiseAbs().maxCoeff() / (1.0 + expected.cwiseAbs().maxCoeff()));
  };
  const MethodInfo& info = integrator.info();
  if (!info.needs.has(Capability::second_order)) {
    const LinearFlow flows[] = {
        {-0.3, 0.2, -0.2, -0.3}, {-1.1, 0.7, -0.7, -1.1}, {0.4, -0.9, 0.9, 0.4}, {-2.5, 0.6, 0.0, -0.4}};
    for (const LinearFlow& flow : flows) {
      Eigen::Matrix2d J;
      J << flow.a, flow.b, flow.c, flow.d;
      compare(std::make_shared<FunctorSystem<LinearFlow>>(2, flow), J);
    }
  }
  for (const auto& [omega_squared, delta] : {std::pair{0.5, 0.0}, {2.0, 0.0}, {1.25, 0.375}, {0.25, 1.5}}) {
    const auto system = linear_oscillator(omega_squared, delta);
    if (!why_not_applicable(info, *system).empty()) continue;
    Eigen::Matrix2d J;
    J << 0.0, 1.0, -omega_squared, -2.0 * delta;
    compare(system, J);
  }
  return largest;
}

/// The same for a Nyström method on q̈ = −ω²q − 2δq̇ from its own coefficients.
double compare_nystrom(const Integrator& integrator, const schemes::NystromValues<Float128>& t,
                       Status& status) {
  const Index s = t.stages;
  Matrix a_position(s, s), a_velocity = Matrix::Zero(s, s);
  Vector c(s), b_position(s), b_velocity(s);
  for (Index i = 0; i < s; ++i) {
    const auto k = static_cast<std::size_t>(i);
    c[i] = static_cast<double>(t.c[k]);
    b_position[i] = static_cast<double>(t.b_position[k]);
    b_velocity[i] = static_cast<double>(t.b_velocity[k]);
    for (Index j = 0; j < s; ++j) {
      const auto entry = static_cast<std::size_t>(i * s + j);
      a_position(i, j) = static_cast<double>(t.a_position[entry]);
      if (!t.a_velocity.empty()) a_velocity(i, j) = static_cast<double>(t.a_velocity[entry]);
    }
  }
  double largest = 0.0;
  for (const auto& [omega_squared, delta] :
       {std::pair{0.5, 0.0}, {2.0, 0.0}, {1.25, 0.0625}, {0.25, 0.125}}) {
    const auto system = linear_oscillator(omega_squared, delta);
    if (!why_not_applicable(integrator.info(), *system).empty()) continue;
    // k = −ω²(q e + v c + Ā k) − 2δ(v e + A k).
    const Vector ones = Vector::Ones(s);
    const dense::Lu lu(
        Matrix(Matrix::Identity(s, s) + omega_squared * a_position + 2.0 * delta * a_velocity));
    const Vector by_position = lu.solve(Vector(-omega_squared * ones));
    const Vector by_velocity = lu.solve(Vector(-omega_squared * c - 2.0 * delta * ones));
    Eigen::Matrix2d expected;
    expected << 1.0 + b_position.dot(by_position), 1.0 + b_position.dot(by_velocity),
        b_velocity.dot(by_position), 1.0 + b_velocity.dot(by_velocity);
    const Eigen::Matrix2d found = step_matrix(integrator, system, status);
    largest =
        std::max(largest, (expected - found).cwiseAbs().maxCoeff() / (1.0 + expected.cwiseAbs().maxCoeff()));
  }
  return largest;
}

/// Residual of Σ α_j y_{n+j} = h λ Σ β_j y_{n+j} on a run of the code, after its start.
double compare_multistep(const Integrator& integrator, const schemes::MultistepFormula& formula,
                         Status& status) {
  const LinearFlow flow{-0.125, 0.25, -0.25, -0.125};
  TrajectoryRecorder recorder;
  const Solution solution = integrator.solve(
      {std::make_shared<FunctorSystem<LinearFlow>>(2, flow), 0.0, 20.0, Vector{{1.0, -0.5}}, {}},
      FixedStep{.step = 1.0}, recorder);
  status = solution.status;
  Eigen::Matrix2d J;
  J << flow.a, flow.b, flow.c, flow.d;
  const auto k = static_cast<std::size_t>(formula.steps());
  double largest = 0.0;
  for (std::size_t n = 0; n + k < recorder.states().size(); ++n) {
    Eigen::Vector2d residual = Eigen::Vector2d::Zero();
    double size = 0.0;
    for (std::size_t j = 0; j <= k; ++j) {
      const Eigen::Vector2d y = recorder.states()[n + j];
      residual += schemes::as<double>(formula.alpha[j]) * y - schemes::as<double>(formula.beta[j]) * (J * y);
      size = std::max(size, y.norm());
    }
    largest = std::max(largest, residual.norm() / size);
  }
  return largest;
}

PropertyCheck agreement(const char* property, double difference, double allowed, const Status& status) {
  PropertyCheck check{.property = property};
  check.claimed = "as the coefficients say";
  check.measured = fmt::format("differs by {:.1e}", difference);
  check.verdict = status.ok() && difference <= allowed ? Verdict::holds : Verdict::fails;
  if (check.verdict == Verdict::fails) {
    check.reason = status.ok() ? fmt::format("expected at most {:.1e}", allowed) : status.describe();
  }
  return check;
}

/// ‖y‖ after many steps of ẏ = λy (as a 2×2 system that is normal: the norm is |R|^steps).
double norm_after(const Integrator& integrator, double real, double imaginary, int steps) {
  const auto system =
      std::make_shared<FunctorSystem<LinearFlow>>(2, LinearFlow{real, imaginary, -imaginary, real});
  Eigen::Vector2d y{1.0, 0.0};
  const Status status = steps_of(integrator, system, steps, y);
  return status.ok() ? y.norm() : std::numeric_limits<double>::infinity();
}

double oscillation_after(const Integrator& integrator, double omega, int steps) {
  Eigen::Vector2d y{1.0, 0.5 * omega};
  const Status status = steps_of(integrator, linear_oscillator(omega * omega, 0.0), steps, y);
  return status.ok() ? std::hypot(y[0], y[1] / omega) : std::numeric_limits<double>::infinity();
}

/// A limit is tested on both sides at this distance or nearer.
constexpr double limit_window = 0.01;
/// A limit beyond this counts as none.
constexpr double farthest = 500.0;

/// `growth(x)` is the factor per step that the coefficients predict, `norm(x, steps)` what the code makes of
/// a start of size 1. Inside the limit it has to stay bounded, outside to grow by the predicted factor.
template <class Growth, class Norm>
void check_limit(const char* property, double limit, Growth growth, Norm norm,
                 std::vector<PropertyCheck>& checks) {
  PropertyCheck check{.property = property, .verdict = Verdict::holds};
  check.derived = std::isinf(limit) ? "infinite" : fmt::format("{:.5g}", limit);
  constexpr int many_steps = 4000;
  constexpr double bounded_below = 1e3;
  const double inside = std::isinf(limit) ? farthest : (1.0 - limit_window) * limit;
  if (inside > 1e-3) {
    const double size = norm(inside, many_steps);
    check.measured = fmt::format("bounded at {:.5g}", inside);
    if (!(size < bounded_below)) {
      check.verdict = Verdict::fails;
      check.measured = fmt::format("grows to {:.1e} at {:.5g}", size, inside);
    }
  }
  if (!std::isinf(limit) && limit <= farthest) {
    // Near the limit growth may be weak or end again (a narrow gap): the strongest one close by.
    double outside = limit, strongest = 1.0;
    const double end = std::max(1.05 * limit, 0.1);
    for (int k = 1; k <= 200; ++k) {
      const double x = limit + (end - limit) * k / 200.0;
      if (growth(x) > strongest) {
        strongest = growth(x);
        outside = x;
      }
      if (x >= (1.0 + limit_window) * limit && strongest > 1.001) break;
    }
    constexpr double clear_growth = 1e6;
    const double steps = std::log(clear_growth) / std::log(strongest);
    constexpr double most_steps = 20000.0;
    if (!(steps < most_steps)) {
      check.measured += fmt::format("{}growth outside too weak to run", check.measured.empty() ? "" : ", ");
    } else {
      const int count = std::max(100, static_cast<int>(steps));
      const double size = norm(outside, count);
      const double rate = std::log(size) / count, predicted = std::log(strongest);
      check.measured += fmt::format("{}grows at {:.5g}", check.measured.empty() ? "" : ", ", outside);
      // The start need not lie on the growing mode: its share costs some powers of ten, no more.
      if (!(size >= bounded_below) || !(rate <= 1.1 * predicted + 1e-3)) {
        check.verdict = Verdict::fails;
        check.reason = fmt::format("at {:.5g}: size {:.1e} after {} steps, predicted factor {:.8f} per step",
                                   outside, size, count, strongest);
      }
    }
  }
  checks.push_back(check);
}

}  // namespace

void verify_stability_function(const SchemeUnderTest& scheme, std::vector<PropertyCheck>& checks) {
  const char* property = "stability function";
  if (!scheme.integrator.info().has_fixed_step) {
    checks.push_back({.property = property, .reason = "the scheme has no fixed step"});
    return;
  }
  Status status;
  constexpr double allowed = 2e-11;
  const schemes::LinearForm form = schemes::linear_form(scheme.data);
  if (const auto* R = std::get_if<schemes::StabilityFunction>(&form)) {
    const double difference = compare_runge_kutta(scheme.integrator, *R, status);
    checks.push_back(agreement(property, difference, allowed, status));
    checks.back().derived = schemes::to_text(*R);
  } else if (const auto* nystrom = std::get_if<schemes::NystromValues<Float128>>(&form)) {
    const double difference = compare_nystrom(scheme.integrator, *nystrom, status);
    checks.push_back(agreement("oscillator matrix", difference, allowed, status));
  } else if (const auto* multistep = std::get_if<schemes::MultistepFormula>(&form)) {
    const double difference = compare_multistep(scheme.integrator, *multistep, status);
    checks.push_back(agreement("recurrence of the formula", difference, allowed, status));
  } else {
    checks.push_back({.property = property, .reason = "the scheme is not given by coefficients"});
  }
}

void verify_stability_limits(const SchemeUnderTest& scheme, std::vector<PropertyCheck>& checks) {
  const MethodInfo& info = scheme.integrator.info();
  const schemes::DerivedProperties derived = schemes::derive(scheme.data);
  if (!info.has_fixed_step) return;
  if (derived.stability && !info.needs.has(Capability::second_order)) {
    const schemes::StabilityFunction& R = *derived.stability_function;
    check_limit(
        "real stability interval", derived.stability->real_interval,
        [&](double x) {
          return std::abs(R({-x, 0.0}));
        },
        [&](double x, int steps) { return norm_after(scheme.integrator, -x, 0.0, steps); }, checks);
    check_limit(
        "imaginary stability interval", derived.stability->imaginary_interval,
        [&](double x) {
          return std::abs(R({0.0, x}));
        },
        [&](double x, int steps) { return norm_after(scheme.integrator, 0.0, x, steps); }, checks);
  }
  const schemes::LinearForm form = schemes::linear_form(scheme.data);
  if (const auto* nystrom = std::get_if<schemes::NystromValues<Float128>>(&form)) {
    check_limit(
        "stability interval, oscillator", derived.oscillator->interval,
        [&](double x) { return schemes::oscillator_growth(*nystrom, x); },
        [&](double x, int steps) { return oscillation_after(scheme.integrator, x, steps); }, checks);
  }
  if (!info.is_a_stable && !info.is_l_stable) return;
  // A-stability of the running code: bounded on the axes and on rays far out; L: one step far out kills
  // everything.
  PropertyCheck check{.property = info.is_l_stable ? "L-stability" : "A-stability", .claimed = "yes"};
  if (derived.stability) {
    const bool derived_too =
        info.is_l_stable ? derived.stability->is_l_stable : derived.stability->is_a_stable;
    check.derived = derived_too ? "yes" : "no";
  }
  bool bounded = true, ran = false;
  double decay = 0.0;
  const auto apply = [&](double r, double degrees) {
    const double angle = degrees * std::numbers::pi / 180.0;
    const double real = -r * std::cos(angle), imaginary = r * std::sin(angle);
    // λ and its conjugate: as a first-order system, or the oscillator with ω² = r², δ = −Re λ.
    const std::shared_ptr<const OdeSystem> system =
        info.needs.has(Capability::second_order)
            ? linear_oscillator(r * r, degrees > 89.9 ? 0.0 : -real)
            : std::make_shared<FunctorSystem<LinearFlow>>(2, LinearFlow{real, imaginary, -imaginary, real});
    if (!why_not_applicable(info, *system).empty()) return;
    ran = true;
    if (info.carries_more_than_state || info.is_multistep) {
      Eigen::Vector2d y{1.0, info.needs.has(Capability::second_order) ? 0.5 * r : 0.0};
      const Status status = steps_of(scheme.integrator, system, 400, y);
      const double size = info.needs.has(Capability::second_order) ? std::hypot(y[0], y[1] / r) : y.norm();
      bounded = bounded && status.ok() && size <= 10.0;
      if (r > 1e5) decay = std::max(decay, size);
      return;
    }
    Status status;
    const Eigen::Matrix2d m = step_matrix(scheme.integrator, system, status);
    const double radius = Eigen::EigenSolver<Eigen::Matrix2d>(m, false).eigenvalues().cwiseAbs().maxCoeff();
    bounded =
        bounded && status.ok() && radius <= 1.0 + (info.needs.has(Capability::second_order) ? 1e-6 : 1e-9);
    if (r > 1e5 && degrees < 90.0) decay = std::max(decay, radius);  // e^z itself does not decay on the axis
  };
  for (const double r : {0.1, 0.5, 1.0, 2.0, 4.0, 10.0, 100.0, 1e6}) {
    for (const double degrees : {0.0, 30.0, 60.0, 80.0, 89.5, 90.0}) apply(r, degrees);
  }
  if (!ran) {
    check.verdict = Verdict::not_applicable;
    check.reason = "the scheme does not run on the linear test equations";
    checks.push_back(check);
    return;
  }
  const bool vanishes = decay <= 1e-2;
  check.measured =
      bounded ? (vanishes ? fmt::format("bounded, |R| = {:.1e} far out", decay) : "bounded") : "grows";
  check.verdict =
      bounded && (!info.is_l_stable || vanishes) && check.derived != "no" ? Verdict::holds : Verdict::fails;
  checks.push_back(check);
}

}  // namespace fw::analysis
