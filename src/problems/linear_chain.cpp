#include "problems/linear_chain.hpp"

#include <boost/math/constants/constants.hpp>
#include <cmath>
#include <numbers>

#include "ode/functor_system.hpp"
#include "problems/parameter.hpp"

namespace fw::problems {
namespace {

struct ChainForce {
  Parameter stiffness;
  template <class S>
  void operator()(const S&, std::span<const S> q, std::span<const S>, std::span<S> f) const {
    const std::size_t n = q.size();
    for (std::size_t i = 0; i < n; ++i) {
      const S left = i > 0 ? q[i - 1] : S(0);
      const S right = i + 1 < n ? q[i + 1] : S(0);
      f[i] = stiffness.as<S>() * ((left - q[i]) + (right - q[i]));
    }
  }
};

/// The state (q, v) at time t by superposition of the normal modes φ_j(i) = √(2/(N+1)) sin(ijπ/(N+1)).
std::vector<Float128> modal_sum(const Float128& mass, const Float128& stiffness,
                                const std::vector<Float128>& initial, const Float128& t) {
  const std::size_t n = initial.size() / 2;
  const Float128 angle = boost::math::constants::pi<Float128>() / Float128(n + 1);
  const Float128 norm = sqrt(Float128(2) / Float128(n + 1));
  std::vector<Float128> state(2 * n, 0);
  for (std::size_t j = 1; j <= n; ++j) {
    const Float128 omega = 2 * sqrt(stiffness / mass) * sin(Float128(j) * angle / 2);
    std::vector<Float128> mode(n);
    Float128 q_mode = 0, v_mode = 0;
    for (std::size_t i = 0; i < n; ++i) {
      // The phase is reduced to [0, 2(N+1)) in integers, which keeps the sine's argument exact.
      mode[i] = norm * sin(Float128(((i + 1) * j) % (2 * (n + 1))) * angle);
      q_mode += mode[i] * initial[i];
      v_mode += mode[i] * initial[n + i];
    }
    const Float128 cosine = cos(omega * t), sine = sin(omega * t);
    for (std::size_t i = 0; i < n; ++i) {
      state[i] += mode[i] * (q_mode * cosine + v_mode / omega * sine);
      state[n + i] += mode[i] * (v_mode * cosine - q_mode * omega * sine);
    }
  }
  return state;
}

}  // namespace

ProblemEntry linear_chain_entry() {
  return {"linear_chain", {{"count", 8.0}, {"mass", 0.5}, {"stiffness", 20.0}}, linear_chain};
}

Problem linear_chain(const ProblemParameters& given) {
  const ParameterSet parameters(linear_chain_entry(), given);
  const int n = parameters.whole("count", 1, 100000);
  const Parameter mass = parameters.positive("mass"), stiffness = parameters.positive("stiffness");
  Problem problem;
  problem.name = "linear_chain";
  problem.test_equation = TestEquation::spring_chain;
  problem.title = "Chain of masses and linear springs between fixed ends";
  problem.description =
      "m u_i'' = k (u_{i-1} - 2 u_i + u_{i+1}), i = 1..N, u_0 = u_{N+1} = 0; u_1(0) = 1, u_N'(0) = 1/2, rest "
      "0, "
      "on [0, 3.1]. Exact by normal modes with w_j = 2 sqrt(k/m) sin(j pi/(2(N+1))). Stiffness: w_N.";
  problem.source = "Goldstein, Poole, Safko 2002, Classical Mechanics, chapter 6 (normal modes)";
  problem.ivp = {std::make_shared<FunctorSecondOrderSystem<ChainForce>>(
                     Vector::Constant(n, mass.binary()), ForceClass::position, ChainForce{stiffness}),
                 0.0,
                 3.1,
                 {},
                 {}};
  std::vector<Float128> initial(static_cast<std::size_t>(2 * n), 0);
  initial.front() = 1;
  initial.back() = Float128(1) / 2;
  set_initial_state(problem.ivp, initial);
  problem.exact = [m = Float128(mass.binary()), k = stiffness.decimal(), initial](const Float128& t) {
    return modal_sum(m, k, initial, t);
  };
  problem.invariants = {
      {"energy", "J", [n, m = mass.binary(), k = stiffness.binary()](double, ConstVectorRef y) {
         double springs = y[0] * y[0] + y[n - 1] * y[n - 1];
         for (Index i = 1; i < n; ++i) springs += (y[i] - y[i - 1]) * (y[i] - y[i - 1]);
         return 0.5 * (m * y.tail(n).squaredNorm() + k * springs);
       }}};
  problem.stiffness = [radius = 2.0 * std::sqrt(stiffness.binary() / mass.binary()) *
                                std::sin(n * std::numbers::pi / (2.0 * (n + 1)))] { return radius; };
  problem.parameters = parameters.text();
  return problem;
}

}  // namespace fw::problems
