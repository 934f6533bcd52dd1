#include "schemes/splitting_scheme.hpp"

#include <algorithm>
#include <stdexcept>

namespace fw::schemes {

namespace {

void check(const SplittingScheme& scheme) {
  if (scheme.kick.empty() || scheme.drift.size() != scheme.kick.size() + 1) {
    throw std::logic_error("splitting scheme \"" + scheme.name + "\": expected one drift more than kicks");
  }
}

}  // namespace

std::vector<Float128> implicit_parts(const SplittingScheme& scheme) {
  check(scheme);
  std::vector<Float128> alpha(scheme.kick.size());
  Float128 beta = 0;
  for (std::size_t i = 0; i < alpha.size(); ++i) {
    alpha[i] = scheme.drift[i].value() - beta;
    beta = scheme.kick[i].value() - alpha[i];
  }
  return alpha;
}

NystromValues<Float128> as_nystrom(const SplittingScheme& scheme) {
  const std::vector<Float128> alpha = implicit_parts(scheme);
  const std::size_t s = alpha.size();
  NystromValues<Float128> result;
  result.stages = static_cast<int>(s);
  result.c.assign(s, Float128(0));
  result.a_position.assign(s * s, Float128(0));
  result.a_velocity.assign(s * s, Float128(0));
  Float128 node = 0;
  for (std::size_t i = 0; i < s; ++i) {
    node += scheme.drift[i].value();
    result.c[i] = node;
    // Kick j moves q at kick i by b_j times the drifts between them.
    for (std::size_t j = 0; j < i; ++j) {
      result.a_velocity[i * s + j] = scheme.kick[j].value();
      result.a_position[i * s + j] = scheme.kick[j].value() * (result.c[i] - result.c[j]);
    }
    result.a_velocity[i * s + i] = alpha[i];
  }
  const Float128 end = node + scheme.drift[s].value();
  for (std::size_t j = 0; j < s; ++j) {
    result.b_velocity.push_back(scheme.kick[j].value());
    result.b_position.push_back(scheme.kick[j].value() * (end - result.c[j]));
  }
  return result;
}

double uncertainty(const SplittingScheme& scheme) {
  double largest = 1e-31;
  for (const Coefficient& a : scheme.drift) largest = std::max(largest, a.uncertainty());
  for (const Coefficient& b : scheme.kick) largest = std::max(largest, b.uncertainty());
  return largest;
}

}  // namespace fw::schemes
