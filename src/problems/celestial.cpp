#include "problems/celestial.hpp"

#include <cmath>

#include "ode/functor_system.hpp"
#include "problems/parameter.hpp"
#include "problems/spectral_radius.hpp"

namespace fw::problems {
namespace {

struct KeplerForce {
  template <class S>
  void operator()(const S&, std::span<const S> q, std::span<const S>, std::span<S> f) const {
    using std::sqrt;
    const S squared = q[0] * q[0] + q[1] * q[1];
    const S cubed = squared * sqrt(squared);
    f[0] = -q[0] / cubed;
    f[1] = -q[1] / cubed;
  }
};

/// (q, v) on the ellipse at time t after the perihelion, from E − e sin E = t by Newton's iteration.
std::vector<Float128> kepler_ellipse(const Float128& e, const Float128& t) {
  // Starting from the side of π where E − e sin E is convex towards the root, Newton converges for every e
  // < 1.
  Float128 E = t + (sin(t) < 0 ? Float128(-e) : e);
  for (int iteration = 0; iteration < 200; ++iteration) {
    const Float128 correction = (E - e * sin(E) - t) / (1 - e * cos(E));
    E -= correction;
    if (abs(correction) <= 1e-33 * (1 + abs(E))) break;
  }
  const Float128 minor = sqrt((1 - e) * (1 + e));
  const Float128 rate = 1 / (1 - e * cos(E));
  return {cos(E) - e, minor * sin(E), -sin(E) * rate, minor * cos(E) * rate};
}

struct HenonHeilesForce {
  template <class S>
  void operator()(const S&, std::span<const S> q, std::span<const S>, std::span<S> f) const {
    f[0] = -q[0] - S(2) * q[0] * q[1];
    f[1] = -q[1] - q[0] * q[0] + q[1] * q[1];
  }
};

constexpr std::size_t body_count = 7;

/// Force on body i: Σ_j m_i m_j (q_j − q_i)/‖q_j − q_i‖³, m_i = i.
struct PleiadesForce {
  template <class S>
  void operator()(const S&, std::span<const S> q, std::span<const S>, std::span<S> f) const {
    using std::sqrt;
    for (S& component : f) component = S(0);
    for (std::size_t i = 0; i < body_count; ++i) {
      for (std::size_t j = i + 1; j < body_count; ++j) {
        const S dx = q[j] - q[i];
        const S dy = q[body_count + j] - q[body_count + i];
        const S squared = dx * dx + dy * dy;
        const S strength = S(static_cast<double>((i + 1) * (j + 1))) / (squared * sqrt(squared));
        f[i] += strength * dx;
        f[j] -= strength * dx;
        f[body_count + i] += strength * dy;
        f[body_count + j] -= strength * dy;
      }
    }
  }
};

Vector pleiades_masses() {
  Vector mass(2 * body_count);
  for (Index i = 0; i < mass.size(); ++i) mass[i] = static_cast<double>(i % 7 + 1);
  return mass;
}

double pleiades_energy(double, ConstVectorRef y) {
  const Vector mass = pleiades_masses();
  double energy = 0.5 * mass.dot(y.tail(14).cwiseAbs2());
  for (Index i = 0; i < 7; ++i) {
    for (Index j = i + 1; j < 7; ++j) {
      energy -= mass[i] * mass[j] / std::hypot(y[j] - y[i], y[7 + j] - y[7 + i]);
    }
  }
  return energy;
}

}  // namespace

ProblemEntry kepler_entry() {
  return {"kepler", {{"eccentricity", 0.6}}, kepler};
}

Problem kepler(const ProblemParameters& given) {
  const ParameterSet parameters(kepler_entry(), given);
  const Parameter eccentricity = parameters.non_negative("eccentricity");
  if (eccentricity.binary() >= 1.0) parameters.reject("eccentricity", "a number < 1");
  Problem problem;
  problem.name = "kepler";
  problem.title = "Kepler's problem";
  problem.description =
      "q'' = -q/|q|^3 in the plane, q(0) = (1 - e, 0), q'(0) = (0, sqrt((1+e)/(1-e))) on [0, 7.7]; period 2 "
      "pi. "
      "Exact by Kepler's equation E - e sin E = t. Stiffness: measured along the solution, sqrt(2/(1-e)^3) "
      "at "
      "the perihelion.";
  problem.source = "Hairer, Lubich, Wanner 2006, I.2";
  problem.ivp = {std::make_shared<FunctorSecondOrderSystem<KeplerForce>>(Vector::Ones(2),
                                                                         ForceClass::position, KeplerForce{}),
                 0.0,
                 7.7,
                 {},
                 {}};
  const Float128 e = eccentricity.decimal();
  set_initial_state(problem.ivp, {1 - e, 0, 0, sqrt((1 + e) / (1 - e))});
  problem.exact = [e](const Float128& t) { return kepler_ellipse(e, t); };
  problem.invariants = {
      {"energy", "1",
       [](double, ConstVectorRef y) { return 0.5 * y.tail(2).squaredNorm() - 1.0 / y.head(2).norm(); }},
      {"angular_momentum", "1", [](double, ConstVectorRef y) { return y[0] * y[3] - y[1] * y[2]; }},
      {"laplace_vector_x", "1",
       [](double, ConstVectorRef y) { return (y[0] * y[3] - y[1] * y[2]) * y[3] - y[0] / y.head(2).norm(); }},
      {"laplace_vector_y", "1", [](double, ConstVectorRef y) {
         return -(y[0] * y[3] - y[1] * y[2]) * y[2] - y[1] / y.head(2).norm();
       }}};
  if (eccentricity.binary() == 0.6) {
    problem.known_values = {{100.0, 0, "-0.1041832044341806047338596629"},
                            {100.0, 1, "-0.6947417155679505993188593704"}};
  }
  problem.stiffness = [ivp = problem.ivp] { return spectral_radius_along_solution(ivp); };
  problem.parameters = parameters.text();
  return problem;
}

ProblemEntry henon_heiles_entry() {
  return {"henon_heiles", {}, henon_heiles};
}

Problem henon_heiles(const ProblemParameters& given) {
  const ParameterSet parameters(henon_heiles_entry(), given);
  Problem problem;
  problem.name = "henon_heiles";
  problem.title = "Henon-Heiles system";
  problem.description =
      "q1'' = -q1 - 2 q1 q2, q2'' = -q2 - q1^2 + q2^2, q(0) = (1/10, 0), q'(0) = (0, 1/2), H = 0.13 on [0, "
      "10.3]. "
      "Stiffness: measured along the solution.";
  problem.source = "Henon, Heiles 1964, Astron. J. 69; Hairer, Lubich, Wanner 2006, I.3";
  problem.ivp = {std::make_shared<FunctorSecondOrderSystem<HenonHeilesForce>>(
                     Vector::Ones(2), ForceClass::position, HenonHeilesForce{}),
                 0.0,
                 10.3,
                 {},
                 {}};
  set_initial_state(problem.ivp, {Float128(1) / 10, 0, 0, Float128(1) / 2});
  problem.invariants = {{"energy", "1", [](double, ConstVectorRef y) {
                           return 0.5 * y.squaredNorm() + y[0] * y[0] * y[1] - y[1] * y[1] * y[1] / 3.0;
                         }}};
  problem.known_values = {{100.0, 0, "-0.040194237876068816794"},
                          {100.0, 1, "0.67901692177202164213"},
                          {100.0, 2, "0.038450928951859834502"},
                          {100.0, 3, "0.048594831553003642243"}};
  problem.stiffness = [ivp = problem.ivp] { return spectral_radius_along_solution(ivp); };
  problem.parameters = parameters.text();
  return problem;
}

ProblemEntry pleiades_entry() {
  return {"pleiades", {}, pleiades};
}

Problem pleiades(const ProblemParameters& given) {
  const ParameterSet parameters(pleiades_entry(), given);
  Problem problem;
  problem.name = "pleiades";
  problem.title = "Pleiades: seven bodies in the plane";
  problem.description =
      "q_i'' = sum_{j != i} m_j (q_j - q_i)/|q_j - q_i|^3, m_i = i, i = 1..7; state (x1..x7, y1..y7, their "
      "velocities) on [0, 3]; several close encounters. Stiffness: measured along the solution.";
  problem.source = "Hairer, Norsett, Wanner 1993, II.10; Mazzia, Magherini 2008, Test Set for IVP Solvers";
  problem.ivp = {std::make_shared<FunctorSecondOrderSystem<PleiadesForce>>(
                     pleiades_masses(), ForceClass::position, PleiadesForce{}),
                 0.0,
                 3.0,
                 {},
                 {}};
  set_initial_state(problem.ivp, {3, 3, -1, -3, 2, -2,   2,    3, -3, 2, 0,     0, -4, 4,
                                  0, 0, 0,  0,  0, 1.75, -1.5, 0, 0,  0, -1.25, 1, 0,  0});
  problem.invariants = {
      {"energy", "1", pleiades_energy},
      {"momentum_x", "1",
       [](double, ConstVectorRef y) { return pleiades_masses().head(7).dot(y.segment(14, 7)); }},
      {"momentum_y", "1",
       [](double, ConstVectorRef y) { return pleiades_masses().head(7).dot(y.segment(21, 7)); }},
      {"angular_momentum", "1", [](double, ConstVectorRef y) {
         return (pleiades_masses().head(7).array() *
                 (y.head(7).array() * y.tail(7).array() - y.segment(7, 7).array() * y.segment(14, 7).array()))
             .sum();
       }}};
  // The published last digit of x3 (…324), y3 (…6543) and y6 (…5824) is left out: two unrelated methods in
  // binary128 agree on -3.2225590324183233, 5.2250818434565442 and -0.24296823449358234.
  const char* digits[] = {"0.37061391439705129", "3.237284092057233",  "-3.22255903241832",
                          "0.6597091455775308",  "0.342558170715658",  "1.562172101400631",
                          "-0.7003092922212495", "-3.943437585517392", "-3.271380973972550",
                          "5.22508184345654",    "-2.590612434977470", "1.198213693392275",
                          "-0.242968234493582",  "1.091449240428980"};
  for (Index i = 0; i < 14; ++i) problem.known_values.push_back({3.0, i, digits[i]});
  problem.stiffness = [ivp = problem.ivp] { return spectral_radius_along_solution(ivp); };
  problem.parameters = parameters.text();
  return problem;
}

}  // namespace fw::problems
