#include "constraints/distance_constraints.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/error.hpp"

namespace fw::constraints {

DistanceConstraints::DistanceConstraints(const SecondOrderSystem& system,
                                         std::vector<DistanceConstraint> constraints)
    : list_(std::move(constraints)) {
  const Index n = system.degrees_of_freedom();
  if (n % 3 != 0) {
    throw InputError(
        fmt::format("distance constraints: found {} degrees of freedom, expected three per particle", n));
  }
  for (const char fixed : system.fixed()) is_free_.push_back(fixed ? 0 : 1);
  for (std::size_t c = 0; c < list_.size(); ++c) {
    const auto& [first, second, length] = list_[c];
    for (const int particle : {first, second}) {
      if (particle < 0 || particle >= n / 3) {
        throw InputError(
            fmt::format("constraint[{}]: found particle {}, expected an index below {}", c, particle, n / 3));
      }
    }
    if (first == second) {
      throw InputError(fmt::format("constraint[{}]: both ends are particle {}", c, first));
    }
    if (!is_free_[static_cast<std::size_t>(3 * first)] && !is_free_[static_cast<std::size_t>(3 * second)]) {
      throw InputError(fmt::format("constraint[{}]: particles {} and {} are both fixed", c, first, second));
    }
    if (!(length > 0.0) || !std::isfinite(length)) {
      throw InputError(
          fmt::format("constraint[{}]: found length {}, expected a finite number > 0", c, length));
    }
  }
}

void DistanceConstraints::value(ConstVectorRef q, VectorRef g) const {
  for (std::size_t c = 0; c < list_.size(); ++c) {
    const auto& [first, second, length] = list_[c];
    const Vec3<double> d = load3(q.data(), second) - load3(q.data(), first);
    // (‖d‖ − L)(‖d‖ + L)/(2L), which loses no digits near zero
    const double distance = norm(d);
    g[static_cast<Index>(c)] = (distance - length) * (distance + length) / (2.0 * length);
  }
}

void DistanceConstraints::product(ConstVectorRef q, ConstVectorRef w, VectorRef out) const {
  out.setZero();
  for_each_derivative(q, [&](Index c, Index i, double slope) { out[c] += slope * w[i]; });
}

void DistanceConstraints::add_transposed_product(ConstVectorRef q, ConstVectorRef lambda,
                                                 VectorRef out) const {
  for_each_derivative(q, [&](Index c, Index i, double slope) { out[i] += slope * lambda[c]; });
}

}  // namespace fw::constraints
