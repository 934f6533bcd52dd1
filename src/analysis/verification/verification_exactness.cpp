#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/verification/verification.hpp"
#include "ode/functor_system.hpp"

namespace fw::analysis {

namespace {

constexpr int largest_degree = 16;

/// ẏ_k = (k + 1) (t − t₀)ᵏ for k = 0 … largest_degree: y_k(t₀ + h) = h^{k+1}.
struct Monomials {
  double t0;
  template <class S>
  void operator()(const S& t, std::span<const S>, std::span<S> dydt) const {
    S power(1);
    for (std::size_t k = 0; k < dydt.size(); ++k) {
      dydt[k] = S(static_cast<double>(k + 1)) * power;
      power *= t - S(t0);
    }
  }
};

/// One step of length 1 from `ivp.t0`.
Solution one_step(const Integrator& integrator, const Ivp& ivp) {
  NullObserver observer;
  return integrator.solve(ivp, FixedStep{.step = ivp.t1 - ivp.t0}, observer);
}

bool runs_first_order_systems(const MethodInfo& info) {
  return !info.needs.has(Capability::second_order) && info.has_fixed_step && info.order > 0;
}

/// A system that hands out unit slopes: the j-th call of its right-hand side returns e_j and keeps the
/// arguments. An explicit method thereby shows its tableau: Y_i = h Σ_j a_ij e_j.
class ProbingSystem final : public OdeSystem {
 public:
  explicit ProbingSystem(Index size) : size_(size) {}

  Index size() const override { return size_; }
  void rhs(double t, ConstVectorRef y, VectorRef dydt) const override {
    times.push_back(t);
    arguments.push_back(y);
    dydt.setZero();
    const auto call = static_cast<Index>(times.size()) - 1;
    if (call < size_) dydt[call] = 1.0;
  }
  void rhs(const Float128&, std::span<const Float128>, std::span<Float128>) const override { refuse(); }
  void rhs(double, std::span<const Complex>, std::span<Complex>) const override { refuse(); }
  SparseMatrix jacobian_pattern() const override { return SparseMatrix(size_, size_); }
  void jacobian(double, ConstVectorRef, SparseMatrix&) const override { refuse(); }
  void jacobian_product(double, ConstVectorRef, ConstVectorRef, VectorRef) const override { refuse(); }

  mutable std::vector<double> times{};
  mutable std::vector<Vector> arguments{};

 private:
  [[noreturn]] static void refuse() { throw std::logic_error("a probing system answers in double only"); }
  Index size_;
};

/// The largest difference between the tableau and what an explicit scheme does.
double probe_explicit(const Integrator& integrator, const schemes::TableauValues<double>& tableau) {
  const int s = tableau.stages;
  const auto probe = std::make_shared<ProbingSystem>(s);
  constexpr double t0 = 0.5, h = 0.25;
  const Solution solution = one_step(integrator, {probe, t0, t0 + h, Vector::Zero(s), {}});
  if (static_cast<int>(probe->times.size()) < s) return std::numeric_limits<double>::infinity();
  double largest = 0.0;
  for (int i = 0; i < s; ++i) {
    const auto k = static_cast<std::size_t>(i);
    largest = std::max(largest, std::abs((probe->times[k] - t0) / h - tableau.c[k]));
    largest = std::max(largest, std::abs(solution.state[i] / h - tableau.b[k]));
    for (int j = 0; j < s; ++j) {
      largest = std::max(largest, std::abs(probe->arguments[k][j] / h - tableau.A(i, j)));
    }
  }
  return largest;
}

/// For any Runge–Kutta method with distinct nodes: φ_i(t) are the Lagrange polynomials of the nodes; ẏ_k =
/// φ_k(t) gives b_k, and ż_{jk} = φ_j(t) y_k gives b_j a_jk.
struct NodalSystem {
  std::vector<double> nodes;
  double t0, h;
  template <class S>
  S lagrange(std::size_t i, const S& t) const {
    S product(1);
    const S x = (t - S(t0)) / S(h);
    for (std::size_t j = 0; j < nodes.size(); ++j) {
      if (j != i) product *= (x - S(nodes[j])) / (S(nodes[i]) - S(nodes[j]));
    }
    return product;
  }
  template <class S>
  void operator()(const S& t, std::span<const S> y, std::span<S> dydt) const {
    const std::size_t s = nodes.size();
    for (std::size_t k = 0; k < s; ++k) dydt[k] = lagrange(k, t);
    for (std::size_t j = 0; j < s; ++j) {
      for (std::size_t k = 0; k < s; ++k) dydt[s + j * s + k] = lagrange(j, t) * y[k];
    }
  }
};

double probe_nodal(const Integrator& integrator, const schemes::TableauValues<double>& tableau) {
  const int s = tableau.stages;
  constexpr double t0 = 0.5, h = 0.25;
  const Index size = s + s * s;
  const auto system = std::make_shared<FunctorSystem<NodalSystem>>(size, NodalSystem{tableau.c, t0, h});
  const Solution solution = one_step(integrator, {system, t0, t0 + h, Vector::Zero(size), {}});
  if (!solution.status.ok()) return std::numeric_limits<double>::infinity();
  double largest = 0.0;
  for (int j = 0; j < s; ++j) {
    const double weight = tableau.b[static_cast<std::size_t>(j)];
    largest = std::max(largest, std::abs(solution.state[j] / h - weight));
    for (int k = 0; k < s; ++k) {
      largest =
          std::max(largest, std::abs(solution.state[s + j * s + k] / (h * h) - weight * tableau.A(j, k)));
    }
  }
  return largest;
}

/// q̈ = −q: the number of right-hand sides does not depend on the solution.
struct Oscillator {
  template <class S>
  void operator()(const S&, std::span<const S> q, std::span<const S>, std::span<S> f) const {
    f[0] = -q[0];
  }
};

bool has_distinct_nodes(const std::vector<double>& c) {
  for (std::size_t i = 0; i < c.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (std::abs(c[i] - c[j]) < 1e-3) return false;
    }
  }
  return true;
}

}  // namespace

void verify_polynomial_exactness(const SchemeUnderTest& scheme, std::vector<PropertyCheck>& checks) {
  const MethodInfo& info = scheme.integrator.info();
  PropertyCheck check{.property = "polynomial exactness"};
  if (!runs_first_order_systems(info) || info.is_multistep) {
    check.reason = "one-step schemes for y' = f(t, y) only";
    checks.push_back(check);
    return;
  }
  constexpr double t0 = 0.25;
  const auto system = std::make_shared<FunctorSystem<Monomials>>(largest_degree + 1, Monomials{t0});
  const Solution solution =
      one_step(scheme.integrator, {system, t0, t0 + 1.0, Vector::Zero(largest_degree + 1), {}});
  // Largest degree of g that is integrated to rounding; the next one must be missed clearly.
  const auto error = [&](int degree) { return std::abs(solution.state[degree] - 1.0); };
  int exact = 0;
  // Rounding of coefficients and of differences in time (Rosenbrock) allows for 1e-9, a missed moment is far
  // larger.
  constexpr double rounding = 1e-9, missed = 1e-7;
  while (exact <= largest_degree && error(exact) <= rounding) ++exact;
  check.measured = std::to_string(exact);
  check.claimed = fmt::format(">= {}", info.order);
  check.verdict = solution.status.ok() && exact >= info.order ? Verdict::holds : Verdict::fails;
  const schemes::DerivedProperties derived = schemes::derive(scheme.data);
  if (derived.quadrature_order) {
    check.derived = std::to_string(*derived.quadrature_order);
    if (*derived.quadrature_order != exact) check.verdict = Verdict::fails;
  }
  if (exact <= largest_degree && error(exact) < missed) check.verdict = Verdict::fails;
  if (check.verdict == Verdict::fails) {
    check.reason = fmt::format("polynomials of degree < {} are integrated exactly in one step{}", exact,
                               solution.status.ok() ? "" : "; " + solution.status.describe());
  }
  checks.push_back(check);
}

void verify_evaluation_count(const SchemeUnderTest& scheme, std::vector<PropertyCheck>& checks) {
  const MethodInfo& info = scheme.integrator.info();
  PropertyCheck check{.property = "evaluations per step"};
  if (!info.is_explicit || !info.has_fixed_step || info.needs.has(Capability::springs)) {
    check.reason = "exact for explicit schemes only";
    checks.push_back(check);
    return;
  }
  const auto system = std::make_shared<FunctorSecondOrderSystem<Oscillator>>(
      Vector::Constant(1, 1.5), ForceClass::position, Oscillator{});
  if (const std::string why = why_not_applicable(info, *system); !why.empty()) {
    check.reason = why;
    checks.push_back(check);
    return;
  }
  const auto count = [&](int steps) {
    NullObserver observer;
    const Ivp ivp{system, 0.0, 0.0625 * steps, Vector{{1.0, 0.25}}, {}};
    return static_cast<std::int64_t>(
        scheme.integrator.solve(ivp, FixedStep{.step = 0.0625}, observer).work.rhs_evaluations);
  };
  const std::int64_t more = count(48) - count(16);
  check.claimed = std::to_string(info.stages);
  check.measured = fmt::format("{:g}", static_cast<double>(more) / 32.0);
  check.verdict = more == 32 * info.stages ? Verdict::holds : Verdict::fails;
  checks.push_back(check);
}

void verify_tableau(const SchemeUnderTest& scheme, std::vector<PropertyCheck>& checks) {
  PropertyCheck check{.property = "tableau of the running code"};
  const auto* tableau = std::get_if<schemes::ButcherTableau>(&scheme.data);
  if (tableau == nullptr) {
    check.reason = "Runge-Kutta tableaus only";
    checks.push_back(check);
    return;
  }
  const schemes::TableauValues<double> values = schemes::values<double>(*tableau);
  const bool is_explicit = shape(*tableau) == schemes::TableauShape::explicit_stages;
  if (!is_explicit && !has_distinct_nodes(values.c)) {
    check.reason = "nodes coincide: the stages cannot be told apart by time";
    checks.push_back(check);
    return;
  }
  const double difference =
      is_explicit ? probe_explicit(scheme.integrator, values) : probe_nodal(scheme.integrator, values);
  double largest = 1.0;
  for (const double a : values.a) largest = std::max(largest, std::abs(a));
  // Lagrange polynomials of many nodes amplify the rounding of t.
  const double allowed = (is_explicit ? 1e-14 : 1e-10) * largest;
  check.claimed = "as listed";
  check.measured = fmt::format("differs by {:.1e}", difference);
  check.verdict = difference <= allowed ? Verdict::holds : Verdict::fails;
  if (check.verdict == Verdict::fails) check.reason = "the code does not do what the tableau says";
  checks.push_back(check);
}

}  // namespace fw::analysis
