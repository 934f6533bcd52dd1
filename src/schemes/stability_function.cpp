#include "schemes/stability_function.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace fw::schemes {

namespace {

using Polynomial = std::vector<Float128>;

/// Relative to the largest coefficient: what is smaller is rounding.
constexpr double negligible = 1e-22;

void trim(Polynomial& p, double allowed) {
  Float128 largest = 0;
  for (const Float128& c : p) largest = std::max(largest, Float128(abs(c)));
  for (Float128& c : p) {
    if (abs(c) <= allowed * largest) c = 0;
  }
  while (p.size() > 1 && p.back() == 0) p.pop_back();
}

/// R with coefficients in double, for many evaluations.
class RoundedQuotient {
 public:
  explicit RoundedQuotient(const StabilityFunction& R) {
    for (const Float128& c : R.numerator) numerator_.push_back(static_cast<double>(c));
    for (const Float128& c : R.denominator) denominator_.push_back(static_cast<double>(c));
  }

  std::complex<double> operator()(std::complex<double> z) const {
    if (std::abs(z) <= 1.0 || numerator_.size() > denominator_.size()) {
      return evaluate(numerator_, z) / evaluate(denominator_, z);
    }
    // In powers of 1/z, so that neither polynomial overflows far out.
    const std::complex<double> inverse = 1.0 / z;
    std::complex<double> quotient = reversed(numerator_, inverse) / reversed(denominator_, inverse);
    for (std::size_t k = numerator_.size(); k < denominator_.size(); ++k) quotient *= inverse;
    return quotient;
  }

 private:
  static std::complex<double> evaluate(const std::vector<double>& p, std::complex<double> x) {
    std::complex<double> sum = 0.0;
    for (std::size_t k = p.size(); k-- > 0;) sum = sum * x + p[k];
    return sum;
  }
  static std::complex<double> reversed(const std::vector<double>& p, std::complex<double> x) {
    std::complex<double> sum = 0.0;
    for (const double c : p) sum = sum * x + c;
    return sum;
  }

  std::vector<double> numerator_{}, denominator_{};
};

Polynomial multiplied(const Polynomial& a, const Polynomial& b) {
  Polynomial product(a.size() + b.size() - 1, Float128(0));
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) product[i + j] += a[i] * b[j];
  }
  return product;
}

/// det(I − zM) for an s×s matrix stored row by row.
Polynomial reversed_characteristic_polynomial(const std::vector<Float128>& m, std::size_t s) {
  // Faddeev–LeVerrier: B_1 = M, c_1 = tr B_1, B_{k+1} = M (B_k − c_k I), c_{k+1} = tr B_{k+1}/(k + 1);
  // det(I − zM) = 1 − c_1 z − c_2 z² − …
  Polynomial p(s + 1, Float128(0));
  p[0] = 1;
  std::vector<Float128> b = m;
  for (std::size_t k = 1; k <= s; ++k) {
    Float128 trace = 0;
    for (std::size_t i = 0; i < s; ++i) trace += b[i * s + i];
    const Float128 c = trace / Float128(static_cast<double>(k));
    p[k] = -c;
    for (std::size_t i = 0; i < s; ++i) b[i * s + i] -= c;
    std::vector<Float128> next(s * s, Float128(0));
    for (std::size_t i = 0; i < s; ++i) {
      for (std::size_t j = 0; j < s; ++j) {
        if (m[i * s + j] == 0) continue;
        for (std::size_t l = 0; l < s; ++l) next[i * s + l] += m[i * s + j] * b[j * s + l];
      }
    }
    b = std::move(next);
  }
  return p;
}

/// Removes factors (1 − x z) that P and Q share, for the roots 1/x of Q among the diagonal entries of A.
void remove_common_factors(StabilityFunction& R, const std::vector<Float128>& candidates, double allowed) {
  for (const Float128& x : candidates) {
    if (x == 0) continue;
    for (;;) {
      const Float128 root = 1 / x;
      const auto remainder = [&](const Polynomial& p) {
        Float128 sum = 0, size = 0, power = 1;
        for (const Float128& c : p) {
          sum += c * power;
          size += abs(Float128(c * power));
          power *= root;
        }
        return Float128(abs(sum) / size);
      };
      if (R.denominator.size() < 2 || R.numerator.size() < 2 || remainder(R.denominator) > allowed ||
          remainder(R.numerator) > allowed) {
        break;
      }
      for (Polynomial* p : {&R.numerator, &R.denominator}) {
        // p = (1 − x z) q: q_0 = p_0, q_k = p_k + x q_{k−1}.
        Polynomial quotient(p->size() - 1);
        Float128 previous = 0;
        for (std::size_t k = 0; k < quotient.size(); ++k) {
          quotient[k] = (*p)[k] + x * previous;
          previous = quotient[k];
        }
        *p = std::move(quotient);
      }
    }
  }
}

StabilityFunction from_matrices(const std::vector<Float128>& a, const std::vector<Float128>& b,
                                double uncertainty) {
  const std::size_t s = b.size();
  std::vector<Float128> reduced = a, diagonal;
  for (std::size_t i = 0; i < s; ++i) {
    for (std::size_t j = 0; j < s; ++j) reduced[i * s + j] -= b[j];
    diagonal.push_back(a[i * s + i]);
  }
  StabilityFunction R{reversed_characteristic_polynomial(reduced, s),
                      reversed_characteristic_polynomial(a, s)};
  const double allowed = std::max(negligible, 1e3 * uncertainty);
  trim(R.numerator, allowed);
  trim(R.denominator, allowed);
  remove_common_factors(R, diagonal, std::max(1e-18, 1e3 * uncertainty));
  return R;
}

/// |Q(iy)|² − |P(iy)|² as a polynomial in y²: the E-polynomial, ≥ 0 where |R(iy)| ≤ 1 [Hairer, Wanner 1996,
/// IV.3].
Polynomial e_polynomial(const StabilityFunction& R) {
  const auto square_on_axis = [](const Polynomial& p) {
    // p(iy) = even(−y²) + i y odd(−y²).
    Polynomial even, odd;
    for (std::size_t k = 0; k < p.size(); ++k) {
      const Float128 sign = (k / 2) % 2 == 0 ? 1 : -1;
      (k % 2 == 0 ? even : odd).push_back(sign * p[k]);
    }
    Polynomial result = multiplied(even, even);
    if (!odd.empty()) {
      const Polynomial square = multiplied(odd, odd);
      if (result.size() < square.size() + 1) result.resize(square.size() + 1, Float128(0));
      for (std::size_t k = 0; k < square.size(); ++k) result[k + 1] += square[k];
    }
    return result;
  };
  Polynomial e = square_on_axis(R.denominator);
  const Polynomial p = square_on_axis(R.numerator);
  if (e.size() < p.size()) e.resize(p.size(), Float128(0));
  // A coefficient that the subtraction has cancelled is zero.
  for (std::size_t k = 0; k < e.size(); ++k) {
    const Float128 before =
        k < p.size() ? std::max(Float128(abs(e[k])), Float128(abs(p[k]))) : Float128(abs(e[k]));
    if (k < p.size()) e[k] -= p[k];
    if (abs(e[k]) <= 1e-14 * before) e[k] = 0;
  }
  return e;
}

/// The first x > 0 at which `is_stable` fails on a geometric grid, sharpened by bisection; infinite if none
/// is found up to `farthest`.
template <class Predicate>
double first_failure(Predicate is_stable, double nearest, double farthest) {
  constexpr double ratio = 1.002;
  double good = 0.0;
  for (double x = nearest; x <= farthest; x *= ratio) {
    if (is_stable(x)) {
      good = x;
      continue;
    }
    double bad = x;
    for (int i = 0; i < 200 && bad - good > 1e-15 * bad; ++i) {
      const double middle = 0.5 * (good + bad);
      (is_stable(middle) ? good : bad) = middle;
    }
    return good;
  }
  return std::numeric_limits<double>::infinity();
}

/// ln R(z) − z as a power series up to z^{count−1}.
std::vector<Float128> logarithmic_defect(const StabilityFunction& R, std::size_t count) {
  const auto logarithm = [&](const Polynomial& p) {
    // L = ln p: p' = L' p, so k p_k = Σ_{j=1}^{k} j l_j p_{k−j}.
    std::vector<Float128> l(count, Float128(0));
    const auto coefficient = [&](std::size_t k) { return k < p.size() ? p[k] : Float128(0); };
    for (std::size_t k = 1; k < count; ++k) {
      Float128 sum = Float128(static_cast<double>(k)) * coefficient(k);
      for (std::size_t j = 1; j < k; ++j) sum -= Float128(static_cast<double>(j)) * l[j] * coefficient(k - j);
      l[k] = sum / Float128(static_cast<double>(k));
    }
    return l;
  };
  std::vector<Float128> defect = logarithm(R.numerator);
  const std::vector<Float128> denominator = logarithm(R.denominator);
  for (std::size_t k = 0; k < count; ++k) defect[k] -= denominator[k];
  defect[1] -= 1;
  return defect;
}

}  // namespace

std::complex<double> StabilityFunction::operator()(std::complex<double> z) const {
  return RoundedQuotient(*this)(z);
}

StabilityFunction stability_function(const ButcherTableau& tableau) {
  const TableauValues<Float128> numbers = values<Float128>(tableau);
  return from_matrices(numbers.a, numbers.b, uncertainty(tableau));
}

StabilityFunction embedded_stability_function(const ButcherTableau& tableau) {
  const TableauValues<Float128> numbers = values<Float128>(tableau);
  return from_matrices(numbers.a, numbers.b_embedded, uncertainty(tableau));
}

StabilityFunction stability_function(const RosenbrockTableau& tableau) {
  const std::size_t s = tableau.b.size();
  std::vector<Float128> beta(s * s, Float128(0)), b;
  double largest = 1e-31;
  for (std::size_t i = 0; i < s; ++i) {
    for (std::size_t j = 0; j < tableau.alpha[i].size(); ++j) beta[i * s + j] += tableau.alpha[i][j].value();
    for (std::size_t j = 0; j < tableau.gamma[i].size(); ++j) {
      beta[i * s + j] += tableau.gamma[i][j].value();
      largest = std::max(largest, tableau.gamma[i][j].uncertainty());
    }
    b.push_back(tableau.b[i].value());
  }
  return from_matrices(beta, b, largest);
}

LinearStability linear_stability(const StabilityFunction& R) {
  LinearStability result;
  constexpr double slack = 1e-10;  // |R| = 1 + rounding still counts as stable
  constexpr double far = 1e8;
  const Polynomial e = e_polynomial(R);
  const RoundedQuotient rounded(R);
  const auto stable_on_axis = [&](double y) {
    // Judged by the E-polynomial: near 0 it resolves 1 − |R| far below rounding of |R| itself.
    const Float128 x = Float128(y) * y;
    Float128 sum = 0, size = 0, power = 1;
    for (const Float128& c : e) {
      sum += c * power;
      size += abs(Float128(c * power));
      power *= x;
    }
    return sum >= -1e-13 * size;
  };
  const auto stable_at = [&](std::complex<double> z) {
    const double magnitude = std::abs(rounded(z));
    return magnitude <= 1.0 + slack;
  };
  result.real_interval = first_failure([&](double x) { return stable_at(-x); }, 1e-3, far);
  // Without a negative coefficient no sum is negative: no point has to be tried (as for most A-stable schemes).
  const bool is_never_negative = std::all_of(e.begin(), e.end(), [](const Float128& c) { return c >= 0; });
  result.imaginary_interval =
      is_never_negative ? std::numeric_limits<double>::infinity() : first_failure(stable_on_axis, 1e-6, far);
  const std::size_t p = R.numerator.size(), q = R.denominator.size();
  result.at_infinity = p > q   ? std::numeric_limits<double>::infinity()
                       : p < q ? 0.0
                               : std::abs(static_cast<double>(R.numerator.back() / R.denominator.back()));
  const bool bounded_on_axis = std::isinf(result.imaginary_interval) && result.at_infinity <= 1.0 + slack;
  const auto stable_in_sector = [&](double degrees) {
    const double angle = std::numbers::pi * (1.0 - degrees / 180.0);
    for (double r = 1e-2; r <= far; r *= 1.02) {
      if (!stable_at(std::polar(r, angle))) return false;
    }
    return true;
  };
  // Poles in the left half-plane make |R| large somewhere inside: look there, too.
  bool inside = true;
  for (double degrees = 0.0; degrees < 90.0 && inside; degrees += 3.0) inside = stable_in_sector(degrees);
  result.is_a_stable = bounded_on_axis && inside;
  result.is_l_stable = result.is_a_stable && result.at_infinity == 0.0;
  if (result.is_a_stable) {
    result.alpha_degrees = 90.0;
  } else if (stable_in_sector(0.0)) {
    double good = 0.0, bad = 90.0;
    while (bad - good > 1e-3) {
      const double middle = 0.5 * (good + bad);
      (stable_in_sector(middle) ? good : bad) = middle;
    }
    result.alpha_degrees = good;
  }
  constexpr std::size_t terms = 24;
  const std::vector<Float128> defect = logarithmic_defect(R, terms);
  const auto first_nonzero = [&](std::size_t from, std::size_t stride) -> std::size_t {
    for (std::size_t k = from; k < terms; k += stride) {
      if (abs(defect[k]) > 1e-14) return k;
    }
    return 0;
  };
  const std::size_t leading = first_nonzero(1, 1);
  result.order = static_cast<int>(leading) - 1;
  if (leading > 0) result.error_constant = -static_cast<double>(defect[leading]);
  const std::size_t odd = first_nonzero(1, 2), even = first_nonzero(2, 2);
  result.dispersion_order = static_cast<int>(odd) - 1;
  result.dissipation_order = static_cast<int>(even) - 1;
  return result;
}

}  // namespace fw::schemes
