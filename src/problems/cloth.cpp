#include "problems/cloth.hpp"

#include <cmath>
#include <memory>

#include "mechanics/grid.hpp"
#include "mechanics/mass_spring_system.hpp"
#include "problems/parameter.hpp"
#include "problems/spectral_radius.hpp"

namespace fw::problems {

namespace {

using mechanics::MassSpringModel;

/// Side length of the cloth [m].
constexpr double side = 1.0;

/// Joins every point (i, j) to (i + di, j + dj), where both exist, at the distance of the flat cloth.
void add_springs(MassSpringModel& model, int count, int di, int dj, double stiffness, double damping) {
  const double spacing = side / (count - 1);
  const mechanics::Grid grid{{count, count, 1}};
  grid.for_each_point([&](int i, int j, int k) {
    const int other = grid.neighbour(i, j, k, {di, dj, 0});
    if (other < 0) return;
    model.springs.add(grid.index(i, j, k), other,
                      {stiffness, damping, spacing * std::sqrt(di * di + dj * dj)});
  });
}

}  // namespace

ProblemEntry cloth_entry() {
  return {"small_cloth",
          {{"count", 4.0}, {"mass", 0.05}, {"stiffness", 30.0}, {"damping", 0.02}, {"gravity", 9.81}},
          cloth};
}

Problem cloth(const ProblemParameters& given) {
  const ParameterSet parameters(cloth_entry(), given);
  const int count = parameters.whole("count", 2, 40);
  const double mass = parameters.positive("mass").binary();
  const double stiffness = parameters.positive("stiffness").binary();
  const double damping = parameters.non_negative("damping").binary();

  MassSpringModel model;
  model.mass.assign(static_cast<std::size_t>(count * count), mass);
  model.gravity = {0.0, 0.0, -parameters["gravity"].binary()};
  model.fixed = {0, count - 1};
  for (auto [di, dj] : {std::pair{1, 0}, {0, 1}}) add_springs(model, count, di, dj, stiffness, damping);
  for (auto [di, dj] : {std::pair{1, 1}, {-1, 1}})
    add_springs(model, count, di, dj, stiffness / 4, damping / 4);
  for (auto [di, dj] : {std::pair{2, 0}, {0, 2}})
    add_springs(model, count, di, dj, stiffness / 16, damping / 16);

  const int n = count * count;
  Vector y0 = Vector::Zero(6 * n);
  for (int j = 0; j < count; ++j) {
    for (int i = 0; i < count; ++i) {
      // Slightly curved, so that nothing starts in a plane.
      const double x = side * i / (count - 1), y = side * j / (count - 1);
      store3(y0.data(), i + count * j, Vec3<double>{x, y, 0.125 * x * y});
    }
  }

  Problem problem;
  problem.name = "small_cloth";
  problem.title = "Small hanging cloth";
  problem.description =
      "count x count points on a square of 1 m with structural springs k, shear springs k/4 and bend springs "
      "k/16 "
      "(dampers alike), held at two corners, at rest at z = x y/8 m on [0, 0.73]. Stiffness: measured along "
      "the "
      "solution.";
  problem.source = "Zachmann 2011, S5-S7, S37; Provot 1995";
  auto system = std::make_shared<const mechanics::MassSpringSystem>(std::move(model));
  problem.ivp = {system, 0.0, 0.73, y0, {}};
  if (damping == 0.0) {
    problem.invariants = {{"energy", "J", [system, n](double, ConstVectorRef y) {
                             return system->energies(y.head(3 * n), y.tail(3 * n)).total();
                           }}};
  }
  problem.stiffness = [ivp = problem.ivp] { return spectral_radius_along_solution(ivp); };
  problem.parameters = parameters.text();
  return problem;
}

}  // namespace fw::problems
