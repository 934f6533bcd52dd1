#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/verification/verification.hpp"
#include "analysis/verification/verification_problems.hpp"
#include "mechanics/mass_spring_system.hpp"

namespace fw::analysis {

namespace {

/// The problem on [t0, t0 + count·h].
Ivp shortened(const Ivp& problem, double step, int count) {
  Ivp ivp = problem;
  ivp.y0_extended.clear();
  ivp.t1 = ivp.t0 + step * count;
  return ivp;
}

Solution run(const Integrator& integrator, const Ivp& ivp, double step) {
  NullObserver observer;
  return integrator.solve(ivp, FixedStep{.step = step, .allow_short_last_step = false}, observer);
}

/// ∂Φ/∂y of `count` steps by central differences, extrapolated from two increments (error O(δ⁴)).
Matrix step_map_derivative(const Integrator& integrator, const Ivp& problem, double step, int count,
                           Status& status) {
  const Ivp base = shortened(problem, step, count);
  const Index n = base.y0.size();
  Matrix derivative(n, n);
  constexpr double increment = 2e-3;
  for (Index j = 0; j < n; ++j) {
    const auto difference = [&](double delta) {
      Ivp plus = base, minus = base;
      plus.y0[j] += delta;
      minus.y0[j] -= delta;
      const Solution a = run(integrator, plus, step), b = run(integrator, minus, step);
      if (!a.status.ok()) status = a.status;
      if (!b.status.ok()) status = b.status;
      return Vector((a.state - b.state) / (2.0 * delta));
    };
    derivative.col(j) = (4.0 * difference(0.5 * increment) - difference(increment)) / 3.0;
  }
  return derivative;
}

/// ‖DᵀSD − S‖∞ relative to ‖S‖∞ with S = ((0, M), (−M, 0)), the symplectic form in (q, v).
double symplectic_defect(const Integrator& integrator, const Ivp& problem, double step, int count,
                         Status& status) {
  const Vector& mass = problem.system->second_order()->mass();
  const Index n = mass.size();
  // Fixed degrees of freedom do not move: the form lives on the others.
  const std::vector<char>& fixed = problem.system->second_order()->fixed();
  Matrix form = Matrix::Zero(2 * n, 2 * n);
  for (Index i = 0; i < n; ++i) {
    if (fixed[static_cast<std::size_t>(i)] != 0) continue;
    form(i, n + i) = mass[i];
    form(n + i, i) = -mass[i];
  }
  Matrix D = step_map_derivative(integrator, problem, step, count, status);
  for (Index i = 0; i < n; ++i) {
    if (fixed[static_cast<std::size_t>(i)] == 0) continue;
    for (const Index k : {i, n + i}) {
      D.row(k).setZero();
      D.col(k).setZero();
    }
  }
  return (D.transpose() * form * D - form).cwiseAbs().maxCoeff() / form.cwiseAbs().maxCoeff();
}

/// The first of these problems that the scheme runs on.
const Ivp* conservative_problem(const MethodInfo& info) {
  for (const Ivp* ivp : {&conservative_oscillators(), &spring_network()}) {
    if (why_not_applicable(info, *ivp->system).empty()) return ivp;
  }
  return nullptr;
}

double energy_of(const Ivp& problem, ConstVectorRef y) {
  if (const auto* springs = dynamic_cast<const mechanics::MassSpringSystem*>(problem.system.get())) {
    const Index n = y.size() / 2;
    return springs->energies(y.head(n), y.tail(n)).total();
  }
  return conservative_energy(y);
}

const char* yes_or_no(bool value) {
  return value ? "yes" : "no";
}

/// Energy at every step: its slope over time by least squares and its spread.
class EnergyObserver final : public Observer {
 public:
  explicit EnergyObserver(const Ivp& problem) : problem_(problem) {}

  bool observe(const StepView& view) override {
    const double energy = energy_of(problem_, view.state);
    if (view.index == 0) start_ = energy;
    const double e = energy - start_, t = view.time - problem_.t0;
    largest_ = std::max(largest_, std::abs(e));
    count_ += 1.0;
    sum_t_ += t;
    sum_e_ += e;
    sum_tt_ += t * t;
    sum_te_ += t * e;
    return true;
  }
  /// Drift over the whole run by the fitted slope.
  double drift() const {
    const double slope = (count_ * sum_te_ - sum_t_ * sum_e_) / (count_ * sum_tt_ - sum_t_ * sum_t_);
    return slope * 2.0 * sum_t_ / count_;
  }
  double largest() const { return largest_; }
  double start() const { return start_; }

 private:
  const Ivp& problem_;
  double start_ = 0.0, largest_ = 0.0, count_ = 0.0, sum_t_ = 0.0, sum_e_ = 0.0, sum_tt_ = 0.0, sum_te_ = 0.0;
};

void check_momentum(const SchemeUnderTest& scheme, std::vector<PropertyCheck>& checks) {
  PropertyCheck check{.property = "linear momentum"};
  const Ivp& problem = free_spring_network();
  if (const std::string why = why_not_applicable(scheme.integrator.info(), *problem.system); !why.empty()) {
    check.reason = why;
    checks.push_back(check);
    return;
  }
  const auto& system = dynamic_cast<const mechanics::MassSpringSystem&>(*problem.system);
  const Index n = problem.y0.size() / 2;
  const Solution solution = run(scheme.integrator, shortened(problem, 0.03125, 64), 0.03125);
  const Vec3<double> start = system.linear_momentum(problem.y0.tail(n));
  const Vec3<double> end = system.linear_momentum(solution.state.tail(n));
  const double change = norm(end - start);
  double scale = 0.0;
  for (Index i = 0; i < n; ++i) scale += system.mass()[i] * std::abs(solution.state[n + i]);
  const double allowed = std::max(2e-13, 10.0 * scheme.integrator.info().iteration_tolerance);
  check.claimed = "conserved";
  check.measured = fmt::format("{:.1e}", change / scale);
  check.verdict = solution.status.ok() && change <= allowed * scale ? Verdict::holds : Verdict::fails;
  if (check.verdict == Verdict::fails) {
    check.reason = solution.status.ok() ? fmt::format("changes by more than {:.0e} in 64 steps", allowed)
                                        : solution.status.describe();
  }
  checks.push_back(check);
}

/// A fixed particle stays where it is to the last bit, whatever acts on it.
void check_fixed_particles(const SchemeUnderTest& scheme, std::vector<PropertyCheck>& checks) {
  PropertyCheck check{.property = "fixed particles"};
  const Ivp* problem = nullptr;
  for (const Ivp* ivp : {&damped_spring_network(), &spring_network()}) {
    if (why_not_applicable(scheme.integrator.info(), *ivp->system).empty()) {
      problem = ivp;
      break;
    }
  }
  if (problem == nullptr) {
    check.reason = "the scheme does not run on spring networks";
    checks.push_back(check);
    return;
  }
  const Solution solution = run(scheme.integrator, shortened(*problem, 0.03125, 32), 0.03125);
  const std::vector<char>& fixed = problem->system->second_order()->fixed();
  const auto n = static_cast<Index>(fixed.size());
  double moved = 0.0;
  for (Index i = 0; i < n; ++i) {
    if (fixed[static_cast<std::size_t>(i)] == 0) continue;
    for (const Index k : {i, n + i}) moved = std::max(moved, std::abs(solution.state[k] - problem->y0[k]));
  }
  check.claimed = "at rest";
  check.measured = fmt::format("moved by {:.1e}", moved);
  check.verdict = solution.status.ok() && moved == 0.0 ? Verdict::holds : Verdict::fails;
  if (!solution.status.ok()) check.reason = solution.status.describe();
  checks.push_back(check);
}

void check_energy(const SchemeUnderTest& scheme, std::vector<PropertyCheck>& checks) {
  const MethodInfo& info = scheme.integrator.info();
  PropertyCheck check{.property = "energy"};
  const Ivp* problem = conservative_problem(info);
  if (problem == nullptr || !(info.is_symplectic || info.conserves_energy)) {
    check.reason = "nothing is claimed";
    checks.push_back(check);
    return;
  }
  const double step = 0.03125;
  const int count = info.conserves_energy ? 400 : 6400;
  EnergyObserver observer(*problem);
  const Ivp ivp = shortened(*problem, step, count);
  const Solution solution =
      scheme.integrator.solve(ivp, FixedStep{.step = step, .allow_short_last_step = false}, observer);
  const double scale = std::abs(observer.start()) + 1.0;
  if (info.conserves_energy) {
    check.claimed = "conserved";
    check.measured = fmt::format("{:.1e}", observer.largest() / scale);
    check.verdict =
        solution.status.ok() && observer.largest() <= std::max(1e-10, 10.0 * info.iteration_tolerance) * scale
            ? Verdict::holds
            : Verdict::fails;
  } else {
    check.claimed = "no drift";
    // Rounding walks at random: 1e-14 of the energy per √step.
    const double rounding = 1e-14 * std::sqrt(static_cast<double>(count)) * scale;
    const double ratio = std::abs(observer.drift()) / (observer.largest() + rounding);
    check.measured =
        fmt::format("drift {:.0f} % of amplitude {:.1e}", 100.0 * ratio, observer.largest() / scale);
    check.verdict = solution.status.ok() && ratio <= 0.25 ? Verdict::holds : Verdict::fails;
  }
  if (check.verdict == Verdict::fails)
    check.reason = fmt::format("over {} steps; {}", count, solution.status.describe());
  checks.push_back(check);
}

}  // namespace

void verify_symplecticity(const SchemeUnderTest& scheme, std::vector<PropertyCheck>& checks) {
  const MethodInfo& info = scheme.integrator.info();
  PropertyCheck check{.property = "symplectic", .claimed = yes_or_no(info.is_symplectic)};
  const Ivp* problem = conservative_problem(info);
  if (problem == nullptr || !info.has_fixed_step) {
    check.reason = "not for conservative second-order systems with constant steps";
    checks.push_back(check);
    return;
  }
  const schemes::DerivedProperties derived = schemes::derive(scheme.data);
  if (derived.symplectic) check.derived = yes_or_no(*derived.symplectic);
  // A method that is not symplectic shows it at large steps, where its error is large.
  constexpr double symplectic_below = 2e-8, not_symplectic_above = 1e-6;
  double largest = 0.0;
  Status status;
  const int count = info.is_multistep ? info.order + 3 : 2;  // past the start, which is another scheme's
  const double coarsest = info.is_explicit ? 0.5 : 1.0;
  for (double step = coarsest; step > 0.2 * coarsest; step *= 0.5) {
    Status step_status;
    const double defect = symplectic_defect(scheme.integrator, *problem, step, count, step_status);
    if (!step_status.ok() || !std::isfinite(defect)) {
      status = step_status;
      continue;
    }
    largest = std::max(largest, defect);
  }
  check.measured = fmt::format("defect {:.1e}", largest);
  const bool measured = largest <= symplectic_below;
  const bool clear = measured || largest >= not_symplectic_above;
  check.verdict = clear && measured == info.is_symplectic ? Verdict::holds : Verdict::fails;
  if (derived.symplectic && *derived.symplectic != info.is_symplectic) check.verdict = Verdict::fails;
  if (check.verdict == Verdict::fails) {
    check.reason = fmt::format("symplectic is below {:.0e}, not symplectic above {:.0e}{}", symplectic_below,
                               not_symplectic_above, status.ok() ? "" : "; " + status.describe());
  }
  checks.push_back(check);
}

void verify_reversibility(const SchemeUnderTest& scheme, std::vector<PropertyCheck>& checks) {
  const MethodInfo& info = scheme.integrator.info();
  PropertyCheck check{.property = "reversible in time", .claimed = yes_or_no(info.is_symmetric)};
  const Ivp* problem = conservative_problem(info);
  if (problem == nullptr || !info.has_fixed_step || (info.is_multistep && !info.is_symmetric)) {
    check.reason = "not for conservative second-order systems, or the start is another scheme's";
    checks.push_back(check);
    return;
  }
  const schemes::DerivedProperties derived = schemes::derive(scheme.data);
  if (derived.symmetric) check.derived = yes_or_no(*derived.symmetric);
  const Index n = problem->y0.size() / 2;
  // The largest step at which the scheme runs both ways: there irreversibility shows most.
  Ivp there;
  Solution forward, backward;
  for (double step = info.is_explicit && info.order < 6 ? 0.25 : 0.5; step > 0.05; step *= 0.5) {
    there = shortened(*problem, step, 8);
    forward = run(scheme.integrator, there, step);
    if (!forward.status.ok()) continue;
    Ivp back = there;
    back.y0 = forward.state;
    back.y0.tail(n) *= -1.0;
    backward = run(scheme.integrator, back, step);
    backward.state.tail(n) *= -1.0;
    if (backward.status.ok()) break;
  }
  const double scale = std::max(1.0, there.y0.cwiseAbs().maxCoeff());
  const double ulps =
      (backward.state - there.y0).cwiseAbs().maxCoeff() / (scale * std::numeric_limits<double>::epsilon());
  // Rounding of 16 steps; iterative solvers stop a few units above it.
  const double reversible_below = info.is_explicit ? 2e3 : 1e5, not_reversible_above = 1e7;
  const bool measured = ulps <= reversible_below;
  check.measured = fmt::format("{:.1e} ULP", ulps);
  const bool ran = forward.status.ok() && backward.status.ok();
  check.verdict = ran && (measured || ulps >= not_reversible_above) && measured == info.is_symmetric
                      ? Verdict::holds
                      : Verdict::fails;
  if (derived.symmetric && *derived.symmetric != info.is_symmetric) check.verdict = Verdict::fails;
  if (check.verdict == Verdict::fails) {
    check.reason = ran ? fmt::format("reversible is below {:.0e} ULP, not reversible above {:.0e}",
                                     reversible_below, not_reversible_above)
                       : (forward.status.ok() ? backward : forward).status.describe();
  }
  checks.push_back(check);
}

void verify_conservation(const SchemeUnderTest& scheme, std::vector<PropertyCheck>& checks) {
  if (!scheme.integrator.info().has_fixed_step) return;
  check_momentum(scheme, checks);
  check_fixed_particles(scheme, checks);
  check_energy(scheme, checks);
}

}  // namespace fw::analysis
