#include <Eigen/LU>
#include <random>
#include <unsupported/Eigen/MatrixFunctions>

#include "core/error.hpp"
#include "integrators/exponential/exponential_rosenbrock_euler.hpp"
#include "integrators/exponential/gautschi.hpp"
#include "integrators/exponential/krylov_phi.hpp"
#include "order_levels.hpp"

namespace fw::integrators {
namespace {

const std::vector<TrigonometricFilter> filters = {
    TrigonometricFilter::gautschi, TrigonometricFilter::deuflhard, TrigonometricFilter::mollified_impulse};

TEST(ExponentialRosenbrockEuler, ConvergesWithOrderTwo) {
  expect_claimed_orders(*make_exponential_rosenbrock_euler(), 40, 8);
  const Ivp ivp = first_order_flow();
  expect_order(*make_exponential_rosenbrock_euler(), ivp, certified_end(ivp), 2, 40, 8, "first order");
}

/// ẏ = A y + b + c t with a stiff, non-normal A.
struct LinearFlow {
  template <class S>
  void operator()(const S& t, std::span<const S> y, std::span<S> dydt) const {
    dydt[0] = S(-1000) * y[0] + S(300) * y[1] + S(1) + S(2) * t;
    dydt[1] = S(-20) * y[1] + S(5) * y[2];
    dydt[2] = S(-5) * y[1] - S(3) * t;
  }
};

TEST(ExponentialRosenbrockEuler, IsExactOnLinearSystemsWithLinearForcing) {
  Ivp ivp;
  ivp.system = std::make_shared<FunctorSystem<LinearFlow>>(3, LinearFlow{});
  ivp.y0 = Vector{{1.0, -0.5, 0.25}};
  ivp.t0 = 0.5;
  ivp.t1 = 1.5;
  const Vector reference = certified_end(ivp);
  // One step of hλ = −1000.
  EXPECT_LT((run(*make_exponential_rosenbrock_euler(), ivp, 1.0).state - reference).norm(), 1e-10);
}

TEST(KrylovPhi, AgreesWithTheDenseFunctionAndStopsEarlyWhereItCan) {
  std::mt19937_64 random(61);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const Index n = 60;
  Matrix A(n, n);
  for (Index j = 0; j < n; ++j) {
    for (Index i = 0; i < n; ++i) A(i, j) = 0.2 * uniform(random) - (i == j ? 2.0 : 0.0);
  }
  Vector b(n);
  for (double& value : b) value = uniform(random);
  const Matrix exponential = A.exp();
  const Vector expected = A.partialPivLu().solve(exponential * b - b);
  KrylovPhi phi(n, 60);
  Vector found(n);
  int loose = 0, tight = 0;
  const auto apply = [&](ConstVectorRef w, VectorRef out) { out.noalias() = A * w; };
  ASSERT_TRUE(phi.multiply(apply, b, 1e-3, found, loose).ok());
  EXPECT_LT((found - expected).norm(), 1e-3);
  ASSERT_TRUE(phi.multiply(apply, b, 1e-12, found, tight).ok());
  EXPECT_LT((found - expected).norm(), 1e-11);
  EXPECT_LT(loose, tight);
  EXPECT_LT(tight, 50);
  KrylovPhi small(n, 6);
  EXPECT_EQ(small.multiply(apply, b, 1e-12, found, tight).code, StatusCode::linear_solver_failed);
}

TEST(KrylovPhi, SurvivesRitzValuesOfSmallSpacesThatOverflow) {
  // q̈ = −Kq − cKq̇ far beyond the stability limit of explicit schemes: the field of values of [0, I; −K, −cK]
  // reaches to Re z ~ h‖K‖/2.
  const Index n = 8;
  Matrix K = Matrix::Zero(n, n);
  for (Index i = 0; i < n; ++i) {
    K(i, i) = 4e4;
    if (i > 0) K(i, i - 1) = K(i - 1, i) = -2e4;
  }
  Matrix A(2 * n, 2 * n);
  A << Matrix::Zero(n, n), Matrix::Identity(n, n), -K, -1e-3 * K;
  Vector b = Vector::Ones(2 * n);
  b[3] = -2.0;
  KrylovPhi phi(2 * n, 40);
  for (const double h : {0.5, 2.0}) {
    Vector found(2 * n);
    int dimension = 0;
    const Status status = phi.multiply([&](ConstVectorRef w, VectorRef out) { out.noalias() = h * (A * w); },
                                       b, 1e-10, found, dimension);
    ASSERT_TRUE(status.ok()) << status.describe();
    // φ₁(hA) b = (hA)⁻¹ (exp(hA) − 1) b, and exp(hA) by the modes of K.
    const Matrix exponential = (h * A).exp();
    const Vector expected = (h * A).partialPivLu().solve(exponential * b - b);
    EXPECT_LT((found - expected).norm(), 1e-6 * expected.norm()) << h;
  }
}

TEST(Gautschi, ConvergesWithOrderTwoWithEveryFilter) {
  for (const TrigonometricFilter filter : filters) {
    expect_claimed_orders(*make_gautschi({.filter = filter}), 150, 8);
    const Ivp ivp = random_network(62, {.is_damped = false}, 0.31);
    expect_order(*make_gautschi({.filter = filter}), ivp, certified_end(ivp), 2, 30, 8, "network");
  }
}

/// A linear chain of three masses with a constant force, stiff (hω up to about 60 at h = 1).
struct LinearChain {
  template <class S>
  void operator()(const S&, std::span<const S> q, std::span<const S>, std::span<S> f) const {
    f[0] = S(-900) * q[0] + S(400) * (q[1] - q[0]) + S(3);
    f[1] = S(-400) * (q[1] - q[0]) + S(700) * (q[2] - q[1]);
    f[2] = S(-700) * (q[2] - q[1]) - S(1);
  }
};

TEST(Gautschi, IsExactWhereForcesAreLinearWhateverTheStep) {
  Ivp ivp;
  const Vector mass{{1.7, 0.6, 2.3}};
  ivp.system =
      std::make_shared<FunctorSecondOrderSystem<LinearChain>>(mass, ForceClass::position, LinearChain{});
  ivp.y0 = Vector{{0.5, -0.25, 0.75, -1.0, 0.5, 0.25}};
  ivp.t1 = 2.0;
  const Vector reference = certified_end(ivp);
  const auto positions = [](const Vector& y) { return Vector(y.head(3)); };
  // The constant force enters the positions exactly through ψ = sinc²; the homogeneous motion is exact for
  // every filter.
  const Solution solution = run(*make_gautschi(), ivp, 1.0);
  EXPECT_LT((positions(solution.state) - positions(reference)).norm(), 1e-10);
  EXPECT_LT((solution.state - reference).norm(), 1e-8);
  EXPECT_FALSE(run(*splitting("velocity_verlet"), ivp, 0.5).state.norm() <
               10.0);  // negative control: unstable there
}

TEST(Gautschi, CostsOneForcePerStep) {
  const Ivp ivp = random_network(63, {.is_damped = false}, 1.0);
  for (const TrigonometricFilter filter : filters) {
    const Solution solution = run(*make_gautschi({.filter = filter}), ivp, 0.01);
    EXPECT_EQ(solution.work.rhs_evaluations, 101u);
    EXPECT_EQ(solution.work.factorisations, 1u);
  }
}

TEST(Gautschi, RefusesDampersAndLargeSystems) {
  EXPECT_THROW(run(*make_gautschi(), random_network(64, {.is_damped = true}, 1.0), 0.01), InputError);
  mechanics::MassSpringModel model;
  model.mass.assign(201, 1.0);
  Ivp ivp;
  ivp.y0 = Vector::Zero(6 * 201);
  ivp.system = std::make_shared<const mechanics::MassSpringSystem>(model);
  EXPECT_THROW(run(*make_gautschi(), ivp, 0.01), InputError);
  model.fixed = {0};
  ivp.system = std::make_shared<const mechanics::MassSpringSystem>(model);
  EXPECT_TRUE(run(*make_gautschi(), ivp, 0.5).status.ok());  // 600 of them move
}

}  // namespace
}  // namespace fw::integrators
