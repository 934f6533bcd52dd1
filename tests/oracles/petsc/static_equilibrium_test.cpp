#include "oracles/petsc/static_equilibrium.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.hpp"
#include "mechanics/mass_spring_system.hpp"
#include "ode/functor_system.hpp"
#include "oracles/petsc/time_steppers.hpp"

namespace fw::oracles::snes {
namespace {

using testing::HasSubstr;

/// A string of points that hangs from its first one.
mechanics::MassSpringModel hanging_chain(int count, double stiffness, double damping = 0.0) {
  mechanics::MassSpringModel model;
  model.mass.assign(static_cast<std::size_t>(count), 0.25);
  model.gravity = {0.0, 0.0, -8.0};
  model.fixed = {0};
  model.drag = 0.75;
  for (int i = 0; i + 1 < count; ++i) {
    model.springs.first.push_back(i);
    model.springs.second.push_back(i + 1);
    model.springs.stiffness.push_back(stiffness);
    model.springs.damping.push_back(damping);
    model.springs.rest_length.push_back(0.5);
  }
  return model;
}

Vector sloping(int count) {
  Vector x(3 * count);
  for (int i = 0; i < count; ++i) x.segment<3>(3 * i) << 0.3 * i, 0.1 * i, -0.4 * i;
  return x;
}

TEST(PetscStaticEquilibrium, StretchesAHangingChainByTheWeightBelow) {
  const int count = 6;
  const double stiffness = 50.0;
  const mechanics::MassSpringSystem system(hanging_chain(count, stiffness));
  for (const NewtonKind kind : {NewtonKind::line_search, NewtonKind::trust_region}) {
    const StaticEquilibrium found = find_static_equilibrium(system, sloping(count), 0.0, {.kind = kind});
    ASSERT_TRUE(found.status.ok()) << found.status.describe();
    double z = 0.0;
    for (int i = 1; i < count; ++i) {
      z -= 0.5 + (count - i) * 0.25 * 8.0 / stiffness;
      EXPECT_NEAR(found.position[3 * i + 2], z, 1e-11);
      EXPECT_NEAR(found.position[3 * i], 0.0, 1e-11);
    }
    EXPECT_EQ(found.position.head(3), Vector::Zero(3));
    EXPECT_GT(found.work.newton_iterations, 2u);
  }
}

TEST(PetscStaticEquilibrium, IsWhereALongDampedRunEnds) {
  const int count = 5;
  const auto system = std::make_shared<const mechanics::MassSpringSystem>(hanging_chain(count, 50.0));
  Ivp ivp;
  ivp.system = system;
  ivp.y0 = Vector::Zero(6 * count);
  ivp.y0.head(3 * count) = sloping(count);
  ivp.t1 = 60.0;
  NullObserver nobody;
  const Solution run =
      make_ts_bdf()->solve(ivp, AdaptiveStep{.relative_tolerance = 1e-5, .absolute_tolerance = 1e-5}, nobody);
  ASSERT_TRUE(run.status.ok()) << run.status.describe();
  const StaticEquilibrium found = find_static_equilibrium(*system, sloping(count));
  ASSERT_TRUE(found.status.ok()) << found.status.describe();
  EXPECT_LT((found.position - run.state.head(3 * count)).lpNorm<Eigen::Infinity>(), 1e-4);
  EXPECT_GT((found.position - sloping(count)).lpNorm<Eigen::Infinity>(), 0.1);
}

struct Nowhere {
  template <class S>
  void operator()(const S&, std::span<const S> q, std::span<const S>, std::span<S> f) const {
    f[0] = S(1) + q[0] * q[0];
  }
};

TEST(PetscStaticEquilibrium, SaysThatThereIsNone) {
  const FunctorSecondOrderSystem<Nowhere> system(Vector{{1.0}}, ForceClass::position, Nowhere{});
  const StaticEquilibrium found =
      find_static_equilibrium(system, Vector{{3.0}}, 0.0, {.maximum_iterations = 50});
  EXPECT_FALSE(found.status.ok());
  EXPECT_THAT(found.status.message, HasSubstr("SNES_DIVERGED"));
  EXPECT_GT(found.residual, 0.9);
}

struct Broken {
  template <class S>
  void operator()(const S&, std::span<const S>, std::span<const S>, std::span<S>) const {
    throw std::runtime_error("the spring broke");
  }
};

TEST(PetscStaticEquilibrium, RefusesBadInputAndLetsExceptionsThrough) {
  const mechanics::MassSpringSystem system(hanging_chain(3, 10.0));
  EXPECT_THROW(find_static_equilibrium(system, Vector::Zero(3)), InputError);
  EXPECT_THROW(find_static_equilibrium(system, sloping(3), 0.0, {.residual_tolerance = 0.0}), InputError);
  EXPECT_THROW(find_static_equilibrium(system, sloping(3), 0.0, {.petsc = "-snes_tpye newtonls"}),
               InputError);
  const FunctorSecondOrderSystem<Broken> broken(Vector{{1.0}}, ForceClass::position, Broken{});
  EXPECT_THROW(find_static_equilibrium(broken, Vector{{0.0}}), std::runtime_error);
}

}  // namespace
}  // namespace fw::oracles::snes
