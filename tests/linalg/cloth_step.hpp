#pragma once

#include <cmath>
#include <random>
#include <tuple>
#include <utility>

#include "integrators/implicit/step_matrix.hpp"
#include "mechanics/mass_spring_system.hpp"

namespace fw::linalg {

/// One linearised implicit Euler step on a hanging cloth of count × count points.
struct ClothStep {
  SparseMatrix matrix;
  Vector right_side;
  Vector coordinates;
};

/// A cloth of 1 m² with structural, shear and bend springs, held at two corners, slightly curved and then
/// moved by random 0.1 mm.
inline ClothStep cloth_step(int count, double stiffness, double step) {
  mechanics::MassSpringModel model;
  model.mass.assign(static_cast<std::size_t>(count * count), 0.05);
  model.gravity = {0.0, 0.0, -9.81};
  model.fixed = {0, count - 1};
  const double spacing = 1.0 / (count - 1);
  for (const auto& [di, dj, k] :
       {std::tuple{1, 0, 1.0}, {0, 1, 1.0}, {1, 1, 0.25}, {-1, 1, 0.25}, {2, 0, 0.0625}, {0, 2, 0.0625}}) {
    for (int j = 0; j + dj < count; ++j) {
      for (int i = 0; i < count; ++i) {
        if (i + di < 0 || i + di >= count) continue;
        model.springs.first.push_back(i + count * j);
        model.springs.second.push_back(i + di + count * (j + dj));
        model.springs.stiffness.push_back(k * stiffness);
        model.springs.damping.push_back(0.02 * k);
        model.springs.rest_length.push_back(spacing * std::hypot(di, dj));
      }
    }
  }
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  const Index n = 3 * count * count;
  ClothStep result;
  result.coordinates.resize(n);
  for (int p = 0; p < count * count; ++p) {
    const double x = spacing * (p % count), y = spacing * (p / count);
    result.coordinates.segment<3>(3 * p) << x, y, 0.125 * x * y;
  }
  Vector q = result.coordinates;
  for (Index i = 0; i < n; ++i) q[i] += 1e-4 * normal(random);
  const mechanics::MassSpringSystem system(std::move(model));
  integrators::StepMatrix matrix(system);
  result.matrix = matrix.assemble_symmetric(0.0, q, Vector::Zero(n), step, TangentModel::psd_projection);
  result.right_side.resize(n);
  system.force(0.0, q, Vector::Zero(n), result.right_side);
  result.right_side *= step;
  return result;
}

}  // namespace fw::linalg
