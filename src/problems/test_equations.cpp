#include "problems/test_equations.hpp"

#include <cmath>

#include "ode/functor_system.hpp"
#include "problems/parameter.hpp"

namespace fw::problems {
namespace {

struct ScalarLinear {
  Parameter lambda;
  template <class S>
  void operator()(const S&, std::span<const S> y, std::span<S> dydt) const {
    dydt[0] = lambda.as<S>() * y[0];
  }
};

struct PlanarLinear {
  Parameter real, imaginary;
  template <class S>
  void operator()(const S&, std::span<const S> y, std::span<S> dydt) const {
    dydt[0] = real.as<S>() * y[0] - imaginary.as<S>() * y[1];
    dydt[1] = imaginary.as<S>() * y[0] + real.as<S>() * y[1];
  }
};

struct MovingCentre {
  Parameter radius, frequency;
  template <class S>
  void operator()(const S& t, std::span<const S> y, std::span<S> dydt) const {
    using std::cos;
    using std::sin;
    const S angle = frequency.as<S>() * t;
    dydt[0] = radius.as<S>() * sin(angle) - y[1];
    dydt[1] = y[0] - radius.as<S>() * cos(angle);
  }
};

struct ProtheroRobinson {
  Parameter lambda;
  template <class S>
  void operator()(const S& t, std::span<const S> y, std::span<S> dydt) const {
    using std::cos;
    using std::sin;
    dydt[0] = lambda.as<S>() * (y[0] - cos(t)) - sin(t);
  }
};

}  // namespace

ProblemEntry dahlquist_entry() {
  return {"dahlquist", {{"lambda", -1.0}}, dahlquist};
}

Problem dahlquist(const ProblemParameters& given) {
  const ParameterSet parameters(dahlquist_entry(), given);
  const Parameter lambda = parameters["lambda"];
  Problem problem;
  problem.name = "dahlquist";
  problem.title = "Dahlquist's test equation";
  problem.description = "y' = lambda y, y(0) = 1 on [0, 2.3]; y(t) = exp(lambda t). Stiffness: |lambda|.";
  problem.source =
      "Dahlquist 1963, A special stability problem for linear multistep methods, BIT 3; "
      "Zachmann 2011, S11-S12 (lambda = -k)";
  problem.ivp = {std::make_shared<FunctorSystem<ScalarLinear>>(1, ScalarLinear{lambda}), 0.0, 2.3, {}, {}};
  set_initial_state(problem.ivp, {1});
  problem.exact = [lambda](const Float128& t) { return std::vector<Float128>{exp(lambda.decimal() * t)}; };
  problem.stiffness = [radius = std::abs(lambda.binary())] { return radius; };
  problem.parameters = parameters.text();
  return problem;
}

ProblemEntry dahlquist_complex_entry() {
  return {"dahlquist_complex", {{"real", -0.2}, {"imaginary", 3.0}}, dahlquist_complex};
}

Problem dahlquist_complex(const ProblemParameters& given) {
  const ParameterSet parameters(dahlquist_complex_entry(), given);
  const Parameter real = parameters["real"], imaginary = parameters["imaginary"];
  Problem problem;
  problem.name = "dahlquist_complex";
  problem.title = "Dahlquist's test equation with complex lambda";
  problem.description =
      "y1' = a y1 - w y2, y2' = w y1 + a y2, that is z' = (a + i w) z for z = y1 + i y2, z(0) = 1 on [0, "
      "2.3]; "
      "z(t) = exp(a t) (cos w t + i sin w t). Stiffness: |a + i w|.";
  problem.source = "Hairer, Wanner 1996, IV.2";
  problem.ivp = {
      std::make_shared<FunctorSystem<PlanarLinear>>(2, PlanarLinear{real, imaginary}), 0.0, 2.3, {}, {}};
  set_initial_state(problem.ivp, {1, 0});
  problem.exact = [real, imaginary](const Float128& t) {
    const Float128 growth = exp(real.decimal() * t), angle = imaginary.decimal() * t;
    return std::vector<Float128>{growth * cos(angle), growth * sin(angle)};
  };
  problem.stiffness = [radius = std::hypot(real.binary(), imaginary.binary())] { return radius; };
  problem.parameters = parameters.text();
  return problem;
}

ProblemEntry rotation_entry() {
  return {"rotation", {}, rotation};
}

Problem rotation(const ProblemParameters& given) {
  const ParameterSet parameters(rotation_entry(), given);
  Problem problem;
  problem.name = "rotation";
  problem.test_equation = TestEquation::single_oscillation;
  problem.title = "Rotation of the lecture (circles)";
  problem.description =
      "x1' = -x2, x2' = x1, x(0) = (1, 0) on [0, 7.3]; x(t) = (cos t, sin t). Stiffness: |+-i| = 1.";
  problem.source = "Zachmann 2011, S13";
  problem.ivp = {
      std::make_shared<FunctorSystem<PlanarLinear>>(2, PlanarLinear{Parameter(0.0), Parameter(1.0)}),
      0.0,
      7.3,
      {},
      {}};
  set_initial_state(problem.ivp, {1, 0});
  problem.exact = [](const Float128& t) { return std::vector<Float128>{cos(t), sin(t)}; };
  problem.invariants = {{"squared_radius", "1", [](double, ConstVectorRef y) { return y.squaredNorm(); }}};
  problem.stiffness = [radius = 1.0] { return radius; };
  problem.parameters = parameters.text();
  return problem;
}

ProblemEntry moving_centre_entry() {
  return {"moving_centre", {{"radius", 0.8}, {"frequency", 0.4}}, moving_centre};
}

Problem moving_centre(const ProblemParameters& given) {
  const ParameterSet parameters(moving_centre_entry(), given);
  const Parameter radius = parameters["radius"], frequency = parameters["frequency"];
  if (frequency.binary() == 1.0) parameters.reject("frequency", "another than 1, which is resonance");
  Problem problem;
  problem.name = "moving_centre";
  problem.title = "Rotation about a moving centre";
  problem.description =
      "x1' = -(x2 - a sin W t), x2' = x1 - a cos W t, x(0) = (1, 0) on [0, 7.3]: circles about a centre that "
      "moves "
      "on a circle itself (non-autonomous). With z = x1 + i x2: z(t) = (1 - p) exp(i t) + p exp(i W t), "
      "p = a/(1 - W). Stiffness: |+-i| = 1.";
  problem.source = "Zachmann 2011, S14 (a vector field that changes with time)";
  problem.ivp = {
      std::make_shared<FunctorSystem<MovingCentre>>(2, MovingCentre{radius, frequency}), 0.0, 7.3, {}, {}};
  set_initial_state(problem.ivp, {1, 0});
  problem.exact = [radius, frequency](const Float128& t) {
    const Float128 W = frequency.decimal(), p = radius.decimal() / (1 - W);
    return std::vector<Float128>{(1 - p) * cos(t) + p * cos(W * t), (1 - p) * sin(t) + p * sin(W * t)};
  };
  problem.stiffness = [radius_of_spectrum = 1.0] { return radius_of_spectrum; };
  problem.parameters = parameters.text();
  return problem;
}

ProblemEntry prothero_robinson_entry() {
  return {"prothero_robinson", {{"lambda", -1e3}}, prothero_robinson};
}

Problem prothero_robinson(const ProblemParameters& given) {
  const ParameterSet parameters(prothero_robinson_entry(), given);
  const Parameter lambda = parameters["lambda"];
  Problem problem;
  problem.name = "prothero_robinson";
  problem.test_equation = TestEquation::prothero_robinson;
  problem.title = "Prothero-Robinson equation";
  problem.description =
      "y' = lambda (y - cos t) - sin t, y(0) = 1 on [0, 1.3]; y(t) = cos t for every lambda "
      "(non-autonomous). "
      "Stiffness: |lambda|.";
  problem.source = "Prothero, Robinson 1974, Math. Comp. 28; Hairer, Wanner 1996, IV.15";
  problem.ivp = {
      std::make_shared<FunctorSystem<ProtheroRobinson>>(1, ProtheroRobinson{lambda}), 0.0, 1.3, {}, {}};
  set_initial_state(problem.ivp, {1});
  problem.exact = [](const Float128& t) { return std::vector<Float128>{cos(t)}; };
  problem.stiffness = [radius = std::abs(lambda.binary())] { return radius; };
  problem.parameters = parameters.text();
  return problem;
}

}  // namespace fw::problems
