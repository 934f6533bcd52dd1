#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "random_model.hpp"

namespace fw::mechanics {
namespace {

constexpr double tolerance = 1e-12;

/// Both tangents against complex steps: the check that every analytic derivative has to pass, and that the
/// printed and the crippled formulas below must fail.
void expect_exact_tangents(const MassSpringModel& model, const State& state) {
  const MassSpringSystem system(model);
  const auto [K, D] = complex_step_tangents(model, state);
  EXPECT_LE(relative_deviation(dense_stiffness(system, state), K), tolerance);
  EXPECT_LE(relative_deviation(dense_damping(system, state), D), tolerance);
}

TEST(Tangent, OfOneSpringAgreesWithComplexStepsInEveryLawAndLength) {
  RandomModels random(20260201);
  for (const SpringLaw law : all_laws) {
    for (const bool damped : {false, true}) {
      int compressed = 0;
      for (int trial = 0; trial < 300; ++trial) {
        const MassSpringModel model = random.network(law, 2, 1, damped);
        const State state = random.state(model);
        compressed += (state.q.head(3) - state.q.tail(3)).norm() < model.springs.rest_length[0];
        expect_exact_tangents(model, state);
      }
      EXPECT_GT(compressed, 50);
      EXPECT_LT(compressed, 250);
    }
  }
}

TEST(Tangent, OfAnchorsDragAndEachObstacleAgreesWithComplexSteps) {
  RandomModels random(20260202);
  for (int element = 0; element < 5; ++element) {
    int active = 0;
    for (int trial = 0; trial < 300; ++trial) {
      MassSpringModel model;
      model.mass = {random.uniform(0.2, 3.0)};
      if (element == 0) model.drag = 0.7;
      if (element == 1) model.anchors = {{0, random.point(1.0), 20.0, 1.5}};
      if (element == 2) model.obstacles = {{Plane{random.point(0.2), random.direction()}, 50.0, 10.0}};
      if (element == 3) model.obstacles = {{Sphere{random.point(0.5), 1.1}, 50.0, 10.0}};
      if (element == 4) model.obstacles = {{Box{{-0.8, -0.9, -1.0}, {0.9, 1.0, 0.8}}, 50.0, 10.0}};
      const State state = random.state(model);
      active += force_of(MassSpringSystem(model), state).norm() > 0.0;
      expect_exact_tangents(model, state);
    }
    EXPECT_GE(active, element < 2 ? 300 : 50) << element;
    if (element >= 2) {
      EXPECT_LE(active, 280) << element;  // outside or clamped, too
    }
  }
}

TEST(Tangent, OfEverythingTogetherAgreesWithComplexSteps) {
  RandomModels random(20260203);
  for (const SpringLaw law : all_laws) {
    for (int trial = 0; trial < 40; ++trial) {
      const MassSpringModel model = random.everything(law);
      expect_exact_tangents(model, random.state(model));
    }
  }
}

TEST(Jacobian, AgreesWithComplexStepsOfTheRightHandSide) {
  RandomModels random(20260204);
  for (const SpringLaw law : all_laws) {
    for (int trial = 0; trial < 20; ++trial) {
      const MassSpringSystem system(random.everything(law));
      const Vector y = random.state(system.model()).stacked();
      SparseMatrix J = system.jacobian_pattern();
      system.jacobian(0.0, y, J);
      Matrix oracle(y.size(), y.size());
      std::vector<Complex> state(y.begin(), y.end()), slope(state.size());
      for (Index j = 0; j < y.size(); ++j) {
        state[static_cast<std::size_t>(j)].imag(1e-200);
        system.rhs(0.0, std::span<const Complex>(state), std::span<Complex>(slope));
        state[static_cast<std::size_t>(j)].imag(0.0);
        for (Index i = 0; i < y.size(); ++i)
          oracle(i, j) = slope[static_cast<std::size_t>(i)].imag() / 1e-200;
      }
      EXPECT_LE(relative_deviation(J, oracle), tolerance);
    }
  }
}

TEST(Jacobian, ProductWithoutAssemblyAgreesWithTheAssembledMatrixToRounding) {
  RandomModels random(20260205);
  for (const SpringLaw law : all_laws) {
    for (int trial = 0; trial < 40; ++trial) {
      const MassSpringSystem system(random.everything(law));
      const State state = random.state(system.model());
      const Vector y = state.stacked();
      const Vector direction = random.vector(y.size(), 1.0);
      SparseMatrix J = system.jacobian_pattern();
      system.jacobian(0.0, y, J);
      Vector product(y.size());
      system.jacobian_product(0.0, y, direction, product);
      const Vector row_sums = J.cwiseAbs() * Vector::Ones(y.size());
      EXPECT_LE((product - J * direction).cwiseAbs().maxCoeff(), 1e-15 * row_sums.maxCoeff());

      const Index n = state.q.size();
      Vector df(n);
      system.tangent_product(0.0, state.q, state.v, direction.head(n), direction.tail(n), df);
      const Vector assembled = dense_stiffness(system, state) * direction.head(n) +
                               dense_damping(system, state) * direction.tail(n);
      EXPECT_LE((df - assembled).cwiseAbs().maxCoeff(),
                1e-15 * row_sums.maxCoeff() * system.mass().maxCoeff());
    }
  }
}

/// K of one undamped Hooke spring (0, 1) from its 3×3 blocks.
Matrix from_blocks(const Matrix3& ii, const Matrix3& ij, const Matrix3& ji, const Matrix3& jj) {
  Matrix K(6, 6);
  K << ii, ij, ji, jj;
  return K;
}

/// Smallest deviation of an alternative formula over random single springs, as `expect_exact_tangents` sees
/// it.
template <class Formula>
double least_deviation(bool damped, Formula formula) {
  RandomModels random(20260206);
  double smallest = 1e300;
  for (int trial = 0; trial < 100; ++trial) {
    const MassSpringModel model = random.network(SpringLaw::hooke, 2, 1, damped);
    const State state = random.state(model);
    const auto K = complex_step_tangents(model, state).first;
    const int i = model.springs.first[0];
    const int j = model.springs.second[0];
    const Eigen::Vector3d d = state.q.segment<3>(3 * j) - state.q.segment<3>(3 * i);
    smallest =
        std::min(smallest,
                 relative_deviation(formula(d, model.springs.stiffness[0], model.springs.rest_length[0]), K));
  }
  return smallest;
}

TEST(TangentCheck, PassesTheCorrectedFormulaAndFailsErrataE1AndE2AsPrinted) {
  const Matrix3 I = Matrix3::Identity();
  const auto block = [&](const Eigen::Vector3d& d, double k, double rest_length, double factor) -> Matrix3 {
    const double L = d.norm();
    return k * (-I + rest_length / L * I + factor * rest_length / (L * L * L) * d * d.transpose());
  };
  EXPECT_LE(least_deviation(false,
                            [&](const Eigen::Vector3d& d, double k, double rest_length) {
                              const Matrix3 ii = block(d, k, rest_length, -1.0);
                              return from_blocks(ii, -ii, -ii, ii);
                            }),
            tolerance);
  // E1 [Zachmann 2011, S28, S30]: +2 d dᵀ in place of −d dᵀ.
  EXPECT_GE(least_deviation(false,
                            [&](const Eigen::Vector3d& d, double k, double rest_length) {
                              const Matrix3 ii = block(d, k, rest_length, 2.0);
                              return from_blocks(ii, -ii, -ii, ii);
                            }),
            0.1);
  // E2 [Zachmann 2011, S29]: K_ij = −K_ji.
  EXPECT_GE(least_deviation(false,
                            [&](const Eigen::Vector3d& d, double k, double rest_length) {
                              const Matrix3 ii = block(d, k, rest_length, -1.0);
                              return from_blocks(ii, -ii, ii, ii);
                            }),
            0.1);
}

TEST(TangentCheck, CatchesAMissingGeometricStiffness) {
  EXPECT_GE(least_deviation(false,
                            [](const Eigen::Vector3d& d, double k, double) {
                              const Matrix3 axial = k * d * d.transpose() / d.squaredNorm();
                              return from_blocks(-axial, axial, axial, -axial);
                            }),
            1e-3);
}

TEST(TangentCheck, CatchesAMissingDamperInTheStiffness) {
  EXPECT_GE(least_deviation(true,
                            [](const Eigen::Vector3d& d, double k, double rest_length) {
                              MassSpringModel undamped;
                              undamped.mass = {1.0, 1.0};
                              undamped.springs = {{0}, {1}, {k}, {0.0}, {rest_length}, SpringLaw::hooke};
                              State state{Vector::Zero(6), Vector::Zero(6)};
                              state.q.tail(3) = d;
                              return dense_stiffness(MassSpringSystem(undamped), state);
                            }),
            1e-5);
}

}  // namespace
}  // namespace fw::mechanics
