#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "random_model.hpp"

namespace fw::mechanics {
namespace {

double asymmetry(const Matrix& K) {
  return relative_deviation(K.transpose(), K);
}

/// Smallest eigenvalue of the symmetric part of −K over the largest in magnitude.
double least_relative_eigenvalue(const Matrix& K) {
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(-0.5 * (K + K.transpose()), Eigen::EigenvaluesOnly);
  return solver.eigenvalues().minCoeff() / solver.eigenvalues().cwiseAbs().maxCoeff();
}

/// All elements, no fixed particles (their zeroed rows make K unsymmetric).
MassSpringModel free_everything(RandomModels& random, SpringLaw law) {
  MassSpringModel model = random.everything(law);
  model.fixed.clear();
  return model;
}

TEST(PsdProjection, MakesMinusKSymmetricPositiveSemidefinite) {
  RandomModels random(20260301);
  for (const SpringLaw law : all_laws) {
    for (int trial = 0; trial < 40; ++trial) {
      const MassSpringModel model = free_everything(random, law);
      const State state = random.state(model);
      const Matrix K = dense_stiffness(MassSpringSystem(model), state, TangentModel::psd_projection);
      EXPECT_LE(asymmetry(K), 1e-15);
      EXPECT_GE(least_relative_eigenvalue(K), -1e-14);
    }
  }
}

TEST(PsdProjection, IsTheEigenvalueClampedBlockOfAnUndampedSpring) {
  RandomModels random(20260302);
  for (const SpringLaw law : all_laws) {
    int clamped = 0;
    for (int trial = 0; trial < 100; ++trial) {
      const MassSpringModel model = random.network(law, 2, 1, false);
      const State state = random.state(model);
      const MassSpringSystem system(model);
      const Matrix exact = -dense_stiffness(system, state).topLeftCorner(3, 3);
      const Eigen::SelfAdjointEigenSolver<Matrix> solver(exact);
      clamped += solver.eigenvalues().minCoeff() < -1e-3;
      const Matrix projected = solver.eigenvectors() * solver.eigenvalues().cwiseMax(0.0).asDiagonal() *
                               solver.eigenvectors().transpose();
      const Matrix found = -dense_stiffness(system, state, TangentModel::psd_projection).topLeftCorner(3, 3);
      EXPECT_LE((found - projected).cwiseAbs().maxCoeff(), 1e-13 * exact.cwiseAbs().maxCoeff());
    }
    // A slack rope has no stiffness at all, hence nothing to clamp.
    EXPECT_EQ(clamped > 20, law != SpringLaw::tension_only);
  }
}

TEST(ExactTangent, IsIndefiniteWhereASpringIsCompressed) {
  for (const SpringLaw law : {SpringLaw::hooke, SpringLaw::strain}) {
    MassSpringModel model;
    model.mass = {1.0, 1.0};
    model.springs = {{0}, {1}, {10.0}, {0.0}, {2.0}, law};
    const MassSpringSystem system(model);
    State state{Vector::Zero(6), Vector::Zero(6)};
    state.q[3] = 1.0;  // half its rest length: σ/L = −k in both transverse directions
    EXPECT_NEAR(least_relative_eigenvalue(dense_stiffness(system, state)), -1.0, 1e-14);
    for (const auto tangent : {TangentModel::tensile_geometric_term, TangentModel::psd_projection}) {
      EXPECT_GE(least_relative_eigenvalue(dense_stiffness(system, state, tangent)), -1e-15);
    }
  }
}

TEST(TensileGeometricTerm, IsSemidefiniteForUndampedSpringsAndKeepsTheDampersPart) {
  RandomModels random(20260303);
  for (const SpringLaw law : all_laws) {
    for (int trial = 0; trial < 20; ++trial) {
      MassSpringModel model = random.network(law, 6, 12, true);
      const State state = random.state(model);
      const Matrix exact = dense_stiffness(MassSpringSystem(model), state);
      const Matrix tensile =
          dense_stiffness(MassSpringSystem(model), state, TangentModel::tensile_geometric_term);
      for (double& damping : model.springs.damping) damping = 0.0;
      const MassSpringSystem undamped(model);
      const Matrix elastic_exact = dense_stiffness(undamped, state);
      const Matrix elastic = dense_stiffness(undamped, state, TangentModel::tensile_geometric_term);
      EXPECT_LE(asymmetry(elastic), 1e-15);
      EXPECT_GE(least_relative_eigenvalue(elastic), -1e-14);
      EXPECT_GT(asymmetry(tensile), 1e-3);
      EXPECT_LE(relative_deviation(tensile - elastic, exact - elastic_exact), 1e-12);
    }
  }
}

TEST(TangentModels, AreTheSameMatrixWhenEverySpringIsStretchedAndNothingDamps) {
  RandomModels random(20260304);
  for (const SpringLaw law : all_laws) {
    MassSpringModel model = random.network(law, 6, 12, false);
    const State state = random.state(model);
    for (std::size_t e = 0; e < model.springs.size(); ++e) {
      const double length = norm(load3(state.q.data(), model.springs.second[e]) -
                                 load3(state.q.data(), model.springs.first[e]));
      model.springs.rest_length[e] = random.uniform(0.2, 0.99) * length;
    }
    const MassSpringSystem system(model);
    const Matrix exact = dense_stiffness(system, state);
    EXPECT_EQ(exact, dense_stiffness(system, state, TangentModel::tensile_geometric_term));
    EXPECT_EQ(exact, dense_stiffness(system, state, TangentModel::psd_projection));
  }
}

TEST(TangentModels, DifferWhereTheyAreMeantTo) {
  RandomModels random(20260305);
  const MassSpringModel model = free_everything(random, SpringLaw::hooke);
  const MassSpringSystem system(model);
  const State state = random.state(model);
  const Matrix exact = dense_stiffness(system, state);
  const Matrix tensile = dense_stiffness(system, state, TangentModel::tensile_geometric_term);
  const Matrix projected = dense_stiffness(system, state, TangentModel::psd_projection);
  EXPECT_GT(relative_deviation(tensile, exact), 1e-2);
  EXPECT_GT(relative_deviation(projected, exact), 1e-2);
  EXPECT_GT(relative_deviation(projected, tensile), 1e-2);
}

TEST(TangentModels, LeaveForceDampingAndProductsAlone) {
  RandomModels random(20260306);
  const MassSpringModel model = random.everything(SpringLaw::hooke);
  const MassSpringSystem system(model);
  const State state = random.state(model);
  const Vector y = state.stacked(), w = random.vector(y.size(), 1.0);
  const auto snapshot = [&] {
    Vector product(y.size());
    system.jacobian_product(0.0, y, w, product);
    SparseMatrix J = system.jacobian_pattern();
    system.jacobian(0.0, y, J);
    const Matrix dense = J;
    return std::tuple(force_of(system, state), dense_damping(system, state), product, dense);
  };
  const auto before = snapshot();
  for (const auto tangent :
       {TangentModel::exact, TangentModel::tensile_geometric_term, TangentModel::psd_projection}) {
    dense_stiffness(system, state, tangent);
    EXPECT_EQ(snapshot(), before);
  }
}

}  // namespace
}  // namespace fw::mechanics
