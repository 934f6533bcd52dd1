#include "study/jacobian/jacobian_states.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>

namespace fw::study {

namespace {

using mechanics::MassSpringModel;
using mechanics::MassSpringSystem;

class RandomNumbers {
 public:
  explicit RandomNumbers(std::int64_t seed) : generator_(static_cast<std::uint64_t>(seed)) {}
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator_);
  }
  void fill(VectorRef values, double half_width) {
    for (double& value : values) value = uniform(-half_width, half_width);
  }

 private:
  std::mt19937_64 generator_;
};

const MassSpringSystem* springs_of(const OdeSystem& system) {
  return dynamic_cast<const MassSpringSystem*>(&system);
}

}  // namespace

std::vector<JacobianSample> random_springs(const SpringSampling& sampling, std::int64_t count,
                                           std::int64_t seed) {
  RandomNumbers random(seed);
  std::vector<JacobianSample> samples;
  for (std::int64_t k = 0; k < count; ++k) {
    MassSpringModel model;
    model.mass = {random.uniform(0.2, 3.0), random.uniform(0.2, 3.0)};
    const double stiffness = random.uniform(1.0, 100.0), damping = random.uniform(0.1, 5.0);
    model.springs = {
        {0},         {1}, {stiffness}, {sampling.is_damped ? damping : 0.0}, {random.uniform(0.3, 2.0)},
        sampling.law};
    Vector y(12);
    do {
      random.fill(y.head(6), 0.6);
    } while ((y.segment<3>(3) - y.segment<3>(0)).norm() < 0.2);
    random.fill(y.tail(6), 2.0);
    samples.push_back({std::make_shared<MassSpringSystem>(std::move(model)), 0.0, std::move(y)});
  }
  return samples;
}

std::vector<JacobianSample> displaced_states(const Ivp& ivp, std::int64_t count, double displacement,
                                             std::int64_t seed) {
  RandomNumbers random(seed);
  const SecondOrderSystem* mechanics = ivp.system->second_order();
  std::vector<JacobianSample> samples;
  for (std::int64_t k = 0; k < count; ++k) {
    Vector change(ivp.y0.size());
    random.fill(change, displacement);
    if (mechanics != nullptr) {
      const Index n = mechanics->degrees_of_freedom();
      for (Index c = 0; c < n; ++c) {
        if (mechanics->fixed()[static_cast<std::size_t>(c)] != 0) change[c] = change[n + c] = 0.0;
      }
    }
    samples.push_back({ivp.system, ivp.t0, ivp.y0 + change});
  }
  return samples;
}

double typical_length(const OdeSystem& system) {
  const MassSpringSystem* springs = springs_of(system);
  if (springs == nullptr || springs->model().springs.size() == 0) return 1.0;
  const std::vector<double>& lengths = springs->model().springs.rest_length;
  const double mean =
      std::accumulate(lengths.begin(), lengths.end(), 0.0) / static_cast<double>(lengths.size());
  return mean > 0.0 ? mean : 1.0;
}

Ivp compressed(Ivp ivp, const Compression& start) {
  const SecondOrderSystem& system = *ivp.system->second_order();
  const Index n = system.degrees_of_freedom();
  RandomNumbers random(start.seed);
  const Index dimensions = n % 3 == 0 ? 3 : 1;
  Vector centre = Vector::Zero(dimensions);
  for (Index c = 0; c < n; ++c) {
    const double change = random.uniform(-start.displacement, start.displacement);
    if (system.fixed()[static_cast<std::size_t>(c)] == 0) ivp.y0[c] += change;
    centre[c % dimensions] += ivp.y0[c] * static_cast<double>(dimensions) / static_cast<double>(n);
  }
  for (Index c = 0; c < n; ++c) {
    const double position = start.compression * (ivp.y0[c] - centre[c % dimensions]);
    ivp.y0[c] = centre[c % dimensions] + position;
    const double added = random.uniform(-start.speed, start.speed);
    const bool is_fixed = system.fixed()[static_cast<std::size_t>(c)] != 0;
    ivp.y0[n + c] = is_fixed ? 0.0 : added - start.closing_rate * position;
  }
  ivp.y0_extended.clear();
  return ivp;
}

double least_length_ratio(const OdeSystem& system, ConstVectorRef y) {
  const MassSpringSystem* springs = springs_of(system);
  double least = std::numeric_limits<double>::infinity();
  if (springs != nullptr) {
    const mechanics::Springs& list = springs->model().springs;
    for (std::size_t e = 0; e < list.size(); ++e) {
      const double length = (y.segment<3>(3 * list.second[e]) - y.segment<3>(3 * list.first[e])).norm();
      if (list.rest_length[e] > 0.0) least = std::min(least, length / list.rest_length[e]);
    }
  }
  return std::isfinite(least) ? least : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace fw::study
