#include "problems/spring_pendulum.hpp"

#include "core/vec3.hpp"
#include "ode/functor_system.hpp"
#include "problems/parameter.hpp"
#include "problems/spectral_radius.hpp"

namespace fw::problems {
namespace {

struct SpringPendulum {
  double mass;
  Parameter stiffness, rest_length, gravity;
  template <class S>
  void operator()(const S&, std::span<const S> q, std::span<const S>, std::span<S> f) const {
    const Vec3<S> position = load3(q.data(), 0);
    const S tension_per_length = stiffness.as<S>() * (S(1) - rest_length.as<S>() / norm(position));
    store3(f.data(), 0, -tension_per_length * position);
    f[2] -= S(mass) * gravity.as<S>();
  }
};

}  // namespace

ProblemEntry spring_pendulum_entry() {
  return {"spring_pendulum",
          {{"mass", 0.5}, {"stiffness", 1e3}, {"rest_length", 1.0}, {"gravity", 9.81}},
          spring_pendulum};
}

Problem spring_pendulum(const ProblemParameters& given) {
  const ParameterSet parameters(spring_pendulum_entry(), given);
  const double m = parameters.positive("mass").binary();
  const Parameter stiffness = parameters.positive("stiffness");
  const Parameter rest_length = parameters.positive("rest_length");
  const Parameter gravity = parameters["gravity"];
  Problem problem;
  problem.name = "spring_pendulum";
  problem.title = "Spherical pendulum on a stiff spring";
  problem.description =
      "m q'' = -k (|q| - l) q/|q| - m g e_z, q(0) = l (4/5, 0, -3/5), q'(0) = (0, 1/2, 0) on [0, 2.3]. "
      "Stiffness: measured along the solution, about sqrt(k/m).";
  problem.source = "Hairer, Lubich, Wanner 2006, XIII.1 (stiff spring pendulum); Zachmann 2011, S6";
  problem.ivp = {
      std::make_shared<FunctorSecondOrderSystem<SpringPendulum>>(
          Vector::Constant(3, m), ForceClass::position, SpringPendulum{m, stiffness, rest_length, gravity}),
      0.0,
      2.3,
      {},
      {}};
  const Float128 length = rest_length.decimal();
  set_initial_state(problem.ivp, {4 * length / 5, 0, -3 * length / 5, 0, Float128(1) / 2, 0});
  problem.invariants = {
      {"energy", "J",
       [m, k = stiffness.binary(), l = rest_length.binary(), g = gravity.binary()](double, ConstVectorRef y) {
         const double extension = y.head(3).norm() - l;
         return 0.5 * m * y.tail(3).squaredNorm() + 0.5 * k * extension * extension + m * g * y[2];
       }},
      {"angular_momentum_z", "kg*m^2/s",
       [m](double, ConstVectorRef y) { return m * (y[0] * y[4] - y[1] * y[3]); }}};
  problem.stiffness = [ivp = problem.ivp] { return spectral_radius_along_solution(ivp); };
  problem.parameters = parameters.text();
  return problem;
}

}  // namespace fw::problems
