#include "problems/oscillators.hpp"

#include <cmath>

#include "dense/eigenvalues.hpp"
#include "ode/functor_system.hpp"
#include "problems/parameter.hpp"
#include "problems/spectral_radius.hpp"

namespace fw::problems {
namespace {

struct LinearSpring {
  Parameter stiffness, damping;
  template <class S>
  void operator()(const S&, std::span<const S> q, std::span<const S> v, std::span<S> f) const {
    f[0] = -stiffness.as<S>() * q[0] - damping.as<S>() * v[0];
  }
};

struct Duffing {
  Parameter damping, stiffness, cubic_stiffness, force_amplitude, force_frequency;
  template <class S>
  void operator()(const S& t, std::span<const S> q, std::span<const S> v, std::span<S> f) const {
    using std::cos;
    f[0] = -damping.as<S>() * v[0] - stiffness.as<S>() * q[0] - cubic_stiffness.as<S>() * q[0] * q[0] * q[0] +
           force_amplitude.as<S>() * cos(force_frequency.as<S>() * t);
  }
};

/// The system takes its mass as a double, so that the closed forms below do, too.
Vector one_mass(const Parameter& mass) {
  return Vector::Constant(1, mass.binary());
}

/// (q, v) of m q̈ = −k q − c q̇ at time t. With γ = c/2m and δ = ω² − γ², q = e^{−γt}(q₀ C + (v₀ + γq₀) S)
/// where (C, S) is (cos ω_d t, sin(ω_d t)/ω_d), (1, t) or (cosh, sinh) for δ > 0, δ = 0 or δ < 0.
std::vector<Float128> damped_motion(const Float128& mass, const Float128& stiffness, const Float128& damping,
                                    const Float128& q0, const Float128& v0, const Float128& t) {
  const Float128 squared_frequency = stiffness / mass;
  const Float128 gamma = damping / (2 * mass);
  const Float128 delta = squared_frequency - gamma * gamma;
  Float128 C = 1, S = t;
  if (delta > 0) {
    const Float128 omega = sqrt(delta);
    C = cos(omega * t);
    S = sin(omega * t) / omega;
  } else if (delta < 0) {
    const Float128 rate = sqrt(-delta);
    C = cosh(rate * t);
    S = sinh(rate * t) / rate;
  }
  const Float128 decay = exp(-gamma * t);
  return {decay * (q0 * C + (v0 + gamma * q0) * S),
          decay * (v0 * C - (gamma * v0 + squared_frequency * q0) * S)};
}

Problem linear_oscillator(const Parameter& mass, const Parameter& stiffness, const Parameter& damping) {
  Problem problem;
  const ForceClass force_class = damping.binary() == 0.0 ? ForceClass::position : ForceClass::velocity;
  problem.ivp = {std::make_shared<FunctorSecondOrderSystem<LinearSpring>>(one_mass(mass), force_class,
                                                                          LinearSpring{stiffness, damping}),
                 0.0,
                 7.3,
                 {},
                 {}};
  set_initial_state(problem.ivp, {1, Float128(1) / 2});
  problem.exact = [mass, stiffness, damping](const Float128& t) {
    return damped_motion(mass.binary(), stiffness.decimal(), damping.decimal(), 1, Float128(1) / 2, t);
  };
  Matrix J(2, 2);
  J << 0.0, 1.0, -stiffness.binary() / mass.binary(), -damping.binary() / mass.binary();
  problem.stiffness = [radius = dense::eigenvalues(J).cwiseAbs().maxCoeff()] { return radius; };
  return problem;
}

}  // namespace

ProblemEntry harmonic_oscillator_entry() {
  return {"harmonic_oscillator", {{"mass", 2.0}, {"stiffness", 7.0}}, harmonic_oscillator};
}

Problem harmonic_oscillator(const ProblemParameters& given) {
  const ParameterSet parameters(harmonic_oscillator_entry(), given);
  const Parameter mass = parameters.positive("mass"), stiffness = parameters.positive("stiffness");
  Problem problem = linear_oscillator(mass, stiffness, Parameter(0.0));
  problem.name = "harmonic_oscillator";
  problem.test_equation = TestEquation::single_oscillation;
  problem.title = "Harmonic oscillator";
  problem.description =
      "m q'' = -k q, q(0) = 1, q'(0) = 1/2 on [0, 7.3]; q(t) = cos wt + sin(wt)/(2w), w = sqrt(k/m). "
      "Stiffness: w.";
  problem.source = "Zachmann 2011, S6-S10; Hairer, Lubich, Wanner 2006, I.1";
  problem.invariants = {
      {"energy", "J", [m = mass.binary(), k = stiffness.binary()](double, ConstVectorRef y) {
         return 0.5 * (m * y[1] * y[1] + k * y[0] * y[0]);
       }}};
  problem.parameters = parameters.text();
  return problem;
}

ProblemEntry damped_oscillator_entry() {
  return {"damped_oscillator", {{"mass", 2.0}, {"stiffness", 7.0}, {"damping", 0.6}}, damped_oscillator};
}

Problem damped_oscillator(const ProblemParameters& given) {
  const ParameterSet parameters(damped_oscillator_entry(), given);
  Problem problem = linear_oscillator(parameters.positive("mass"), parameters.positive("stiffness"),
                                      parameters.non_negative("damping"));
  problem.name = "damped_oscillator";
  problem.title = "Damped oscillator";
  problem.description =
      "m q'' = -k q - c q', q(0) = 1, q'(0) = 1/2 on [0, 7.3]; closed form, under-, critically or "
      "overdamped. "
      "Stiffness: larger |lambda| of m lambda^2 + c lambda + k = 0.";
  problem.source = "Zachmann 2011, S6 (spring and damper)";
  problem.parameters = parameters.text();
  return problem;
}

ProblemEntry driven_duffing_entry() {
  return {"driven_duffing",
          {{"mass", 1.5},
           {"damping", 0.2},
           {"stiffness", 1.0},
           {"cubic_stiffness", 2.0},
           {"force_amplitude", 0.6},
           {"force_frequency", 1.3}},
          driven_duffing};
}

Problem driven_duffing(const ProblemParameters& given) {
  const ParameterSet parameters(driven_duffing_entry(), given);
  const Parameter damping = parameters["damping"];
  Problem problem;
  problem.name = "driven_duffing";
  problem.title = "Driven Duffing oscillator";
  problem.description =
      "m q'' = -c q' - k q - b q^3 + F cos(w t), q(0) = 1/2, q'(0) = -1/4 on [0, 3.7]: nonlinear, "
      "non-autonomous, damped, m != 1. No closed form. Stiffness: measured along the solution.";
  problem.source = "Guckenheimer, Holmes 1983, Nonlinear Oscillations, section 2.2";
  problem.ivp = {std::make_shared<FunctorSecondOrderSystem<Duffing>>(
                     one_mass(parameters.positive("mass")),
                     damping.binary() == 0.0 ? ForceClass::position : ForceClass::velocity,
                     Duffing{damping, parameters["stiffness"], parameters["cubic_stiffness"],
                             parameters["force_amplitude"], parameters["force_frequency"]}),
                 0.0,
                 3.7,
                 {},
                 {}};
  set_initial_state(problem.ivp, {Float128(1) / 2, Float128(-1) / 4});
  problem.stiffness = [ivp = problem.ivp] { return spectral_radius_along_solution(ivp); };
  problem.parameters = parameters.text();
  return problem;
}

}  // namespace fw::problems
