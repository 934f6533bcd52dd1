#include "integrators/tableau/splitting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "integrators/implicit/implicit_kick.hpp"
#include "integrators/loop/stepper.hpp"
#include "schemes/derived_properties.hpp"
#include "schemes/order_conditions.hpp"

namespace fw::integrators {

namespace {

/// The coefficients in the arithmetic S, with the kicks of weight 0 left out.
template <class S>
struct SplittingValues {
  struct Kick {
    S drift;     ///< a: how far positions move before the kick
    S time;      ///< of the kick, in steps
    S weight;    ///< b
    S implicit;  ///< α
  };
  std::vector<Kick> kicks{};
  S last_drift = 0;
  /// It begins and ends with a kick, so that both meet at the same state.
  bool first_same_as_last = false;
};

template <class S>
SplittingValues<S> splitting_values(const schemes::SplittingScheme& scheme) {
  const std::vector<Float128> alpha = schemes::implicit_parts(scheme);
  // What is left of a sum that is zero, or that is a coefficient, in binary128.
  const Float128 rounding = 1e-30;
  SplittingValues<S> result;
  Float128 drift = 0, time = 0;
  for (std::size_t i = 0; i < alpha.size(); ++i) {
    drift += scheme.drift[i].value();
    time += scheme.drift[i].value();
    const Float128 weight = scheme.kick[i].value();
    if (weight == 0) continue;
    const Float128 implicit = abs(alpha[i]) < rounding ? Float128(0) : alpha[i];
    result.kicks.push_back(
        {static_cast<S>(drift), static_cast<S>(time), static_cast<S>(weight), static_cast<S>(implicit)});
    drift = 0;
  }
  const Float128 last = drift + scheme.drift.back().value();
  result.last_drift = static_cast<S>(last);
  result.first_same_as_last = last == 0 && scheme.drift.front().value() == 0 && result.kicks.size() > 1;
  return result;
}

class SplittingStepper final : public Stepper {
 public:
  SplittingStepper(const SplittingValues<double>& scheme, const Ivp& ivp, Work& work)
      : scheme_(scheme),
        system_(*ivp.system->second_order()),
        work_(work),
        kick_(system_, work),
        inverse_mass_(system_.mass().cwiseInverse()),
        force_(Vector::Zero(system_.degrees_of_freedom())),
        start_velocity_(system_.force_class() == ForceClass::velocity ? system_.degrees_of_freedom() : 0) {}

  Status step(double t, double h, VectorRef y) override {
    const Index n = force_.size();
    auto x = y.head(n);
    auto v = y.tail(n);
    for (const auto& kick : scheme_.kicks) {
      if (kick.drift != 0.0) {
        x += (kick.drift * h) * v;
        has_force_ = false;
      }
      const Status status = apply(kick, t, h, x, v);
      if (!status.ok()) return status;
    }
    if (scheme_.last_drift != 0.0) x += (scheme_.last_drift * h) * v;
    has_force_ = scheme_.first_same_as_last;
    return {};
  }

  void restart(double, ConstVectorRef) override { has_force_ = predicts_ = false; }
  void serialise(StateArchive& archive) override {
    archive.visit("force", force_);
    archive.visit("force is known", has_force_);
    archive.visit("force predicts", predicts_);
  }

 private:
  Status apply(const SplittingValues<double>::Kick& kick, double t, double h, VectorRef x, VectorRef v) {
    const double time = t + kick.time * h;
    if (start_velocity_.size() > 0 && kick.implicit != 0.0) {
      start_velocity_ = v;
      // Predicted by the force of the kick before: the iteration then starts with an error of O(h²).
      if (predicts_) v += (kick.implicit * h) * inverse_mass_.cwiseProduct(force_);
      const Status status = kick_.solve(time, kick.implicit * h, x, start_velocity_, v, force_);
      if (!status.ok()) return status;
      predicts_ = true;
      // For a kick with α = b, v is its result to the last bit of the iteration.
      if (kick.weight != kick.implicit)
        v = start_velocity_ + (kick.weight * h) * inverse_mass_.cwiseProduct(force_);
      return {};
    }
    if (!has_force_) {
      system_.force(time, x, v, force_);
      ++work_.rhs_evaluations;
      predicts_ = true;
    }
    has_force_ = false;
    v += (kick.weight * h) * inverse_mass_.cwiseProduct(force_);
    return {};
  }

  SplittingValues<double> scheme_;
  const SecondOrderSystem& system_;
  Work& work_;
  ImplicitKick kick_;
  Vector inverse_mass_, force_;
  Vector start_velocity_;   ///< before an implicit kick; empty where forces depend on position only
  bool has_force_ = false;  ///< force_ is the force at the present state
  bool predicts_ = false;   ///< force_ is a force of some kick before
};

constexpr double binary128_rounding = 1e-33;

/// Solves a = g(t, x, v + c a) for the acceleration `a` (which holds a guess) by fixed-point iteration down
/// to rounding. Steps of a convergence study are small, so that it contracts.
class ExtendedKick {
 public:
  ExtendedKick(const OdeSystem& system, std::size_t size) : system_(system), state_(size), slope_(size) {}

  void solve(const Float128& t, const Float128& c, const std::vector<Float128>& y, std::vector<Float128>& a) {
    const std::size_t n = a.size();
    const bool is_implicit = c != 0 && system_.second_order()->force_class() == ForceClass::velocity;
    Float128 previous = 0;
    constexpr int most_iterations = 500;
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
      state_ = y;
      if (is_implicit) {
        for (std::size_t k = 0; k < n; ++k) state_[n + k] += c * a[k];
      }
      system_.rhs(t, state_, slope_);
      Float128 change = 0, size = 0;
      for (std::size_t k = 0; k < n; ++k) {
        const Float128 difference = abs(Float128(slope_[n + k] - a[k]));
        const Float128 magnitude = abs(slope_[n + k]);
        if (difference > change) change = difference;
        if (magnitude > size) size = magnitude;
        a[k] = slope_[n + k];
      }
      const bool stagnates = iteration > 0 && change >= previous && change <= 1e-28 * size;
      if (!is_implicit || change <= binary128_rounding * size || stagnates) return;
      previous = change;
    }
  }

 private:
  const OdeSystem& system_;
  std::vector<Float128> state_, slope_;
};

std::vector<Float128> solve_extended(const SplittingValues<Float128>& scheme, const Ivp& ivp,
                                     std::uint64_t steps) {
  std::vector<Float128> y = initial_state_extended(ivp);
  const std::size_t n = y.size() / 2;
  std::vector<Float128> acceleration(n, Float128(0));
  ExtendedKick kicks(*ivp.system, y.size());
  const Float128 h = (Float128(ivp.t1) - Float128(ivp.t0)) / steps;
  const auto drift = [&](const Float128& part) {
    if (part == 0) return;
    for (std::size_t k = 0; k < n; ++k) y[k] += part * h * y[n + k];
  };
  for (std::uint64_t step = 0; step < steps; ++step) {
    const Float128 t = Float128(ivp.t0) + step * h;
    for (const auto& kick : scheme.kicks) {
      drift(kick.drift);
      kicks.solve(t + kick.time * h, kick.implicit * h, y, acceleration);
      for (std::size_t k = 0; k < n; ++k) y[n + k] += kick.weight * h * acceleration[k];
    }
    drift(scheme.last_drift);
  }
  return y;
}

/// One step in formula: its coefficients where these are few and short, else its pattern.
std::string formula(const schemes::SplittingScheme& scheme) {
  std::string text;
  constexpr std::size_t most_kicks = 3, longest = 7;
  const auto is_long = [](const schemes::Coefficient& c) { return c.text().size() > longest; };
  if (scheme.kick.size() > most_kicks || std::any_of(scheme.drift.begin(), scheme.drift.end(), is_long) ||
      std::any_of(scheme.kick.begin(), scheme.kick.end(), is_long)) {
    return "x += a_i h v, v += b_i h M^-1 f(t_i, x, v + alpha_i h M^-1 f) for i = 1...s, x += a_{s+1} h v";
  }
  const auto add = [&](const std::string& move) { text += (text.empty() ? "" : ";  ") + move; };
  for (std::size_t i = 0; i < scheme.drift.size(); ++i) {
    const std::string& a = scheme.drift[i].text();
    if (scheme.drift[i].value() != 0) add(a == "1" ? "x += h v" : fmt::format("x += ({}) h v", a));
    if (i == scheme.kick.size()) break;
    const std::string& b = scheme.kick[i].text();
    if (scheme.kick[i].value() != 0) add(b == "1" ? "v += h M^-1 f" : fmt::format("v += ({}) h M^-1 f", b));
  }
  return text;
}

}  // namespace

std::unique_ptr<Integrator> make_splitting(const schemes::SplittingScheme& scheme) {
  const SplittingValues<double> rounded = splitting_values<double>(scheme);
  const SplittingValues<Float128> exact = splitting_values<Float128>(scheme);
  MethodInfo info{.name = scheme.name,
                  .title = scheme.title,
                  .family = "symplectic",
                  .order = schemes::order_of_accuracy(scheme, false),
                  .order_with_velocity_forces = schemes::order_of_accuracy(scheme, true),
                  .stages = static_cast<int>(exact.kicks.size()) - (exact.first_same_as_last ? 1 : 0),
                  .is_symplectic = schemes::is_symplectic(schemes::as_nystrom(scheme)),
                  .is_symmetric = schemes::is_symmetric(schemes::as_nystrom(scheme)),
                  .needs = {Capability::second_order},
                  .formula = formula(scheme),
                  .reference = scheme.reference};
  return std::make_unique<FixedStepIntegrator>(
      std::move(info),
      [rounded](const Ivp& ivp, double, Work& work) -> std::unique_ptr<Stepper> {
        return std::make_unique<SplittingStepper>(rounded, ivp, work);
      },
      [exact](const Ivp& ivp, std::uint64_t steps) { return solve_extended(exact, ivp, steps); });
}

}  // namespace fw::integrators
