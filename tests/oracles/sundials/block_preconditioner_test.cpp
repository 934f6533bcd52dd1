#include "oracles/sundials/block_preconditioner.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>

#include "integrators/network.hpp"
#include "ode/functor_system.hpp"
#include "problems/oscillators.hpp"
#include "problems/stiff_equations.hpp"

namespace fw::oracles {
namespace {

Vector random_vector(Index size, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Vector vector(size);
  for (double& entry : vector) entry = std::uniform_real_distribution<double>(-1.0, 1.0)(random);
  return vector;
}

/// I − γJ from the dense Jacobian, keeping (i, j) where `keep(i, j)`.
template <class Keep>
Matrix block_part(const OdeSystem& system, ConstVectorRef y, double gamma, Keep keep) {
  SparseMatrix J = system.jacobian_pattern();
  system.jacobian(0.0, y, J);
  Matrix matrix = Matrix::Identity(y.size(), y.size()) - gamma * Matrix(J);
  for (Index i = 0; i < matrix.rows(); ++i) {
    for (Index j = 0; j < matrix.cols(); ++j) {
      if (!keep(i, j)) matrix(i, j) = 0.0;
    }
  }
  return matrix;
}

template <class Keep>
void expect_inverse_of_blocks(const OdeSystem& system, ConstVectorRef y, Keep keep) {
  BlockPreconditioner preconditioner(system);
  Work work;
  preconditioner.evaluate(0.0, y, work);
  EXPECT_EQ(work.jacobian_evaluations, 1u);
  const Vector r = random_vector(y.size(), 8);
  Vector z(y.size());
  for (const double gamma : {1e-4, 0.02, 0.7}) {
    ASSERT_TRUE(preconditioner.factorise(gamma));
    preconditioner.solve(r, z);
    const Matrix blocks = block_part(system, y, gamma, keep);
    EXPECT_LT((blocks * z - r).lpNorm<Eigen::Infinity>(),
              1e-12 * blocks.cwiseAbs().rowwise().sum().maxCoeff() * z.lpNorm<Eigen::Infinity>())
        << gamma;
  }
}

TEST(BlockPreconditioner, InvertsTheBlocksOfEveryParticle) {
  for (const bool is_damped : {true, false}) {
    const Ivp ivp = integrators::random_network(5, {.is_damped = is_damped}, 1.0);
    const Index n = ivp.y0.size() / 2;
    expect_inverse_of_blocks(*ivp.system, ivp.y0, [n](Index i, Index j) { return i % n / 3 == j % n / 3; });
  }
}

TEST(BlockPreconditioner, InvertsPairsOfPositionAndVelocityWithoutParticles) {
  const Problem problem = problems::harmonic_oscillator();
  ASSERT_NE(problem.ivp.system->second_order(), nullptr);
  const Index n = problem.ivp.y0.size() / 2;
  expect_inverse_of_blocks(*problem.ivp.system, problem.ivp.y0,
                           [n](Index i, Index j) { return i % n == j % n; });
}

TEST(BlockPreconditioner, InvertsTheDiagonalOfAFirstOrderSystem) {
  const Problem problem = problems::van_der_pol();
  ASSERT_EQ(problem.ivp.system->second_order(), nullptr);
  expect_inverse_of_blocks(*problem.ivp.system, problem.ivp.y0, [](Index i, Index j) { return i == j; });
}

/// ẏ = 4 y: 1 − γ·4 vanishes at γ = 1/4.
struct Grows {
  template <class S>
  void operator()(const S&, std::span<const S> y, std::span<S> dydt) const {
    dydt[0] = 4.0 * y[0];
  }
};

TEST(BlockPreconditioner, SaysWhereABlockIsSingular) {
  const FunctorSystem<Grows> system(1, Grows{});
  BlockPreconditioner preconditioner(system);
  Work work;
  preconditioner.evaluate(0.0, Vector{{1.0}}, work);
  EXPECT_FALSE(preconditioner.factorise(0.25));
  EXPECT_TRUE(preconditioner.factorise(0.125));
  EXPECT_FALSE(preconditioner.factorise(std::numeric_limits<double>::infinity()));
}

}  // namespace
}  // namespace fw::oracles
