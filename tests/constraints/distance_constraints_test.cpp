#include "constraints/distance_constraints.hpp"

#include <gtest/gtest.h>

#include <random>

#include "constraints/consistent_state.hpp"
#include "core/error.hpp"
#include "mechanics/mass_spring_system.hpp"

namespace fw::constraints {
namespace {

constexpr double rounding = 1e-13;

/// Five particles of unlike masses under gravity, the first one fixed, without springs.
mechanics::MassSpringSystem particles() {
  mechanics::MassSpringModel model;
  model.mass = {1.0, 0.5, 2.0, 1.25, 0.75};
  model.fixed = {0};
  model.gravity = {0.5, -0.25, -9.81};
  model.drag = 0.3;
  return mechanics::MassSpringSystem(model);
}

/// A tree, so that the constraints are independent.
DistanceConstraints tree(const SecondOrderSystem& system) {
  return {system, {{0, 1, 0.8}, {1, 2, 1.5}, {4, 1, 0.6}, {3, 2, 2.0}}};
}

Vector random_vector(Index size, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> distribution(-1.0, 1.0);
  Vector result(size);
  for (Index i = 0; i < size; ++i) result[i] = distribution(generator);
  return result;
}

Vector value(const DistanceConstraints& constraints, const Vector& q) {
  Vector g(constraints.size());
  constraints.value(q, g);
  return g;
}

TEST(DistanceConstraints, VanishAtTheirLengthAndMeasureTheExcessNearIt) {
  const auto system = particles();
  const DistanceConstraints constraints(system, {{1, 2, 1.5}});
  Vector q = Vector::Zero(15);
  q.segment(3, 3) << 0.3, 0.2, 0.1;
  const Vector direction = Vector{{2.0, -1.0, 2.0}} / 3.0;
  q.segment(6, 3) = q.segment(3, 3) + 1.5 * direction;
  EXPECT_NEAR(value(constraints, q)[0], 0.0, 1e-15);
  q.segment(6, 3) += 1e-6 * direction;
  EXPECT_NEAR(value(constraints, q)[0], 1e-6, 1e-12);
}

TEST(DistanceConstraints, HaveTheDerivativeOfTheirValue) {
  // The value is quadratic, so that central differences are exact for any step.
  const auto system = particles();
  const DistanceConstraints constraints = tree(system);
  const Vector q = random_vector(15, 5);
  Matrix G = Matrix::Zero(constraints.size(), 15);
  constraints.for_each_derivative(q, [&](Index c, Index i, double slope) { G(c, i) += slope; });
  for (Index i = 0; i < 15; ++i) {
    Vector up = q, down = q;
    up[i] += 0.5;
    down[i] -= 0.5;
    const Vector difference = value(constraints, up) - value(constraints, down);
    const Vector expected = i < 3 ? Vector(Vector::Zero(constraints.size())) : difference;
    EXPECT_LE((G.col(i) - expected).lpNorm<Eigen::Infinity>(), rounding) << "degree of freedom " << i;
  }
  const Vector w = random_vector(15, 6), lambda = random_vector(constraints.size(), 7);
  Vector product(constraints.size()), transposed = Vector::Ones(15);
  constraints.product(q, w, product);
  constraints.add_transposed_product(q, lambda, transposed);
  EXPECT_LE((product - G * w).lpNorm<Eigen::Infinity>(), rounding);
  EXPECT_LE((transposed - Vector::Ones(15) - G.transpose() * lambda).lpNorm<Eigen::Infinity>(), rounding);
}

TEST(DistanceConstraints, HaveTheSecondDerivativeOfTheirForces) {
  const auto system = particles();
  const DistanceConstraints constraints = tree(system);
  const Vector q = random_vector(15, 8), lambda = random_vector(constraints.size(), 9);
  Matrix H = Matrix::Zero(15, 15);
  constraints.for_each_second_derivative(lambda, [&](Index i, Index j, double h) { H(i, j) += h; });
  for (Index j = 3; j < 15; ++j) {  // Gᵀλ is linear in q
    Vector up = q, force_up = Vector::Zero(15), force = Vector::Zero(15);
    up[j] += 1.0;
    constraints.add_transposed_product(up, lambda, force_up);
    constraints.add_transposed_product(q, lambda, force);
    EXPECT_LE((H.col(j) - (force_up - force)).lpNorm<Eigen::Infinity>(), rounding);
  }
  EXPECT_TRUE(H.leftCols(3).isZero(0.0) && H.topRows(3).isZero(0.0));
}

TEST(DistanceConstraints, HaveTheirTimeDerivativesAlongAMotion) {
  // q(t) = q + t v + t²a/2: d/dt g = G v and d²/dt² g = G a + G(v) v at t = 0, by differences of a polynomial
  // of degree 4 that are exact.
  const auto system = particles();
  const DistanceConstraints constraints = tree(system);
  Vector q = random_vector(15, 10), v = random_vector(15, 11), a = random_vector(15, 12);
  v.head(3).setZero();
  a.head(3).setZero();
  const auto at = [&](double t) { return value(constraints, q + t * v + 0.5 * t * t * a); };
  const Vector first = (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / 12.0;
  const Vector second = (-at(2.0) + 16.0 * at(1.0) - 30.0 * at(0.0) + 16.0 * at(-1.0) - at(-2.0)) / 12.0;
  Vector Gv(constraints.size()), Ga(constraints.size()), curvature(constraints.size());
  constraints.product(q, v, Gv);
  constraints.product(q, a, Ga);
  constraints.product(v, v, curvature);
  EXPECT_LE((first - Gv).lpNorm<Eigen::Infinity>(), 10 * rounding);
  EXPECT_LE((second - Ga - curvature).lpNorm<Eigen::Infinity>(), 10 * rounding);
}

TEST(ConsistentState, ProjectsOntoTheConstraintsAndLeavesWhatLiesOnThem) {
  const auto system = particles();
  const DistanceConstraints constraints = tree(system);
  Vector q = random_vector(15, 13), v = random_vector(15, 14);
  v.head(3).setZero();
  const Vector fixed = q.head(3);
  ASSERT_TRUE(project_on_constraints(system, constraints, q, v).ok());
  Vector rate(constraints.size());
  constraints.product(q, v, rate);
  EXPECT_LE(value(constraints, q).lpNorm<Eigen::Infinity>(), 1e-14);
  EXPECT_LE(rate.lpNorm<Eigen::Infinity>(), 1e-14);
  EXPECT_EQ(q.head(3), fixed);
  EXPECT_TRUE(v.head(3).isZero(0.0));
  Vector q_again = q, v_again = v;
  ASSERT_TRUE(project_on_constraints(system, constraints, q_again, v_again).ok());
  EXPECT_LE((q_again - q).lpNorm<Eigen::Infinity>() + (v_again - v).lpNorm<Eigen::Infinity>(), 1e-14);
}

TEST(ConsistentState, HasMultipliersThatKeepTheAccelerationOnTheConstraints) {
  const auto system = particles();
  const DistanceConstraints constraints = tree(system);
  Vector q = random_vector(15, 15), v = random_vector(15, 16);
  v.head(3).setZero();
  ASSERT_TRUE(project_on_constraints(system, constraints, q, v).ok());
  const Vector lambda = multipliers(system, constraints, 0.0, q, v);
  Vector force(15), Ga(constraints.size()), curvature(constraints.size());
  system.force(0.0, q, v, force);
  constraints.add_transposed_product(q, lambda, force);
  constraints.product(q, force.cwiseQuotient(system.mass()), Ga);
  constraints.product(v, v, curvature);
  EXPECT_LE((Ga + curvature).lpNorm<Eigen::Infinity>(), 1e-12);
  EXPECT_GT(Ga.lpNorm<Eigen::Infinity>(), 0.1);  // it is the curvature that it balances, not nothing
}

TEST(ConsistentState, ReportsRedundantConstraintsWithTheirRank) {
  const auto system = particles();
  Vector q = random_vector(15, 17), v = Vector::Zero(15);
  const DistanceConstraints doubled(system, {{1, 2, 1.0}, {2, 1, 1.0}, {2, 3, 1.0}});
  const Status status = project_on_constraints(system, doubled, q, v);
  EXPECT_EQ(status.code, StatusCode::matrix_singular);
  EXPECT_NE(status.message.find("of the 3 distance constraints 2 are independent"), std::string::npos)
      << status.message;
  // A particle between two fixed ones on a straight line: independent off the line only.
  mechanics::MassSpringModel model;
  model.mass = {1.0, 1.0, 1.0};
  model.fixed = {0, 2};
  const mechanics::MassSpringSystem line(model);
  const DistanceConstraints rods(line, {{0, 1, 1.0}, {1, 2, 1.0}});
  Vector straight = Vector::Zero(9);
  straight[3] = 1.0;
  straight[6] = 2.0;
  EXPECT_EQ(check_independence(line, rods, straight).code, StatusCode::matrix_singular);
  straight[4] = 0.1;
  EXPECT_TRUE(check_independence(line, rods, straight).ok());
}

TEST(ConsistentState, ReportsLengthsThatCannotBeReached) {
  mechanics::MassSpringModel model;
  model.mass = {1.0, 1.0, 1.0};
  model.fixed = {0, 2};
  const mechanics::MassSpringSystem system(model);
  const DistanceConstraints rods(system, {{0, 1, 1.0}, {1, 2, 1.0}});
  Vector q = Vector::Zero(9), v = Vector::Zero(9);
  q.segment(3, 3) << 1.3, 0.4, 0.2;
  q[6] = 3.0;  // farther apart than both rods together
  const Status status = project_on_constraints(system, rods, q, v);
  EXPECT_FALSE(status.ok());
}

TEST(DistanceConstraints, NameABadEntry) {
  const auto system = particles();
  const auto message = [&](DistanceConstraint bad) {
    try {
      const DistanceConstraints constraints(system, {{1, 2, 1.0}, bad});
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(message({1, 5, 1.0}), "constraint[1]: found particle 5, expected an index below 5");
  EXPECT_EQ(message({3, 3, 1.0}), "constraint[1]: both ends are particle 3");
  EXPECT_EQ(message({3, 4, 0.0}), "constraint[1]: found length 0, expected a finite number > 0");
  EXPECT_EQ(message({3, 4, 1.0}), "");
}

}  // namespace
}  // namespace fw::constraints
