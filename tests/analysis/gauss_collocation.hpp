#pragma once

#include <boost/math/constants/constants.hpp>
#include <span>
#include <vector>

#include "ode/ivp.hpp"

namespace fw::analysis {

/// Gauss collocation with s stages (order 2s) in binary128 with a fixed number of equal steps and fixed-point
/// iteration: the second, unrelated method against which certified references are checked.
class GaussCollocation {
 public:
  explicit GaussCollocation(std::size_t stages) : s_(stages), nodes_(stages), weights_(stages), A_(stages) {
    for (std::size_t i = 0; i < s_; ++i) {  // Newton on the Legendre polynomial P_s, mapped to [0, 1]
      Float128 x = cos(boost::math::constants::pi<Float128>() * (Float128(i) + 0.75) / (Float128(s_) + 0.5));
      Float128 derivative = 0;
      for (int iteration = 0; iteration < 100; ++iteration) {
        Float128 before = 1, now = x;
        for (std::size_t k = 2; k <= s_; ++k) {
          const Float128 next = (Float128(2 * k - 1) * x * now - Float128(k - 1) * before) / Float128(k);
          before = now;
          now = next;
        }
        derivative = Float128(s_) * (x * now - before) / (x * x - 1);
        const Float128 correction = now / derivative;
        x -= correction;
        if (abs(correction) < 1e-33) break;
      }
      nodes_[i] = (1 + x) / 2;
      weights_[i] = 1 / ((1 - x * x) * derivative * derivative);
    }
    // a_ij = ∫_0^{c_i} ℓ_j, exact by the quadrature itself since ℓ_j has degree s − 1.
    for (std::size_t i = 0; i < s_; ++i) {
      A_[i].assign(s_, 0);
      for (std::size_t j = 0; j < s_; ++j) {
        for (std::size_t m = 0; m < s_; ++m) {
          Float128 lagrange = 1;
          for (std::size_t l = 0; l < s_; ++l) {
            if (l != j) lagrange *= (nodes_[i] * nodes_[m] - nodes_[l]) / (nodes_[j] - nodes_[l]);
          }
          A_[i][j] += nodes_[i] * weights_[m] * lagrange;
        }
      }
    }
  }

  std::vector<Float128> integrate(const Ivp& ivp, double end, int steps) const {
    std::vector<Float128> y = initial_state_extended(ivp);
    const std::size_t n = y.size();
    const Float128 h = (Float128(end) - ivp.t0) / steps;
    std::vector<std::vector<Float128>> slope(s_, std::vector<Float128>(n, 0));
    std::vector<Float128> argument(n);
    for (int step = 0; step < steps; ++step) {
      const Float128 t = ivp.t0 + step * h;
      Float128 change_before = 1e300;
      for (int iteration = 0; iteration < 300; ++iteration) {
        Float128 change = 0;
        for (std::size_t i = 0; i < s_; ++i) {
          argument = y;
          for (std::size_t j = 0; j < s_; ++j) {
            for (std::size_t c = 0; c < n; ++c) argument[c] += h * A_[i][j] * slope[j][c];
          }
          std::vector<Float128> fresh(n);
          ivp.system->rhs(t + nodes_[i] * h, argument, std::span<Float128>(fresh));
          for (std::size_t c = 0; c < n; ++c)
            change = std::max(change, Float128(abs(fresh[c] - slope[i][c])));
          slope[i] = std::move(fresh);
        }
        if (change == 0 || (change < 1e-25 && change >= change_before)) break;  // at the rounding floor
        change_before = change;
      }
      for (std::size_t j = 0; j < s_; ++j) {
        for (std::size_t c = 0; c < n; ++c) y[c] += h * weights_[j] * slope[j][c];
      }
    }
    return y;
  }

 private:
  std::size_t s_;
  std::vector<Float128> nodes_, weights_;
  std::vector<std::vector<Float128>> A_;
};

}  // namespace fw::analysis
