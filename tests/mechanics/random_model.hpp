#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "core/types.hpp"
#include "mechanics/mass_spring_system.hpp"
#include "mechanics/model_elements.hpp"

namespace fw::mechanics {

inline constexpr SpringLaw all_laws[] = {SpringLaw::hooke, SpringLaw::strain, SpringLaw::tension_only};

/// A state of a mass-spring system.
struct State {
  Vector q, v;

  Vector stacked() const {
    Vector y(q.size() + v.size());
    y << q, v;
    return y;
  }
};

/// Random models and states from a named seed. Lengths are about 1 m and rest lengths between 0.3 and 2 m, so
/// that about half of the springs are compressed.
class RandomModels {
 public:
  explicit RandomModels(std::uint64_t seed) : generator_(seed) {}

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator_);
  }
  int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(generator_); }
  Vec3<double> point(double half_width) {
    return {uniform(-half_width, half_width), uniform(-half_width, half_width),
            uniform(-half_width, half_width)};
  }
  Vec3<double> direction() {
    Vec3<double> a = point(1.0);
    while (norm(a) < 0.1) a = point(1.0);
    return (1.0 / norm(a)) * a;
  }
  Vector vector(Index size, double half_width) {
    Vector result(size);
    for (Index c = 0; c < size; ++c) result[c] = uniform(-half_width, half_width);
    return result;
  }

  void add_spring(Springs& springs, int i, int j, bool damped) {
    springs.first.push_back(i);
    springs.second.push_back(j);
    springs.stiffness.push_back(uniform(1.0, 100.0));
    springs.damping.push_back(damped ? uniform(0.1, 5.0) : 0.0);
    springs.rest_length.push_back(uniform(0.3, 2.0));
  }

  /// Free particles and springs between random pairs; pairs repeat and some particles may have no spring.
  MassSpringModel network(SpringLaw law, int particles, int springs, bool damped) {
    MassSpringModel model;
    for (int i = 0; i < particles; ++i) model.mass.push_back(uniform(0.2, 3.0));
    model.springs.law = law;
    for (int e = 0; e < springs; ++e) {
      const int i = integer(0, particles - 1);
      int j = integer(0, particles - 2);
      if (j >= i) ++j;
      add_spring(model.springs, i, j, damped);
    }
    return model;
  }

  /// A network with every force element: gravity, drag, dampers, anchors, all obstacles, fixed particles.
  MassSpringModel everything(SpringLaw law) {
    MassSpringModel model = network(law, 8, 16, true);
    model.gravity = point(10.0);
    model.drag = uniform(0.1, 1.0);
    model.fixed = {2, 5};
    model.anchors = {{1, point(1.0), uniform(1.0, 50.0), uniform(0.1, 2.0)},
                     {5, point(1.0), uniform(1.0, 50.0), uniform(0.1, 2.0)},
                     {1, point(1.0), uniform(1.0, 50.0), 0.0}};
    model.obstacles = {{Plane{point(0.2), direction()}, uniform(10.0, 100.0), uniform(0.1, 20.0)},
                       {Sphere{point(0.5), uniform(0.7, 1.2)}, uniform(10.0, 100.0), uniform(0.1, 20.0)},
                       {Box{{-1.0, -0.8, -1.1}, {0.6, 0.9, 0.7}}, uniform(10.0, 100.0), uniform(0.1, 20.0)}};
    return model;
  }

  /// Every force element, with springs in four groups under the three laws; one group is empty.
  MassSpringModel everything_in_groups() {
    MassSpringModel model = everything(SpringLaw::strain);
    model.springs.groups = {{"frame", SpringLaw::hooke, 5},
                            {"skin", SpringLaw::strain, 4},
                            {"none", SpringLaw::hooke, 0},
                            {"ropes", SpringLaw::tension_only, 7}};
    return model;
  }

  /// Positions in [−1, 1]³, velocities in [−2, 2]³; fixed particles stand still.
  State state(const MassSpringModel& model) {
    const auto n = static_cast<Index>(3 * model.mass.size());
    State result{vector(n, 1.0), vector(n, 2.0)};
    for (const int i : model.fixed) result.v.segment<3>(3 * i).setZero();
    return result;
  }

 private:
  std::mt19937_64 generator_;
};

/// ∂f/∂q and ∂f/∂v of the elements by complex steps, the oracle of every analytic tangent.
inline std::pair<Matrix, Matrix> complex_step_tangents(const ElementAssembly& elements, const State& state) {
  constexpr double h = 1e-200;
  const Index n = state.q.size();
  std::vector<Complex> q(state.q.begin(), state.q.end());
  std::vector<Complex> v(state.v.begin(), state.v.end());
  std::vector<Complex> f(q.size());
  const auto differentiate = [&](std::vector<Complex>& argument) {
    Matrix derivative(n, n);
    for (Index j = 0; j < n; ++j) {
      argument[static_cast<std::size_t>(j)].imag(h);
      elements.force(q.data(), v.data(), f.data());
      argument[static_cast<std::size_t>(j)].imag(0.0);
      for (Index i = 0; i < n; ++i) derivative(i, j) = f[static_cast<std::size_t>(i)].imag() / h;
    }
    return derivative;
  };
  Matrix K = differentiate(q);
  Matrix D = differentiate(v);
  return {std::move(K), std::move(D)};
}

inline std::pair<Matrix, Matrix> complex_step_tangents(const MassSpringModel& model, const State& state) {
  return complex_step_tangents(*assemble<ElementBatch>(model), state);
}

/// Largest deviation over the largest entry of the oracle.
inline double relative_deviation(const Matrix& found, const Matrix& oracle) {
  const double scale = oracle.cwiseAbs().maxCoeff();
  const double deviation = (found - oracle).cwiseAbs().maxCoeff();
  return scale > 0.0 ? deviation / scale : deviation;
}

/// Assembled K as a dense matrix.
inline Matrix dense_stiffness(const MassSpringSystem& system, const State& state,
                              TangentModel model = TangentModel::exact) {
  SparseMatrix K = system.tangent_pattern();
  system.stiffness(0.0, state.q, state.v, model, K);
  return K;
}

/// Assembled D as a dense matrix.
inline Matrix dense_damping(const MassSpringSystem& system, const State& state) {
  SparseMatrix D = system.tangent_pattern();
  system.damping(0.0, state.q, state.v, D);
  return D;
}

/// f as a vector.
inline Vector force_of(const MassSpringSystem& system, const State& state) {
  Vector f(state.q.size());
  system.force(0.0, state.q, state.v, f);
  return f;
}

}  // namespace fw::mechanics
