#include "schemes/chebyshev_recurrence.hpp"

#include <stdexcept>

namespace fw::schemes {

namespace {

/// T_j(x), T_j'(x), T_j''(x).
template <class S>
struct ChebyshevPolynomial {
  S value, slope, curvature;
};

/// Walks j = 0, 1, 2, … by T_{j+1} = 2x T_j − T_{j−1} and its derivatives.
template <class S>
class ChebyshevWalk {
 public:
  explicit ChebyshevWalk(const S& x) : x_(x), now_{S(1), S(0), S(0)}, next_{x, S(1), S(0)} {}

  const ChebyshevPolynomial<S>& now() const { return now_; }

  void advance() {
    const ChebyshevPolynomial<S> after{S(2 * x_ * next_.value - now_.value),
                                       S(2 * next_.value + 2 * x_ * next_.slope - now_.slope),
                                       S(4 * next_.slope + 2 * x_ * next_.curvature - now_.curvature)};
    now_ = next_;
    next_ = after;
  }

 private:
  S x_;
  ChebyshevPolynomial<S> now_, next_;
};

template <class S>
ChebyshevPolynomial<S> chebyshev(int degree, const S& x) {
  ChebyshevWalk<S> walk(x);
  for (int j = 0; j < degree; ++j) walk.advance();
  return walk.now();
}

constexpr int damping_numerator(int order) {
  return order == 1 ? 1 : 2;
}
constexpr int damping_denominator(int order) {
  return order == 1 ? 20 : 13;
}

}  // namespace

template <class S>
void ChebyshevRecurrence<S>::reserve(int most_stages) {
  for (std::vector<S>* row : {&mu, &nu, &mu_tilde, &gamma_tilde, &c}) {
    row->reserve(static_cast<std::size_t>(most_stages) + 1);
  }
}

template <class S>
void ChebyshevRecurrence<S>::set(int order, int s) {
  if ((order != 1 && order != 2) || s < order) {
    throw std::logic_error("Runge-Kutta-Chebyshev: order 1 needs a stage, order 2 needs two");
  }
  stages = s;
  for (std::vector<S>* row : {&mu, &nu, &mu_tilde, &gamma_tilde, &c}) {
    row->assign(static_cast<std::size_t>(s) + 1, S(0));
  }
  const S w0 = S(1) + S(damping_numerator(order)) / S(damping_denominator(order) * s * s);
  const ChebyshevPolynomial<S> last = chebyshev(s, w0);
  const S w1 = order == 1 ? S(last.value / last.slope) : S(last.slope / last.curvature);
  // b_j of the stages' polynomials a_j + b_j T_j(w0 + w1 z); b_0 = b_1 = b_2 for order 2.
  ChebyshevWalk<S> walk(w0);
  const S b2 = S(1) / (4 * w0 * w0);
  S b_before = 0, b = 0, a = 0;
  for (std::size_t j = 0; j <= static_cast<std::size_t>(s); ++j, walk.advance()) {
    const ChebyshevPolynomial<S>& polynomial = walk.now();
    const S b_now = order == 1 ? S(1 / polynomial.value)
                    : j < 2    ? b2
                               : S(polynomial.curvature / (polynomial.slope * polynomial.slope));
    if (j == 1) {
      mu_tilde[1] = order == 1 ? S(w1 / w0) : S(b_now * w1);
      c[1] = mu_tilde[1];
    } else if (j >= 2) {
      mu[j] = 2 * w0 * b_now / b;
      nu[j] = -b_now / b_before;
      mu_tilde[j] = 2 * w1 * b_now / b;
      gamma_tilde[j] = order == 1 ? S(0) : S(-a * mu_tilde[j]);
      c[j] = mu[j] * c[j - 1] + nu[j] * c[j - 2] + mu_tilde[j] + gamma_tilde[j];
    }
    a = 1 - b_now * polynomial.value;
    b_before = b;
    b = b_now;
  }
}

template struct ChebyshevRecurrence<double>;
template struct ChebyshevRecurrence<Float128>;

double real_stability_interval(int order, int s) {
  const double epsilon = static_cast<double>(damping_numerator(order)) / damping_denominator(order);
  const double squared = static_cast<double>(s) * s;
  return order == 1 ? (2.0 - 4.0 / 3.0 * epsilon) * squared
                    : 2.0 / 3.0 * (squared - 1.0) * (1.0 - 2.0 / 15.0 * epsilon);
}

ButcherTableau chebyshev_tableau(int order, int s) {
  ChebyshevRecurrence<Float128> recurrence;
  recurrence.set(order, s);
  const auto n = static_cast<std::size_t>(s);
  // Row j: the weights of f_0 … f_{s−1} in Y_j − y.
  std::vector<std::vector<Float128>> rows(n + 1, std::vector<Float128>(n, Float128(0)));
  for (std::size_t j = 1; j <= n; ++j) {
    for (std::size_t k = 0; k < n; ++k) {
      rows[j][k] = recurrence.mu[j] * rows[j - 1][k];
      if (j >= 2) rows[j][k] += recurrence.nu[j] * rows[j - 2][k];
    }
    rows[j][j - 1] += recurrence.mu_tilde[j];
    rows[j][0] += recurrence.gamma_tilde[j];
  }
  ButcherTableau tableau{.name = order == 1 ? "rkc1" : "rkc2",
                         .title = order == 1 ? "Runge-Kutta-Chebyshev method of order 1"
                                             : "Runge-Kutta-Chebyshev method of order 2",
                         .reference = order == 1
                                          ? "[van der Houwen, Sommeijer 1980; Hairer, Wanner 1996, IV.2]"
                                          : "[Sommeijer, Shampine, Verwer 1998; Hairer, Wanner 1996, IV.2]"};
  for (std::size_t j = 0; j < n; ++j) {
    CoefficientRow& row = tableau.A.emplace_back();
    for (std::size_t k = 0; k < j; ++k) row.emplace_back(rows[j][k]);
    tableau.b.emplace_back(rows[n][j]);
  }
  return tableau;
}

}  // namespace fw::schemes
