#include "analysis/verification/verification_problems.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <map>
#include <mutex>
#include <stdexcept>
#include <type_traits>

#include "analysis/fit/order_fit.hpp"
#include "analysis/reference/gragg_extrapolation.hpp"
#include "mechanics/mass_spring_system.hpp"
#include "ode/functor_system.hpp"

namespace fw::analysis {

namespace {

/// The gradient of V = Σ (κ_i/2 q_i² + q_i⁴/5) + (q_0 − q_1)⁴/4 + (3/10) q_0 q_1 q_2, negated. Coefficients
/// are exact in binary, so that every arithmetic has the same problem.
template <class S>
void conservative_force(std::span<const S> q, std::span<S> f) {
  const S stiffness[] = {S(1.25), S(2.5), S(0.75)};
  const S coupling = (q[0] - q[1]) * (q[0] - q[1]) * (q[0] - q[1]);
  const S product = S(0.3125);
  for (std::size_t i = 0; i < 3; ++i) f[i] = -stiffness[i] * q[i] - S(0.8125) * q[i] * q[i] * q[i];
  f[0] -= coupling + product * q[1] * q[2];
  f[1] -= -coupling + product * q[0] * q[2];
  f[2] -= product * q[0] * q[1];
}

/// What drives the oscillators.
struct Drive {
  template <class S>
  static std::array<S, 2> of(const S& t) {
    using std::cos;
    using std::sin;
    return {sin(S(1.5) * t), cos(S(2.25) * t)};
  }
};

/// What stirs the flow.
struct Stirring {
  template <class S>
  static std::array<S, 2> of(const S& t) {
    using std::sin;
    return {sin(S(2) * t), sin(S(3) * t)};
  }
};

/// Function::of(t), remembered for some thousand times per thread: the place of a time follows from its bits,
/// and a new time takes the place of an old one. In binary128 sines are half of a verification, and most are
/// asked for again: an implicit step evaluates its stages at one time until they have converged, and the members
/// of an ensemble run over the same steps. Complex ones are for the columns of a Jacobian, all at one time.
template <class Function, class S>
const std::array<S, 2>& remembered(const S& t) {
  using Bits = std::array<std::uint64_t, 2>;
  struct Entry {
    bool is_known = false;
    Bits time{};
    std::array<S, 2> values{};
  };
  constexpr int index_bits = std::is_same_v<S, Float128> ? 14 : 3;
  thread_local std::vector<Entry> entries(std::size_t{1} << index_bits);
  Bits time;
  if constexpr (std::is_same_v<S, Float128>) {
    time = std::bit_cast<Bits>(t.backend().value());
  } else {
    time = {std::bit_cast<std::uint64_t>(t.real()), std::bit_cast<std::uint64_t>(t.imag())};
  }
  constexpr std::uint64_t odd = 0x9e3779b97f4a7c15;  // Fibonacci hashing: 2^64 over the golden ratio
  Entry& entry = entries[((time[0] ^ std::rotl(time[1], 29)) * odd) >> (64 - index_bits)];
  if (!entry.is_known || entry.time != time) entry = {true, time, Function::of(t)};
  return entry.values;
}

/// Function::of(t).
template <class Function, class S>
std::array<S, 2> at(const S& t) {
  if constexpr (std::is_same_v<S, double>)
    return Function::of(t);
  else
    return remembered<Function>(t);
}

struct DrivenForce {
  template <class S>
  void operator()(const S& t, std::span<const S> q, std::span<const S>, std::span<S> f) const {
    const std::array<S, 2> driven = at<Drive>(t);
    conservative_force(q, f);
    f[0] += S(0.75) * driven[0];
    f[1] += S(0.5) * driven[1] * q[2];
    f[2] += S(0.25) * t;
  }
};

struct DampedForce {
  template <class S>
  void operator()(const S& t, std::span<const S> q, std::span<const S> v, std::span<S> f) const {
    DrivenForce{}(t, q, v, f);
    const S relative = v[1] - v[0];
    f[0] += S(0.5) * relative * (S(1) + S(0.5) * q[0] * q[0]) - S(0.125) * v[0] * v[0] * v[0];
    f[1] -= S(0.5) * relative * (S(1) + S(0.5) * q[0] * q[0]);
    f[2] += S(-0.375) * v[2] + S(0.25) * v[0] * q[1];
  }
};

struct ConservativeForce {
  template <class S>
  void operator()(const S&, std::span<const S> q, std::span<const S>, std::span<S> f) const {
    conservative_force(q, f);
  }
};

struct Flow {
  template <class S>
  void operator()(const S& t, std::span<const S> y, std::span<S> dydt) const {
    using std::cos;
    const std::array<S, 2> stirred = at<Stirring>(t);
    dydt[0] = y[1] * y[2] - S(0.5) * y[0] + S(0.25) * stirred[0];
    dydt[1] = -y[0] * y[2] + cos(y[1]) * t;
    dydt[2] = S(-0.5) * y[0] * y[1] - S(0.25) * y[2] * y[2] + S(0.125) * y[0] * stirred[1];
  }
};

const Vector& oscillator_masses() {
  static const Vector masses{{0.75, 1.625, 2.25}};
  return masses;
}

template <class Force>
Ivp oscillators(ForceClass force_class, double t0, double t1) {
  Ivp ivp;
  ivp.system = std::make_shared<FunctorSecondOrderSystem<Force>>(oscillator_masses(), force_class, Force{});
  ivp.t0 = t0;
  ivp.t1 = t1;
  ivp.y0 = Vector{{0.625, -0.375, 0.875, -0.25, 0.75, 0.5}};
  return ivp;
}

/// Corners of a stretched, tilted prism; six particles, eleven springs.
Ivp network(bool is_damped, bool is_free) {
  mechanics::MassSpringModel model;
  model.mass = {0.75, 1.5, 1.125, 2.0, 0.875, 1.375};
  const double corners[6][3] = {{0.0, 0.0, 0.0},  {1.0, 0.125, 0.0},   {0.25, 0.875, 0.125},
                                {0.0, 0.25, 1.0}, {1.125, 0.0, 0.875}, {0.375, 1.0, 1.125}};
  const int edges[11][2] = {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3},
                            {0, 3}, {1, 4}, {2, 5}, {0, 4}, {1, 5}};
  Ivp ivp;
  ivp.y0 = Vector::Zero(36);
  for (Index i = 0; i < 6; ++i) {
    for (Index k = 0; k < 3; ++k) {
      ivp.y0[3 * i + k] = corners[i][k];
      ivp.y0[18 + 3 * i + k] = 0.25 * static_cast<double>((7 * i + 5 * k) % 5 - 2);
    }
  }
  for (int e = 0; e < 11; ++e) {
    const int i = edges[e][0], j = edges[e][1];
    const double length = (ivp.y0.segment<3>(3 * j) - ivp.y0.segment<3>(3 * i)).norm();
    // Two sorts of springs, so that schemes which split stiff from soft ones have something to split.
    model.springs.add(i, j,
                      {.stiffness = e % 3 == 0 ? 24.0 : 6.0 + 0.5 * e,
                       .damping = is_damped ? 0.125 + 0.0625 * (e % 4) : 0.0,
                       .rest_length = (0.9 + 0.03 * (e % 6)) * length});
  }
  if (!is_free) {
    model.gravity = {0.5, -0.25, -2.0};
    model.fixed = {3};
    ivp.y0.segment<3>(18 + 9).setZero();
    if (is_damped) model.drag = 0.0625;
  }
  ivp.t0 = 0.0;
  ivp.t1 = 0.9;
  ivp.system = std::make_shared<const mechanics::MassSpringSystem>(std::move(model));
  return ivp;
}

}  // namespace

const Ivp& driven_oscillators() {
  static const Ivp ivp = oscillators<DrivenForce>(ForceClass::position, 0.3, 2.1);
  return ivp;
}

const Ivp& damped_oscillators() {
  static const Ivp ivp = oscillators<DampedForce>(ForceClass::velocity, 0.3, 2.1);
  return ivp;
}

const Ivp& conservative_oscillators() {
  static const Ivp ivp = oscillators<ConservativeForce>(ForceClass::position, 0.0, 1.6);
  return ivp;
}

double conservative_energy(ConstVectorRef y) {
  const Vector& m = oscillator_masses();
  const double stiffness[] = {1.25, 2.5, 0.75};
  double energy = 0.0;
  for (Index i = 0; i < 3; ++i) {
    const double q = y[i], v = y[3 + i];
    energy += 0.5 * m[i] * v * v + 0.5 * stiffness[i] * q * q + 0.25 * 0.8125 * q * q * q * q;
  }
  const double difference = y[0] - y[1];
  return energy + 0.25 * difference * difference * difference * difference + 0.3125 * y[0] * y[1] * y[2];
}

const Ivp& first_order_flow() {
  static const Ivp ivp{
      std::make_shared<FunctorSystem<Flow>>(3, Flow{}), 0.2, 1.7, Vector{{0.875, -0.5, 1.25}}, {}};
  return ivp;
}

const Ivp& spring_network() {
  static const Ivp ivp = network(false, false);
  return ivp;
}

const Ivp& damped_spring_network() {
  static const Ivp ivp = network(true, false);
  return ivp;
}

const Ivp& free_spring_network() {
  static const Ivp ivp = network(true, true);
  return ivp;
}

ProblemFunction first_applicable(const MethodInfo& info, std::initializer_list<ProblemFunction> problems) {
  for (const ProblemFunction problem : problems) {
    if (why_not_applicable(info, *problem().system).empty()) return problem;
  }
  return nullptr;
}

std::vector<ProblemFunction> applicable_problems(const MethodInfo& info,
                                                 std::initializer_list<ProblemFunction> problems) {
  std::vector<ProblemFunction> result;
  for (const ProblemFunction problem : problems) {
    if (why_not_applicable(info, *problem().system).empty()) result.push_back(problem);
  }
  return result;
}

std::optional<double> local_slope(const std::vector<double>& steps, const std::vector<double>& values,
                                  double floor) {
  const OrderFit fit = fit_finest_order(steps, values, floor, 0.15);
  if (!fit.valid) return std::nullopt;
  return fit.order;
}

double logarithmic_slope(const std::vector<double>& x, const std::vector<double>& y) {
  const double n = static_cast<double>(x.size());
  double sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double u = std::log(x[i]), v = std::log(std::max(y[i], 1e-300));
    sx += u;
    sy += v;
    sxx += u * u;
    sxy += u * v;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

double relative_error(ConstVectorRef y, const std::vector<Float128>& exact) {
  double error = 0.0, size = 0.0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    const double difference = std::abs(static_cast<double>(Float128(y[static_cast<Index>(i)]) - exact[i]));
    if (difference > error || std::isnan(difference)) error = difference;  // NaN stays
    size = std::max(size, std::abs(static_cast<double>(exact[i])));
  }
  return error / size;
}

Ivp ensemble_start(ProblemFunction problem, int member) {
  Ivp ivp = problem();
  const SecondOrderSystem* second_order = ivp.system->second_order();
  for (Index i = 0; i < ivp.y0.size(); ++i) {
    const bool fixed =
        second_order != nullptr &&
        second_order->fixed()[static_cast<std::size_t>(i % second_order->degrees_of_freedom())] != 0;
    // Multiples of 1/64, exact in binary.
    if (!fixed)
      ivp.y0[i] += 0.015625 * static_cast<double>((member * (5 * i + 3)) % 13 - 6) * (member > 0 ? 1.0 : 0.0);
  }
  return ivp;
}

namespace {

struct CertifiedProblem {
  Ivp ivp;
  ReferenceState end;
};

CertifiedProblem certified(Ivp ivp) {
  const ReferenceSolution reference = certified_reference(ivp, ivp.t1);
  if (!reference.status.ok()) {
    throw std::logic_error("the reference of a verification problem failed: " + reference.status.describe());
  }
  return {std::move(ivp), reference.states.front()};
}

/// Problems with their references, made once and kept; `make` gives the initial value problem of a key.
template <class Key>
class CertifiedProblems {
 public:
  template <class Make>
  const CertifiedProblem& get(const Key& key, Make make) {
    const std::lock_guard lock(mutex_);
    auto found = known_.find(key);
    if (found == known_.end()) found = known_.emplace(key, certified(make())).first;
    return found->second;  // nodes of a map stay where they are
  }

 private:
  std::mutex mutex_;
  std::map<Key, CertifiedProblem> known_;
};

const CertifiedProblem& member_of(ProblemFunction problem, int member) {
  static CertifiedProblems<std::pair<ProblemFunction, int>> problems;
  return problems.get({problem, member}, [&] { return ensemble_start(problem, member); });
}

const CertifiedProblem& lengthened_problem(ProblemFunction problem, double length) {
  static CertifiedProblems<std::pair<ProblemFunction, double>> problems;
  return problems.get({problem, length}, [&] {
    Ivp ivp = problem();
    ivp.t1 = ivp.t0 + length;
    return ivp;
  });
}

}  // namespace

const Ivp& ensemble_member(ProblemFunction problem, int member) {
  return member_of(problem, member).ivp;
}

const ReferenceState& certified_end(ProblemFunction problem, int member) {
  return member_of(problem, member).end;
}

const Ivp& lengthened(ProblemFunction problem, double length) {
  return lengthened_problem(problem, length).ivp;
}

const ReferenceState& certified_end_of_lengthened(ProblemFunction problem, double length) {
  return lengthened_problem(problem, length).end;
}

const FrameReference& certified_frames(ProblemFunction problem) {
  constexpr int count = 200;
  constexpr double length = 4.0;
  static std::mutex mutex;
  static std::map<ProblemFunction, FrameReference> known;
  const std::lock_guard lock(mutex);
  const auto found = known.find(problem);
  if (found != known.end()) return found->second;
  FrameReference reference{problem(), {}, {}};
  reference.ivp.t1 = reference.ivp.t0 + length;
  for (int k = 1; k <= count; ++k) {
    reference.times.push_back(k == count ? reference.ivp.t1 : reference.ivp.t0 + length * k / count);
  }
  ExtrapolationRun run = integrate_by_extrapolation(
      reference.ivp, reference.times,
      {.tableau = harmonic_extrapolation(8), .tolerance = 1e-20, .least_steps = 4});
  if (!run.status.ok()) {
    throw std::logic_error("the reference of a verification problem failed: " + run.status.describe());
  }
  reference.states = std::move(run.states);
  return known.emplace(problem, std::move(reference)).first->second;
}

}  // namespace fw::analysis
