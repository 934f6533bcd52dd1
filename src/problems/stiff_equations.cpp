#include "problems/stiff_equations.hpp"

#include "ode/functor_system.hpp"
#include "problems/parameter.hpp"
#include "problems/spectral_radius.hpp"

namespace fw::problems {
namespace {

struct VanDerPol {
  Parameter epsilon;
  template <class S>
  void operator()(const S&, std::span<const S> y, std::span<S> dydt) const {
    dydt[0] = y[1];
    dydt[1] = ((S(1) - y[0] * y[0]) * y[1] - y[0]) / epsilon.as<S>();
  }
};

struct Robertson {
  template <class S>
  void operator()(const S&, std::span<const S> y, std::span<S> dydt) const {
    const S slow = S(4) / S(100) * y[0];
    const S back = S(1e4) * y[1] * y[2];
    const S fast = S(3e7) * y[1] * y[1];
    dydt[0] = back - slow;
    dydt[1] = slow - back - fast;
    dydt[2] = fast;
  }
};

}  // namespace

ProblemEntry van_der_pol_entry() {
  return {"van_der_pol", {{"epsilon", 1e-3}}, van_der_pol};
}

Problem van_der_pol(const ProblemParameters& given) {
  const ParameterSet parameters(van_der_pol_entry(), given);
  const Parameter epsilon = parameters.positive("epsilon");
  Problem problem;
  problem.name = "van_der_pol";
  problem.title = "Van der Pol's equation, stiff scaling";
  problem.description =
      "y1' = y2, y2' = ((1 - y1^2) y2 - y1)/eps, y(0) = (2, 0) on [0, 2], which holds an initial layer, two "
      "slow "
      "arcs and one fast transition for small eps; mu = 1/sqrt(eps) in the classical form. Stiffness: "
      "measured "
      "along the solution, about 3/eps on the slow arcs.";
  problem.source = "Hairer, Wanner 1996, IV.1 and VI.1 (with eps = 1e-6)";
  problem.ivp = {std::make_shared<FunctorSystem<VanDerPol>>(2, VanDerPol{epsilon}), 0.0, 2.0, {}, {}};
  set_initial_state(problem.ivp, {2, 0});
  problem.stiffness = [ivp = problem.ivp] { return spectral_radius_along_solution(ivp); };
  problem.parameters = parameters.text();
  return problem;
}

ProblemEntry robertson_entry() {
  return {"robertson", {}, robertson};
}

Problem robertson(const ProblemParameters& given) {
  const ParameterSet parameters(robertson_entry(), given);
  Problem problem;
  problem.name = "robertson";
  problem.title = "Robertson's chemical kinetics";
  problem.description =
      "y1' = -0.04 y1 + 1e4 y2 y3, y3' = 3e7 y2^2, y2' = -y1' - y3', y(0) = (1, 0, 0) on [0, 40]. "
      "Stiffness: measured along the solution.";
  problem.source = "Robertson 1966; Hairer, Wanner 1996, IV.1; digits: SUNDIALS example cvRoberts_dns";
  problem.ivp = {std::make_shared<FunctorSystem<Robertson>>(3, Robertson{}), 0.0, 40.0, {}, {}};
  set_initial_state(problem.ivp, {1, 0, 0});
  problem.invariants = {{"total_concentration", "1", [](double, ConstVectorRef y) { return y.sum(); }}};
  // The example prints 9.185e-06 for y2 at its tolerance of 1e-4; the value is 9.18553e-06.
  problem.known_values = {{40.0, 0, "0.7158"}, {40.0, 1, "0.0000092"}, {40.0, 2, "0.2842"}};
  problem.stiffness = [ivp = problem.ivp] { return spectral_radius_along_solution(ivp); };
  problem.parameters = parameters.text();
  return problem;
}

}  // namespace fw::problems
