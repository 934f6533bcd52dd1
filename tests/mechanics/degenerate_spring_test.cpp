#include <gtest/gtest.h>

#include <cmath>

#include "random_model.hpp"

namespace fw::mechanics {
namespace {

/// Two particles at the same place under a spring, a third one a metre away.
MassSpringModel coincident_pair(SpringLaw law, double rest_length) {
  MassSpringModel model;
  model.mass = {1.0, 2.0, 3.0};
  model.springs = {{0, 1}, {1, 2}, {10.0, 10.0}, {0.5, 0.5}, {rest_length, 0.9}, law};
  return model;
}

State coincident_state() {
  State state{Vector::Zero(9), Vector::Zero(9)};
  state.q << 1, 2, 3, 1, 2, 3, 1, 2, 4;
  state.v << 1, 0, 2, 0, 3, 0, 0, 0, 1;
  return state;
}

TEST(DegenerateSpring, ExertsNoForceAndIsCountedInEveryEvaluation) {
  for (const SpringLaw law : all_laws) {
    const MassSpringSystem system(coincident_pair(law, 0.7));
    const State state = coincident_state();
    const Vector y = state.stacked();
    EXPECT_EQ(system.degenerate_spring_evaluations(), 0u);
    const Vector f = force_of(system, state);
    EXPECT_TRUE(f.head(3).isZero(0.0));
    EXPECT_GT(f.tail(3).norm(), 0.1);  // the healthy spring still acts
    EXPECT_EQ(system.degenerate_spring_evaluations(), 1u);
    Vector dydt(18);
    system.rhs(0.0, y, dydt);
    EXPECT_TRUE(dydt.allFinite());
    EXPECT_EQ(system.degenerate_spring_evaluations(), 2u);
    SparseMatrix J = system.jacobian_pattern();
    system.jacobian(0.0, y, J);
    EXPECT_TRUE(Matrix(J).allFinite());
    EXPECT_EQ(system.degenerate_spring_evaluations(), 3u);
    Vector product(18);
    system.jacobian_product(0.0, y, Vector::Ones(18), product);
    EXPECT_TRUE(product.allFinite());
    EXPECT_EQ(system.degenerate_spring_evaluations(), 4u);
    EXPECT_TRUE(std::isfinite(system.dissipated_power(state.q, state.v)));
    EXPECT_EQ(system.degenerate_spring_evaluations(), 5u);
    const std::vector<Float128> wide(y.begin(), y.end());
    std::vector<Float128> wide_slope(wide.size());
    system.rhs(Float128(0), std::span<const Float128>(wide), std::span<Float128>(wide_slope));
    EXPECT_EQ(system.degenerate_spring_evaluations(), 6u);
    for (std::size_t c = 0; c < wide.size(); ++c) {
      EXPECT_NEAR(static_cast<double>(wide_slope[c]), dydt[static_cast<Index>(c)], 1e-14);
    }
  }
}

TEST(DegenerateSpring, HasZeroBlocksInEveryTangentModel) {
  for (const SpringLaw law : all_laws) {
    const MassSpringSystem system(coincident_pair(law, 0.7));
    const State state = coincident_state();
    for (const auto tangent :
         {TangentModel::exact, TangentModel::tensile_geometric_term, TangentModel::psd_projection}) {
      const Matrix K = dense_stiffness(system, state, tangent);
      EXPECT_TRUE(K.allFinite());
      EXPECT_TRUE(K.topRows(3).isZero(0.0));
    }
    EXPECT_TRUE(dense_damping(system, state).topRows(3).isZero(0.0));
    const auto [K, D] = complex_step_tangents(system.model(), state);
    EXPECT_LE(relative_deviation(dense_stiffness(system, state), K), 1e-12);
    EXPECT_LE(relative_deviation(dense_damping(system, state), D), 1e-12);
  }
}

TEST(DegenerateSpring, StoresTheEnergyOfItsLaw) {
  const State state = coincident_state();
  const double healthy = 5.0 * 0.1 * 0.1;
  const auto elastic = [&](SpringLaw law) {
    return MassSpringSystem(coincident_pair(law, 0.7)).energies(state.q, state.v)["elastic"];
  };
  EXPECT_NEAR(elastic(SpringLaw::hooke), 5.0 * 0.49 + healthy, 1e-14);
  EXPECT_NEAR(elastic(SpringLaw::strain), 5.0 * 0.7 + healthy / 0.9, 1e-14);
  EXPECT_NEAR(elastic(SpringLaw::tension_only), healthy, 1e-14);
}

TEST(DegenerateSpring, OfRestLengthZeroKeepsItsIsotropicStiffness) {
  for (const SpringLaw law : {SpringLaw::hooke, SpringLaw::tension_only}) {
    const MassSpringSystem system(coincident_pair(law, 0.0));
    const State state = coincident_state();
    const Matrix K = dense_stiffness(system, state);
    EXPECT_EQ(K.topLeftCorner(3, 3), -10.0 * Matrix::Identity(3, 3));
    EXPECT_LE(relative_deviation(K, complex_step_tangents(system.model(), state).first), 1e-14);
    EXPECT_TRUE(force_of(system, state).head(3).isZero(0.0));
  }
}

TEST(SpringForce, IsFiniteForEveryFiniteLengthUpToTheSquareRootOfTheRange) {
  for (const SpringLaw law : all_laws) {
    for (const double rest_length : {1e-300, 1e-3, 1.0}) {
      MassSpringModel model = coincident_pair(law, rest_length);
      if (law == SpringLaw::strain) model.springs.stiffness[0] = rest_length;
      const MassSpringSystem system(model);
      for (int exponent = -323; exponent <= 150; ++exponent) {
        State state = coincident_state();
        state.q.setZero();
        state.q[3] = std::pow(10.0, exponent);
        state.q[8] = 1.0;
        const Vector y = state.stacked();
        EXPECT_TRUE(force_of(system, state).allFinite()) << exponent;
        SparseMatrix J = system.jacobian_pattern();
        system.jacobian(0.0, y, J);
        EXPECT_TRUE(J.coeffs().allFinite()) << exponent;
        Vector product(y.size());
        system.jacobian_product(0.0, y, Vector::Ones(y.size()), product);
        EXPECT_TRUE(product.allFinite()) << exponent;
      }
    }
  }
}

}  // namespace
}  // namespace fw::mechanics
