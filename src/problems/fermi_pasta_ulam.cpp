#include "problems/fermi_pasta_ulam.hpp"

#include "ode/functor_system.hpp"
#include "problems/parameter.hpp"
#include "problems/spectral_radius.hpp"

namespace fw::problems {
namespace {

/// Force −∂U/∂q of U = ω²/4 Σ (q_{2i} − q_{2i−1})² + Σ (q_{2i+1} − q_{2i})⁴ with q_0 = q_{2m+1} = 0.
struct FermiPastaUlamForce {
  Parameter frequency;
  template <class S>
  void operator()(const S&, std::span<const S> q, std::span<const S>, std::span<S> f) const {
    const std::size_t n = q.size();
    const S half_squared = frequency.as<S>() * frequency.as<S>() / S(2);
    for (S& component : f) component = S(0);
    for (std::size_t i = 0; i <= n; ++i) {  // spring i joins masses i − 1 and i, counted from zero
      const S expansion = (i < n ? q[i] : S(0)) - (i > 0 ? q[i - 1] : S(0));
      const S tension = i % 2 == 1 ? half_squared * expansion : S(4) * expansion * expansion * expansion;
      if (i > 0) f[i - 1] += tension;
      if (i < n) f[i] -= tension;
    }
  }
};

}  // namespace

ProblemEntry fermi_pasta_ulam_entry() {
  return {"fermi_pasta_ulam", {{"stiff_springs", 3.0}, {"frequency", 50.0}}, fermi_pasta_ulam};
}

Problem fermi_pasta_ulam(const ProblemParameters& given) {
  const ParameterSet parameters(fermi_pasta_ulam_entry(), given);
  const int m = parameters.whole("stiff_springs", 1, 100);
  const Index n = 2 * m;
  const Parameter frequency = parameters.positive("frequency");
  Problem problem;
  problem.name = "fermi_pasta_ulam";
  problem.title = "Stiff Fermi-Pasta-Ulam chain";
  problem.description =
      "2m unit masses, H = sum p^2/2 + w^2/4 sum (q_{2i} - q_{2i-1})^2 + sum (q_{2i+1} - q_{2i})^4, q_0 = "
      "q_{2m+1} = 0; "
      "(q1 + q2)/sqrt 2 = 1, (q2 - q1)/sqrt 2 = 1/w, (p1 + p2)/sqrt 2 = (p2 - p1)/sqrt 2 = 1, rest 0, on [0, "
      "1.7]. "
      "The energies of the stiff springs are exchanged on the time scale w. Stiffness: measured along the "
      "solution, "
      "about w.";
  problem.source = "Hairer, Lubich, Wanner 2006, I.5.1; Galgani, Giorgilli, Martinoli, Vanzini 1992";
  problem.ivp = {std::make_shared<FunctorSecondOrderSystem<FermiPastaUlamForce>>(
                     Vector::Ones(n), ForceClass::position, FermiPastaUlamForce{frequency}),
                 0.0,
                 1.7,
                 {},
                 {}};
  const Float128 root = sqrt(Float128(2));
  std::vector<Float128> initial(static_cast<std::size_t>(2 * n), 0);
  initial[0] = (1 - 1 / frequency.decimal()) / root;
  initial[1] = (1 + 1 / frequency.decimal()) / root;
  initial[static_cast<std::size_t>(n) + 1] = root;
  set_initial_state(problem.ivp, initial);
  problem.invariants = {{"energy", "1", [n, w = frequency.binary()](double, ConstVectorRef y) {
                           double energy = 0.5 * y.tail(n).squaredNorm();
                           for (Index i = 0; i <= n; ++i) {
                             const double expansion = (i < n ? y[i] : 0.0) - (i > 0 ? y[i - 1] : 0.0);
                             const double squared = expansion * expansion;
                             energy += i % 2 == 1 ? 0.25 * w * w * squared : squared * squared;
                           }
                           return energy;
                         }}};
  if (m == 3 && frequency.binary() == 50.0) {
    problem.known_values = {
        {1.0, 0, "0.51767820806882268"},
        // Published is …28140, cut off instead of rounded: the value is 0.5398086086832814054.
        {1.0, 1, "0.5398086086832814"},
        {10.0, 0, "0.75633242161029199"},
        {10.0, 1, "0.71735962155453710"}};
  }
  problem.stiffness = [ivp = problem.ivp] { return spectral_radius_along_solution(ivp); };
  problem.parameters = parameters.text();
  return problem;
}

}  // namespace fw::problems
