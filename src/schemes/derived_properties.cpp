#include "schemes/derived_properties.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "core/types.hpp"
#include "dense/eigenvalues.hpp"
#include "dense/factorisations.hpp"
#include "schemes/multistep_properties.hpp"
#include "schemes/order_conditions.hpp"

namespace fw::schemes {

namespace {

/// Conditions on geometry are met or missed by far more than this.
constexpr double geometry_tolerance = 1e-12;

bool is_zero(const Float128& x) {
  return abs(x) <= geometry_tolerance;
}

/// B A + Aᵀ B − b bᵀ, row by row.
std::vector<Float128> algebraic_stability_matrix(const TableauValues<Float128>& t) {
  const auto s = static_cast<std::size_t>(t.stages);
  std::vector<Float128> m(s * s);
  for (std::size_t i = 0; i < s; ++i) {
    for (std::size_t j = 0; j < s; ++j) {
      m[i * s + j] = t.b[i] * t.a[i * s + j] + t.b[j] * t.a[j * s + i] - t.b[i] * t.b[j];
    }
  }
  return m;
}

/// The trace and determinant of the oscillator matrix at z.
struct Propagation {
  double trace, determinant;
};

class OscillatorMatrix {
 public:
  explicit OscillatorMatrix(const NystromValues<Float128>& t)
      : s_(t.stages), A_(s_, s_), stage_(s_, 2), out_(2, s_) {
    for (Index i = 0; i < s_; ++i) {
      const auto k = static_cast<std::size_t>(i);
      for (Index j = 0; j < s_; ++j) {
        A_(i, j) =
            static_cast<double>(t.a_position[k * static_cast<std::size_t>(s_) + static_cast<std::size_t>(j)]);
      }
      stage_(i, 0) = 1.0;
      stage_(i, 1) = static_cast<double>(t.c[k]);
      out_(0, i) = static_cast<double>(t.b_position[k]);
      out_(1, i) = static_cast<double>(t.b_velocity[k]);
    }
  }

  Propagation at(double z) const {
    const Matrix system = Matrix::Identity(s_, s_) + z * z * A_;
    const Eigen::Matrix<double, Eigen::Dynamic, 2> stages = dense::Lu(system).solve_all(stage_);
    const Eigen::Matrix2d change = -z * z * (out_ * stages);
    Eigen::Matrix2d m;
    m << 1.0, 1.0, 0.0, 1.0;
    m += change;
    return {m.trace(), m.determinant()};
  }

 private:
  Index s_;
  Matrix A_;
  Eigen::Matrix<double, Eigen::Dynamic, 2> stage_;
  Eigen::Matrix<double, 2, Eigen::Dynamic> out_;
};

/// det − 1 of the oscillator matrix in binary128, stage by stage; empty where stages are implicit.
std::optional<Float128> determinant_excess(const NystromValues<Float128>& t, double z) {
  const auto s = static_cast<std::size_t>(t.stages);
  const Float128 square = Float128(z) * z;
  // k_i = −z² (q + c_i v + Σ_j ā_ij k_j) for (q, v) = (1, 0) and (0, 1).
  std::vector<Float128> by_position(s), by_velocity(s);
  Float128 m[2][2] = {{0, 1}, {0, 0}};  // the matrix minus the identity
  for (std::size_t i = 0; i < s; ++i) {
    Float128 position = 1, velocity = t.c[i];
    for (std::size_t j = 0; j < s; ++j) {
      const Float128& a = t.a_position[i * s + j];
      if (a == 0) continue;
      if (j >= i) return std::nullopt;
      position += a * by_position[j];
      velocity += a * by_velocity[j];
    }
    by_position[i] = -square * position;
    by_velocity[i] = -square * velocity;
    m[0][0] += t.b_position[i] * by_position[i];
    m[0][1] += t.b_position[i] * by_velocity[i];
    m[1][0] += t.b_velocity[i] * by_position[i];
    m[1][1] += t.b_velocity[i] * by_velocity[i];
  }
  // (1 + a)(1 + d) − bc − 1.
  return m[0][0] + m[1][1] + m[0][0] * m[1][1] - m[0][1] * m[1][0];
}

/// The order with which `value(z)` → 0 minus one; −1 where it is rounding throughout.
template <class Value>
int vanishing_order(Value value) {
  // Two points where neither rounding nor the next term matters for the orders that schemes have.
  const double coarse = 0.4, fine = 0.2;
  const double a = std::abs(value(coarse)), b = std::abs(value(fine));
  if (a < 1e-13 || b < 1e-15) return a < 1e-12 ? -1 : static_cast<int>(std::lround(std::log2(a / b))) - 1;
  return static_cast<int>(std::lround(std::log2(a / b))) - 1;
}

template <class Tableau>
DerivedProperties derive_runge_kutta(const Tableau& tableau) {
  DerivedProperties p;
  p.order = p.order_with_velocity_forces = order_of_accuracy(tableau);
  p.stability_function = stability_function(tableau);
  p.stability = linear_stability(*p.stability_function);
  if (!tableau.b_embedded.empty()) p.embedded_order = embedded_order(tableau);
  return p;
}

DerivedProperties derive_one(std::monostate) {
  return {};
}

DerivedProperties derive_one(const ButcherTableau& tableau) {
  DerivedProperties p = derive_runge_kutta(tableau);
  const TableauValues<Float128> numbers = values<Float128>(tableau);
  p.stage_order = stage_order(tableau);
  p.quadrature_order = quadrature_order(numbers, 1e4 * uncertainty(tableau));
  p.principal_error = principal_error(tableau);
  p.first_same_as_last = is_first_same_as_last(tableau);
  p.stiffly_accurate = is_stiffly_accurate(tableau);
  p.algebraically_stable = is_algebraically_stable(tableau);
  p.symplectic = is_symplectic(tableau);
  p.symmetric = is_symmetric(tableau);
  return p;
}

DerivedProperties derive_one(const RosenbrockTableau& tableau) {
  return derive_runge_kutta(tableau);
}

DerivedProperties derive_nystrom(const NystromValues<Float128>& numbers) {
  DerivedProperties p;
  p.symplectic = is_symplectic(numbers);
  p.symmetric = is_symmetric(numbers);
  p.oscillator = oscillator_stability(numbers);
  return p;
}

DerivedProperties derive_one(const NystromTableau& tableau) {
  DerivedProperties p = derive_nystrom(values<Float128>(tableau));
  p.order = order_of_accuracy(tableau, false);
  if (!tableau.A_velocity.empty()) p.order_with_velocity_forces = order_of_accuracy(tableau, true);
  if (!tableau.b_position_embedded.empty()) p.embedded_order = embedded_order(tableau);
  return p;
}

DerivedProperties derive_one(const SplittingScheme& scheme) {
  DerivedProperties p = derive_nystrom(as_nystrom(scheme));
  p.order = order_of_accuracy(scheme, false);
  p.order_with_velocity_forces = order_of_accuracy(scheme, true);
  return p;
}

DerivedProperties derive_one(const AdditiveTableau& tableau) {
  // Linear stability of the implicit part alone: what the stiff half sees.
  DerivedProperties p;
  p.order = p.order_with_velocity_forces = order_of_accuracy(tableau);
  if (!tableau.explicit_part.b_embedded.empty()) p.embedded_order = embedded_order(tableau);
  p.stability_function = stability_function(tableau.implicit_part);
  p.stability = linear_stability(*p.stability_function);
  p.stage_order = stage_order(tableau.implicit_part);
  p.stiffly_accurate = is_stiffly_accurate(tableau.implicit_part);
  return p;
}

DerivedProperties derive_one(const MultistepFormula& formula) {
  DerivedProperties p;
  p.order = p.order_with_velocity_forces = order_of_accuracy(formula);
  p.symmetric = is_symmetric(formula);
  p.zero_stable = is_zero_stable(formula);
  p.stability_angle = stability_angle(formula);
  p.error_constant = error_constant(formula).convert_to<double>();
  return p;
}

}  // namespace

bool is_symplectic(const ButcherTableau& tableau) {
  const std::vector<Float128> m = algebraic_stability_matrix(values<Float128>(tableau));
  return std::all_of(m.begin(), m.end(), is_zero);
}

bool is_symplectic(const NystromValues<Float128>& t) {
  const auto s = static_cast<std::size_t>(t.stages);
  for (std::size_t i = 0; i < s; ++i) {
    if (!is_zero(t.b_position[i] - t.b_velocity[i] * (1 - t.c[i]))) return false;
    for (std::size_t j = 0; j < s; ++j) {
      const Float128 left = t.b_velocity[i] * (t.b_position[j] - t.a_position[i * s + j]);
      const Float128 right = t.b_velocity[j] * (t.b_position[i] - t.a_position[j * s + i]);
      if (!is_zero(left - right)) return false;
    }
  }
  return true;
}

bool is_symmetric(const ButcherTableau& tableau) {
  const TableauValues<Float128> t = values<Float128>(tableau);
  const auto s = static_cast<std::size_t>(t.stages);
  for (std::size_t i = 0; i < s; ++i) {
    if (!is_zero(t.b[i] - t.b[s - 1 - i])) return false;
    for (std::size_t j = 0; j < s; ++j) {
      if (!is_zero(t.a[i * s + j] + t.a[(s - 1 - i) * s + (s - 1 - j)] - t.b[j])) return false;
    }
  }
  return true;
}

bool is_symmetric(const NystromValues<Float128>& t) {
  // The adjoint method has c* = 1 − c, b* = b, b̄* = b − b̄, ā*_ij = (1 − c_i) b_j − b̄_j + ā_ij with the stages
  // in reverse order.
  const auto s = static_cast<std::size_t>(t.stages);
  for (std::size_t i = 0; i < s; ++i) {
    const std::size_t r = s - 1 - i;
    if (!is_zero(t.c[r] - (1 - t.c[i])) || !is_zero(t.b_velocity[r] - t.b_velocity[i]) ||
        !is_zero(t.b_position[r] - (t.b_velocity[i] - t.b_position[i]))) {
      return false;
    }
    for (std::size_t j = 0; j < s; ++j) {
      const Float128 adjoint = (1 - t.c[i]) * t.b_velocity[j] - t.b_position[j] + t.a_position[i * s + j];
      if (!is_zero(t.a_position[r * s + (s - 1 - j)] - adjoint)) return false;
    }
  }
  return true;
}

bool is_algebraically_stable(const ButcherTableau& tableau) {
  const TableauValues<Float128> t = values<Float128>(tableau);
  for (const Float128& weight : t.b) {
    if (weight < -geometry_tolerance) return false;
  }
  const std::vector<Float128> m = algebraic_stability_matrix(t);
  Matrix rounded(t.stages, t.stages);
  for (Index i = 0; i < rounded.rows(); ++i) {
    for (Index j = 0; j < rounded.cols(); ++j) {
      rounded(i, j) = static_cast<double>(m[static_cast<std::size_t>(i * rounded.cols() + j)]);
    }
  }
  return dense::symmetric_eigen(rounded).values.minCoeff() >= -geometry_tolerance;
}

bool is_first_same_as_last(const ButcherTableau& tableau) {
  const TableauValues<Float128> t = values<Float128>(tableau);
  return t.stages > 1 && is_stiffly_accurate(tableau) &&
         std::all_of(t.a.begin(), t.a.begin() + t.stages, [](const Float128& a) { return a == 0; });
}

bool is_stiffly_accurate(const ButcherTableau& tableau) {
  const TableauValues<Float128> t = values<Float128>(tableau);
  for (int j = 0; j < t.stages; ++j) {
    if (!is_zero(t.A(t.stages - 1, j) - t.b[static_cast<std::size_t>(j)])) return false;
  }
  return true;
}

double oscillator_growth(const NystromValues<Float128>& tableau, double z) {
  const Propagation m = OscillatorMatrix(tableau).at(z);
  const double discriminant = 0.25 * m.trace * m.trace - m.determinant;
  if (discriminant <= 0.0) return std::sqrt(std::max(m.determinant, 0.0));
  return std::abs(0.5 * m.trace) + std::sqrt(discriminant);
}

OscillatorStability oscillator_stability(const NystromValues<Float128>& tableau) {
  const OscillatorMatrix matrix(tableau);
  const bool preserves_area = is_symplectic(tableau);
  const auto is_stable = [&](double z) {
    const Propagation m = matrix.at(z);
    constexpr double rounding = 1e-13;
    if (std::abs(m.trace) > 1.0 + m.determinant + rounding) return false;
    if (preserves_area) return true;
    // Growth may begin with a high power of z: the determinant is judged far below the rounding of double.
    const std::optional<Float128> excess = determinant_excess(tableau, z);
    return excess ? *excess <= 1e-27 : m.determinant <= 1.0 + rounding;
  };
  OscillatorStability result;
  constexpr double farthest = 1e4;
  double good = 0.0, bad = std::numeric_limits<double>::infinity();
  for (double z = 1e-2; z < farthest; z *= 1.001) {
    if (!is_stable(z)) {
      bad = z;
      break;
    }
    good = z;
  }
  if (std::isinf(bad)) {
    result.interval = bad;
  } else {
    while (bad - good > 1e-14 * bad) {
      const double middle = 0.5 * (good + bad);
      if (middle == good || middle == bad) break;
      (is_stable(middle) ? good : bad) = middle;
    }
    // Where growth begins at once, bisection ends at the resolution of the test.
    constexpr double resolution = 1e-2;
    result.interval = good < resolution ? 0.0 : good;
  }
  result.dissipation_order = vanishing_order([&](double z) { return 1.0 - matrix.at(z).determinant; });
  result.dispersion_order = vanishing_order([&](double z) {
    // cos φ = trace/(2√det); φ − z from 1 − cos φ = 2 sin²(φ/2), which loses no digits.
    const Propagation m = matrix.at(z);
    const double cosine_defect = 1.0 - 0.5 * m.trace / std::sqrt(m.determinant);
    return 2.0 * std::asin(std::sqrt(0.5 * cosine_defect)) - z;
  });
  return result;
}

DerivedProperties derive(const SchemeData& data) {
  return std::visit([](const auto& scheme) { return derive_one(scheme); }, data);
}

}  // namespace fw::schemes
