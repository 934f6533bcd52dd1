#include "schemes/order_conditions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "schemes/rooted_trees.hpp"

namespace fw::schemes {

namespace {

/// How much larger than the uncertainty of one coefficient the residual of a condition may be.
constexpr double condition_safety = 1e4;

template <class S>
S magnitude(const S& x) {
  return x < 0 ? S(-x) : x;
}

template <class S>
S dot(const std::vector<S>& a, const std::vector<S>& b) {
  S sum(0);
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

template <class S>
bool is_met(const std::vector<S>& weights, const std::vector<S>& phi, const S& expected, double allowed) {
  S sum(0), scale(1);
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const S term = weights[i] * phi[i];
    sum += term;
    scale += magnitude(term);
  }
  return magnitude(S(sum - expected)) <= S(allowed) * scale;
}

/// M x for a matrix stored row by row; zeros are skipped, many tableaus are half empty.
template <class S>
std::vector<S> product(const std::vector<S>& matrix, const std::vector<S>& x) {
  const std::size_t s = x.size();
  std::vector<S> result(s, S(0));
  for (std::size_t i = 0; i < s; ++i) {
    for (std::size_t j = 0; j < s; ++j) {
      if (matrix[i * s + j] != 0) result[i] += matrix[i * s + j] * x[j];
    }
  }
  return result;
}

template <class S>
void multiply_into(std::vector<S>& a, const std::vector<S>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] *= b[i];
}

/// The reciprocal of a density as S: exact where S is.
template <class S>
S reciprocal(double density) {
  return S(1) / S(static_cast<std::int64_t>(density));
}

/// Elementary weights Φ(τ) of a Runge–Kutta method, order by order; `visit(tree, Φ)` returns false to stop.
template <class S, class Visit>
void visit_weights(const std::vector<S>& a, std::size_t stages, int orders, Visit visit) {
  const std::vector<RootedTree>& trees = rooted_trees(orders);
  std::vector<std::vector<S>> inner;  // A Φ(τ) of the trees that can be children
  for (const RootedTree& tree : trees) {
    std::vector<S> phi(stages, S(1));
    for (int child : tree.children) multiply_into(phi, inner[static_cast<std::size_t>(child)]);
    if (!visit(tree, phi)) return;
    if (tree.order < orders) inner.push_back(product(a, phi));
  }
}

template <class S>
std::vector<S> converted(const std::vector<Float128>& numbers) {
  std::vector<S> result;
  for (const Float128& number : numbers) result.push_back(static_cast<S>(number));
  return result;
}

NystromValues<long double> in_long_double(const NystromValues<Float128>& values) {
  NystromValues<long double> result;
  result.stages = values.stages;
  result.c = converted<long double>(values.c);
  result.a_position = converted<long double>(values.a_position);
  result.a_velocity = converted<long double>(values.a_velocity);
  result.b_position = converted<long double>(values.b_position);
  result.b_velocity = converted<long double>(values.b_velocity);
  return result;
}

/// Trees with velocity forces are many (thousands at order 8), so they are decided in 64-bit precision.
int nystrom_order(const NystromValues<Float128>& values, bool velocity_forces, double uncertainty) {
  if (!velocity_forces) {
    return order_of_weights(values, values.b_position, values.b_velocity, false,
                            condition_safety * uncertainty)
        .least();
  }
  if (values.a_velocity.empty()) return 0;
  constexpr double rounding = std::numeric_limits<long double>::epsilon();
  const NystromValues<long double> rounded = in_long_double(values);
  return order_of_weights(rounded, rounded.b_position, rounded.b_velocity, true,
                          condition_safety * std::max(uncertainty, rounding))
      .least();
}

/// α and β = α + γ of a Rosenbrock method, row by row.
struct RosenbrockMatrices {
  std::size_t stages = 0;
  std::vector<Float128> alpha{}, beta{};
  double uncertainty = 1e-31;
};

RosenbrockMatrices matrices(const RosenbrockTableau& tableau) {
  const std::size_t s = tableau.b.size();
  RosenbrockMatrices result{s, std::vector<Float128>(s * s), std::vector<Float128>(s * s)};
  const auto note = [&](const Coefficient& c) {
    result.uncertainty = std::max(result.uncertainty, c.uncertainty());
  };
  for (std::size_t i = 0; i < s; ++i) {
    for (std::size_t j = 0; j < tableau.alpha[i].size(); ++j) {
      result.alpha[i * s + j] = tableau.alpha[i][j].value();
      note(tableau.alpha[i][j]);
    }
    for (std::size_t j = 0; j < tableau.gamma[i].size(); ++j) {
      result.beta[i * s + j] = tableau.gamma[i][j].value();
      note(tableau.gamma[i][j]);
    }
  }
  for (std::size_t k = 0; k < s * s; ++k) result.beta[k] += result.alpha[k];
  for (const Coefficient& weight : tableau.b) note(weight);
  return result;
}

std::vector<Float128> numbers(const CoefficientRow& row) {
  std::vector<Float128> result;
  for (const Coefficient& coefficient : row) result.push_back(coefficient.value());
  return result;
}

int rosenbrock_order(const RosenbrockTableau& tableau, const std::vector<Float128>& b) {
  const RosenbrockMatrices m = matrices(tableau);
  const double allowed = condition_safety * m.uncertainty;
  const std::vector<RootedTree>& trees = rooted_trees(highest_order);
  std::vector<std::vector<Float128>> by_alpha, by_beta;
  for (const RootedTree& tree : trees) {
    std::vector<Float128> phi(m.stages, Float128(1));
    // A vertex with one branch meets J k and f' alike: β; one with several meets f'' of the arguments only:
    // α.
    const auto& inner = tree.children.size() == 1 ? by_beta : by_alpha;
    for (int child : tree.children) multiply_into(phi, inner[static_cast<std::size_t>(child)]);
    if (!is_met(b, phi, reciprocal<Float128>(tree.density), allowed)) return tree.order - 1;
    by_alpha.push_back(product(m.alpha, phi));
    by_beta.push_back(product(m.beta, phi));
  }
  return highest_order;
}

int additive_order(const AdditiveTableau& tableau, bool embedded) {
  const TableauValues<Float128> parts[] = {values<Float128>(tableau.explicit_part),
                                           values<Float128>(tableau.implicit_part)};
  const double allowed =
      condition_safety * std::max(uncertainty(tableau.explicit_part), uncertainty(tableau.implicit_part));
  const std::vector<ColouredTree>& trees = coloured_trees(highest_additive_order);
  std::vector<std::vector<Float128>> inner;
  for (const ColouredTree& tree : trees) {
    std::vector<Float128> phi(static_cast<std::size_t>(parts[0].stages), Float128(1));
    for (int child : tree.children) multiply_into(phi, inner[static_cast<std::size_t>(child)]);
    const TableauValues<Float128>& part = parts[tree.colour];
    if (!is_met(embedded ? part.b_embedded : part.b, phi, reciprocal<Float128>(tree.density), allowed)) {
      return tree.order - 1;
    }
    inner.push_back(product(part.a, phi));
  }
  return highest_additive_order;
}

}  // namespace

template <class S>
int order_of_weights(const TableauValues<S>& tableau, const std::vector<S>& b, double allowed) {
  int order = 0;
  // Order by order, so that a scheme of low order does not pay for the many trees of high order.
  for (int candidate = 1; candidate <= highest_order; ++candidate) {
    bool met = true;
    visit_weights(tableau.a, b.size(), candidate, [&](const RootedTree& tree, const std::vector<S>& phi) {
      if (tree.order == candidate) met = is_met(b, phi, reciprocal<S>(tree.density), allowed);
      return met;
    });
    if (!met) break;
    order = candidate;
  }
  return order;
}

template int order_of_weights<Float128>(const TableauValues<Float128>&, const std::vector<Float128>&, double);
template int order_of_weights<Rational>(const TableauValues<Rational>&, const std::vector<Rational>&, double);

template <class S>
NystromOrder order_of_weights(const NystromValues<S>& tableau, const std::vector<S>& b_position,
                              const std::vector<S>& b_velocity, bool velocity_forces, double allowed) {
  const auto s = static_cast<std::size_t>(tableau.stages);
  NystromOrder result{highest_order_with_velocity_forces, highest_order_with_velocity_forces};
  // q' = q + h v + h² Σ b̄_i k_i: order 1 needs nothing.
  std::vector<std::vector<S>> by_position, by_velocity;
  for (int candidate = 1; candidate <= highest_order_with_velocity_forces; ++candidate) {
    const std::vector<NystromTree>& trees = nystrom_trees(candidate, velocity_forces);
    for (std::size_t k = by_position.size(); k < trees.size(); ++k) {
      const NystromTree& tree = trees[k];
      std::vector<S> phi(s, S(1));
      for (int leaf = 0; leaf < tree.velocity_leaves; ++leaf) multiply_into(phi, tableau.c);
      for (int child : tree.through_position)
        multiply_into(phi, by_position[static_cast<std::size_t>(child)]);
      for (int child : tree.through_velocity)
        multiply_into(phi, by_velocity[static_cast<std::size_t>(child)]);
      // `exact` is the reciprocal of a whole number.
      const S exact = S(1) / S(static_cast<std::int64_t>(std::llround(1.0 / tree.exact)));
      if (tree.order <= result.velocity && !is_met(b_velocity, phi, exact, allowed)) {
        result.velocity = tree.order - 1;
      }
      if (tree.order + 1 <= result.position &&
          !is_met(b_position, phi, S(exact / (tree.order + 1)), allowed)) {
        result.position = tree.order;
      }
      by_position.push_back(product(tableau.a_position, phi));
      by_velocity.push_back(velocity_forces ? product(tableau.a_velocity, phi) : std::vector<S>());
    }
    if (result.velocity < candidate && result.position <= candidate) break;
    if (result.least() < candidate) break;
  }
  return result;
}

template NystromOrder order_of_weights<Float128>(const NystromValues<Float128>&, const std::vector<Float128>&,
                                                 const std::vector<Float128>&, bool, double);
template NystromOrder order_of_weights<long double>(const NystromValues<long double>&,
                                                    const std::vector<long double>&,
                                                    const std::vector<long double>&, bool, double);

int order_of_accuracy(const ButcherTableau& tableau) {
  const TableauValues<Float128> numbers = values<Float128>(tableau);
  return order_of_weights(numbers, numbers.b, condition_safety * uncertainty(tableau));
}

int embedded_order(const ButcherTableau& tableau) {
  if (tableau.b_embedded.empty()) return 0;
  const TableauValues<Float128> numbers = values<Float128>(tableau);
  return order_of_weights(numbers, numbers.b_embedded, condition_safety * uncertainty(tableau));
}

int order_of_accuracy(const NystromTableau& tableau, bool velocity_forces) {
  return nystrom_order(values<Float128>(tableau), velocity_forces, uncertainty(tableau));
}

int embedded_order(const NystromTableau& tableau) {
  if (tableau.b_position_embedded.empty()) return 0;
  const NystromValues<Float128> numbers = values<Float128>(tableau);
  return order_of_weights(numbers, numbers.b_position_embedded, numbers.b_velocity_embedded,
                          !numbers.a_velocity.empty(), condition_safety * uncertainty(tableau))
      .least();
}

int order_of_accuracy(const SplittingScheme& scheme, bool velocity_forces) {
  return nystrom_order(as_nystrom(scheme), velocity_forces, uncertainty(scheme));
}

int order_of_accuracy(const RosenbrockTableau& tableau) {
  return rosenbrock_order(tableau, numbers(tableau.b));
}

int embedded_order(const RosenbrockTableau& tableau) {
  return tableau.b_embedded.empty() ? 0 : rosenbrock_order(tableau, numbers(tableau.b_embedded));
}

int order_of_accuracy(const AdditiveTableau& tableau) {
  return additive_order(tableau, false);
}

int embedded_order(const AdditiveTableau& tableau) {
  return tableau.explicit_part.b_embedded.empty() ? 0 : additive_order(tableau, true);
}

int stage_order(const ButcherTableau& tableau) {
  const TableauValues<Float128> numbers = values<Float128>(tableau);
  const double allowed = condition_safety * uncertainty(tableau);
  const auto s = static_cast<std::size_t>(numbers.stages);
  const int quadrature = quadrature_order(numbers, allowed);
  std::vector<Float128> power(s, Float128(1));
  for (int k = 1; k <= quadrature; ++k) {
    const std::vector<Float128> sums = product(numbers.a, power);  // Σ_j a_ij c_j^{k−1}
    multiply_into(power, numbers.c);
    for (std::size_t i = 0; i < s; ++i) {
      if (abs(sums[i] - power[i] / k) > allowed) return k - 1;
    }
  }
  return quadrature;
}

int quadrature_order(const TableauValues<Float128>& tableau, double allowed) {
  std::vector<Float128> power(tableau.b.size(), Float128(1));
  const int most = 2 * tableau.stages;
  for (int k = 1; k <= most; ++k) {
    if (!is_met(tableau.b, power, Float128(Float128(1) / k), allowed)) return k - 1;
    multiply_into(power, tableau.c);
  }
  return most;
}

double principal_error(const ButcherTableau& tableau) {
  const int order = order_of_accuracy(tableau);
  const TableauValues<Float128> numbers = values<Float128>(tableau);
  Float128 sum = 0;
  visit_weights(numbers.a, numbers.b.size(), order + 1,
                [&](const RootedTree& tree, const std::vector<Float128>& phi) {
                  if (tree.order == order + 1) {
                    const Float128 residual = dot(numbers.b, phi) - 1 / Float128(tree.density);
                    sum += residual * residual / (tree.symmetry * tree.symmetry);
                  }
                  return true;
                });
  return static_cast<double>(sqrt(sum));
}

}  // namespace fw::schemes
