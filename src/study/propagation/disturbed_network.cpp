#include "study/propagation/disturbed_network.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <utility>

#include "core/error.hpp"
#include "mechanics/mass_spring_system.hpp"

namespace fw::study {

namespace {

using Edges = std::vector<std::pair<int, int>>;

/// Breadth first from `start`, never through a mass that cannot move.
std::vector<int> distances(Index masses, const Edges& springs, const std::vector<int>& fixed, Index start) {
  std::vector<std::vector<int>> neighbours(static_cast<std::size_t>(masses));
  for (const auto& [i, j] : springs) {
    neighbours[static_cast<std::size_t>(i)].push_back(j);
    neighbours[static_cast<std::size_t>(j)].push_back(i);
  }
  std::vector<char> holds(static_cast<std::size_t>(masses), 0);
  for (const int i : fixed) holds[static_cast<std::size_t>(i)] = 1;
  std::vector<int> distance(static_cast<std::size_t>(masses), -1);
  distance[static_cast<std::size_t>(start)] = 0;
  std::deque<int> queue = {static_cast<int>(start)};
  while (!queue.empty()) {
    const auto i = static_cast<std::size_t>(queue.front());
    queue.pop_front();
    for (const int j : neighbours[i]) {
      const auto k = static_cast<std::size_t>(j);
      if (distance[k] >= 0 || holds[k]) continue;
      distance[k] = distance[i] + 1;
      queue.push_back(j);
    }
  }
  return distance;
}

void require_rest(const DisturbedNetwork& network) {
  const SecondOrderSystem& mechanics = *network.ivp.system->second_order();
  const Index n = mechanics.degrees_of_freedom();
  Vector force(n);
  mechanics.force(network.ivp.t0, network.rest, Vector::Zero(n), force);
  Index where = 0;
  if (const double largest = force.cwiseAbs().maxCoeff(&where); largest != 0.0) {
    throw InputError(
        fmt::format("problem \"{}\": force {:.3g} N on mass {} at rest, expected exactly none (no gravity, "
                    "springs of their rest length)",
                    network.label, largest, where / network.coordinates));
  }
}

}  // namespace

DisturbedNetwork disturb(const StudyProblem& problem, std::int64_t mass, bool kick, double size,
                         const Vec3<double>& direction) {
  DisturbedNetwork network;
  network.label = problem.label;
  network.identity = problem.identity;
  network.ivp = problem.problem.ivp;
  network.is_kicked = kick;
  const auto* scene = dynamic_cast<const mechanics::MassSpringSystem*>(network.ivp.system.get());
  const bool is_chain = problem.problem.test_equation == TestEquation::spring_chain;
  if (!is_chain && scene == nullptr) {
    throw InputError(fmt::format("problem \"{}\": expected \"linear_chain\" or a scene", problem.label));
  }
  const Index n = network.ivp.system->second_order()->degrees_of_freedom();
  network.coordinates = is_chain ? 1 : 3;
  const Index masses = n / network.coordinates;
  network.disturbed = mass < 0 ? (masses - 1) / 2 : mass;
  if (network.disturbed >= masses) {
    throw InputError(fmt::format("problem \"{}\": found mass {}, expected an index below {}", problem.label,
                                 mass, masses));
  }

  network.rest = is_chain ? Vector(Vector::Zero(n)) : Vector(network.ivp.y0.head(n));
  network.ivp.y0.setZero();
  network.ivp.y0.head(n) = network.rest;
  network.ivp.y0_extended.clear();
  require_rest(network);
  const Index first = (kick ? n : 0) + network.coordinates * network.disturbed;
  if (is_chain) {
    network.ivp.y0[first] += size;
  } else {
    const double length = norm(direction);
    network.ivp.y0.segment<3>(first) +=
        size / length * Eigen::Vector3d(direction.x, direction.y, direction.z);
  }

  Edges springs;
  std::vector<int> fixed;
  network.wave_speed = std::numeric_limits<double>::quiet_NaN();
  if (is_chain) {
    for (int i = 0; i + 1 < static_cast<int>(masses); ++i) springs.emplace_back(i, i + 1);
    // A unit displacement of one mass stretches two springs: f = −2k.
    const SecondOrderSystem& mechanics = *network.ivp.system->second_order();
    Vector force(n);
    mechanics.force(0.0, Vector::Unit(n, network.disturbed), Vector::Zero(n), force);
    network.wave_speed = std::sqrt(-0.5 * force[network.disturbed] / mechanics.mass()[0]);
  } else {
    const mechanics::Springs& given = scene->model().springs;
    for (std::size_t e = 0; e < given.size(); ++e) springs.emplace_back(given.first[e], given.second[e]);
    network.has_dampers =
        std::any_of(given.damping.begin(), given.damping.end(), [](double c) { return c > 0.0; });
    fixed = scene->model().fixed;
    if (std::find(fixed.begin(), fixed.end(), static_cast<int>(network.disturbed)) != fixed.end()) {
      throw InputError(fmt::format("problem \"{}\": mass {} is fixed, expected one that moves", problem.label,
                                   network.disturbed));
    }
  }
  network.distance = distances(masses, springs, fixed, network.disturbed);
  network.farthest = *std::max_element(network.distance.begin(), network.distance.end());
  return network;
}

}  // namespace fw::study
