#include "oracles/sundials/static_equilibrium.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "mechanics/mass_spring_system.hpp"
#include "oracles/sundials/cvode.hpp"
#include "scene/scene.hpp"

namespace fw::oracles {
namespace {

using mechanics::MassSpringModel;
using mechanics::MassSpringSystem;
using mechanics::SpringLaw;

constexpr double gravity = 9.81;

/// A chain of `masses` from a fixed particle at the origin, laid out along x at rest lengths.
struct Chain {
  MassSpringModel model;
  Vector start;

  Chain(const std::vector<double>& masses, const std::vector<double>& stiffness,
        const std::vector<double>& rest_length, SpringLaw law = SpringLaw::hooke) {
    model.mass = {1.0};
    model.fixed = {0};
    model.gravity = {0.0, 0.0, -gravity};
    model.springs.law = law;
    start = Vector::Zero(3 * static_cast<Index>(masses.size() + 1));
    double x = 0.0;
    for (std::size_t e = 0; e < masses.size(); ++e) {
      model.mass.push_back(masses[e]);
      model.springs.first.push_back(static_cast<int>(e));
      model.springs.second.push_back(static_cast<int>(e + 1));
      model.springs.stiffness.push_back(stiffness[e]);
      model.springs.damping.push_back(0.0);
      model.springs.rest_length.push_back(rest_length[e]);
      x += rest_length[e];
      start[3 * static_cast<Index>(e + 1)] = x;
    }
  }
};

TEST(StaticEquilibrium, HangsASpringByItsWeight) {
  // L = l₀ + m g/k (hooke), l₀ (1 + m g/k) (strain).
  for (const SpringLaw law : {SpringLaw::hooke, SpringLaw::strain, SpringLaw::tension_only}) {
    const Chain chain({0.7}, {35.0}, {0.6}, law);
    const MassSpringSystem system(chain.model);
    const StaticEquilibrium equilibrium = find_static_equilibrium(system, chain.start);
    ASSERT_TRUE(equilibrium.status.ok()) << equilibrium.status.describe();
    const double weight = 0.7 * gravity;
    const double length = law == SpringLaw::strain ? 0.6 * (1.0 + weight / 35.0) : 0.6 + weight / 35.0;
    EXPECT_NEAR(equilibrium.position[5], -length, 1e-12);
    EXPECT_NEAR(equilibrium.position[3], 0.0, 1e-11);
    EXPECT_EQ(equilibrium.position.head(3), Vector::Zero(3));
    EXPECT_LE(equilibrium.residual, 1e-12 * weight);
    EXPECT_GT(equilibrium.work.newton_iterations, 0u);
    EXPECT_GT(equilibrium.work.rhs_evaluations, equilibrium.work.newton_iterations);
  }
}

TEST(StaticEquilibrium, StretchesEachSpringOfAHangingChainByWhatHangsBelow) {
  const std::vector<double> masses = {0.3, 0.5, 0.2, 0.9}, stiffness = {80.0, 120.0, 60.0, 200.0},
                            rest = {0.4, 0.3, 0.5, 0.2};
  const Chain chain(masses, stiffness, rest);
  const StaticEquilibrium equilibrium = find_static_equilibrium(MassSpringSystem(chain.model), chain.start);
  ASSERT_TRUE(equilibrium.status.ok()) << equilibrium.status.describe();
  double z = 0.0;
  for (std::size_t e = 0; e < masses.size(); ++e) {
    double below = 0.0;
    for (std::size_t k = e; k < masses.size(); ++k) below += masses[k];
    z -= rest[e] + below * gravity / stiffness[e];
    EXPECT_NEAR(equilibrium.position[3 * static_cast<Index>(e + 1) + 2], z, 1e-11);
    EXPECT_NEAR(equilibrium.position[3 * static_cast<Index>(e + 1)], 0.0, 1e-9);
  }
}

scene::Scene parse(const std::string& generate, double drag) {
  return scene::parse_scene(fmt::format("title = \"t\"\n[world]\ngravity = [0, 0, -9.81]\ndrag = {}\n"
                                        "[generate]\n{}\n",
                                        drag, generate),
                            "t.toml");
}

/// Against the end of a simulation with so much drag that nothing moves any more.
void expect_end_of_damped_motion(const std::string& generate, double drag, double end) {
  scene::Scene scene = parse(generate, drag);
  Ivp ivp;
  ivp.y0 = initial_state(scene);
  ivp.system = std::make_shared<const MassSpringSystem>(scene.model);
  ivp.t1 = end;
  const Index n = ivp.y0.size() / 2;
  const SecondOrderSystem& system = *ivp.system->second_order();
  Vector first(n);
  system.force(0.0, ivp.y0.head(n), Vector::Zero(n), first);

  const StaticEquilibrium equilibrium = find_static_equilibrium(system, ivp.y0.head(n));
  ASSERT_TRUE(equilibrium.status.ok()) << equilibrium.status.describe();
  // Rounding of coordinates times stiffness, and nothing more.
  EXPECT_LT(equilibrium.residual, 1e-11 * first.lpNorm<Eigen::Infinity>() + 1e-10);

  NullObserver observer;
  const Solution damped =
      make_cvode_bdf({.tolerance_factor = 1.0})
          ->solve(ivp, AdaptiveStep{.relative_tolerance = 1e-6, .absolute_tolerance = 1e-9}, observer);
  ASSERT_TRUE(damped.status.ok()) << damped.status.describe();
  ASSERT_LT(damped.state.tail(n).lpNorm<Eigen::Infinity>(), 1e-7) << "the simulation still moves";
  EXPECT_LT((damped.state.head(n) - equilibrium.position).lpNorm<Eigen::Infinity>(), 1e-5);
  EXPECT_GT((ivp.y0.head(n) - equilibrium.position).lpNorm<Eigen::Infinity>(), 1e-2) << "nothing to find";
}

TEST(StaticEquilibrium, IsWhereADampedChainComesToRest) {
  expect_end_of_damped_motion(
      "kind = \"chain\"\ncount = 12\nlength = 1\nmass = 0.1\nstiffness = 300.0\n"
      "damping = 0.0\npinned = \"ends\"",
      0.8, 60.0);
}

TEST(StaticEquilibrium, IsWhereADampedClothComesToRest) {
  expect_end_of_damped_motion(
      "kind = \"cloth\"\ncounts = [7, 7]\nsize = [1, 1]\nmass = 0.02\nstiffness = 100.0\ndamping = 0.0\n"
      "pinned = \"top_corners\"",
      0.1, 200.0);
}

TEST(StaticEquilibrium, StaysWhereItAlreadyIs) {
  Chain chain({1.0}, {10.0}, {1.0});
  chain.model.gravity = {};
  const StaticEquilibrium equilibrium = find_static_equilibrium(MassSpringSystem(chain.model), chain.start);
  EXPECT_TRUE(equilibrium.status.ok()) << equilibrium.status.describe();
  EXPECT_EQ(equilibrium.position, chain.start);
  EXPECT_EQ(equilibrium.residual, 0.0);
}

TEST(StaticEquilibrium, GivesTheSamePositionWithTheSerialVector) {
  const Chain chain({0.3, 0.5}, {80.0, 120.0}, {0.4, 0.3});
  const MassSpringSystem system(chain.model);
  const auto ours = find_static_equilibrium(system, chain.start);
  const auto serial = find_static_equilibrium(system, chain.start, 0.0, {.vector = VectorOperations::serial});
  ASSERT_TRUE(ours.status.ok() && serial.status.ok());
  EXPECT_LT((ours.position - serial.position).lpNorm<Eigen::Infinity>(), 1e-11);
}

TEST(StaticEquilibrium, ReportsThatFreeFallHasNone) {
  MassSpringModel model;
  model.mass = {1.0};
  model.gravity = {0.0, 0.0, -gravity};
  const MassSpringSystem system(model);
  const Vector start = Vector::Zero(3);
  const StaticEquilibrium regularised = find_static_equilibrium(system, start);
  EXPECT_EQ(regularised.status.code, StatusCode::newton_failed) << regularised.status.describe();
  EXPECT_NE(regularised.status.message.find("KINSOL: KIN_"), std::string::npos);
  EXPECT_NEAR(regularised.residual, gravity, 1e-12);
  const StaticEquilibrium plain = find_static_equilibrium(system, start, 0.0, {.regularisation = 0.0});
  EXPECT_EQ(plain.status.code, StatusCode::matrix_singular) << plain.status.describe();
  EXPECT_NE(plain.status.message.find("KIN_LSETUP_FAIL"), std::string::npos) << plain.status.describe();
}

TEST(StaticEquilibrium, ReportsTheSingularMatrixOfAFreeParticle) {
  Chain chain({0.7}, {35.0}, {0.6});
  chain.model.gravity = {};
  chain.model.mass.push_back(1.0);  // bound to nothing
  Vector start(9);
  start << 0.0, 0.0, 0.0, 0.9, 0.0, 0.1, 3.0, 0.0, 0.0;
  const MassSpringSystem system(chain.model);
  const StaticEquilibrium plain = find_static_equilibrium(system, start, 0.0, {.regularisation = 0.0});
  EXPECT_EQ(plain.status.code, StatusCode::matrix_singular) << plain.status.describe();
  EXPECT_TRUE(plain.position.allFinite());
  // Regularised, the particle stays, since nothing pulls at it.
  const StaticEquilibrium regularised = find_static_equilibrium(system, start);
  ASSERT_TRUE(regularised.status.ok()) << regularised.status.describe();
  EXPECT_EQ(regularised.position.tail(3), start.tail(3));
  EXPECT_NEAR(regularised.position.segment(3, 3).norm(), 0.6, 1e-12);
}

TEST(StaticEquilibrium, ReportsTheLimitOfIterations) {
  const Chain chain({0.3, 0.5}, {80.0, 120.0}, {0.4, 0.3});
  const StaticEquilibrium equilibrium =
      find_static_equilibrium(MassSpringSystem(chain.model), chain.start, 0.0, {.maximum_iterations = 2});
  EXPECT_EQ(equilibrium.status.code, StatusCode::newton_failed);
  EXPECT_NE(equilibrium.status.message.find("KIN_MAXITER_REACHED"), std::string::npos)
      << equilibrium.status.describe();
  EXPECT_GT(equilibrium.residual, 0.0);
}

/// One degree of freedom with f = 1 − x beyond x = 2 and what `Beyond` says below.
template <class Beyond>
class HalfLine final : public SecondOrderSystem {
 public:
  Index degrees_of_freedom() const override { return 1; }
  const Vector& mass() const override { return mass_; }
  const std::vector<char>& fixed() const override { return fixed_; }
  ForceClass force_class() const override { return ForceClass::position; }
  void force(double, ConstVectorRef q, ConstVectorRef, VectorRef f) const override {
    f[0] = q[0] > 2.0 ? 1.0 - q[0] : Beyond{}();
  }
  SparseMatrix tangent_pattern() const override {
    SparseMatrix pattern = Matrix::Ones(1, 1).sparseView();
    pattern.makeCompressed();
    return pattern;
  }
  void stiffness(double, ConstVectorRef, ConstVectorRef, TangentModel, SparseMatrix& K) const override {
    K.valuePtr()[0] = -1.0;
  }
  void damping(double, ConstVectorRef, ConstVectorRef, SparseMatrix&) const override {}
  void tangent_product(double, ConstVectorRef, ConstVectorRef, ConstVectorRef, ConstVectorRef,
                       VectorRef) const override {}

 private:
  Vector mass_ = Vector::Ones(1);
  std::vector<char> fixed_ = {0};
};

struct NotANumber {
  double operator()() const { return std::numeric_limits<double>::quiet_NaN(); }
};
struct ThrowsAtRest {
  double operator()() const { throw InputError("no force below x = 2"); }
};

TEST(StaticEquilibrium, ReportsNanAndHandsOnWhatTheForceThrows) {
  const Vector good{{3.0}}, bad{{1.0}};
  for (const Vector& start : {good, bad}) {
    const StaticEquilibrium equilibrium =
        find_static_equilibrium(HalfLine<NotANumber>{}, start, 0.0, {.regularisation = 0.0});
    EXPECT_FALSE(equilibrium.status.ok());
    EXPECT_EQ(equilibrium.status.code, StatusCode::non_finite);
    EXPECT_NE(equilibrium.status.message.find("system function"), std::string::npos)
        << equilibrium.status.describe();
  }
  EXPECT_EQ(find_static_equilibrium(HalfLine<NotANumber>{}, bad).status.code, StatusCode::non_finite);
  EXPECT_THROW(find_static_equilibrium(HalfLine<ThrowsAtRest>{}, good, 0.0, {.regularisation = 0.0}),
               InputError);
}

TEST(StaticEquilibrium, RefusesBadInput) {
  const Chain chain({0.7}, {35.0}, {0.6});
  const MassSpringSystem system(chain.model);
  EXPECT_THROW(find_static_equilibrium(system, Vector::Zero(5)), InputError);
  EXPECT_THROW(find_static_equilibrium(system, Vector::Constant(6, std::nan(""))), InputError);
  EXPECT_THROW(find_static_equilibrium(system, chain.start, 0.0, {.residual_tolerance = 0.0}), InputError);
  EXPECT_THROW(find_static_equilibrium(system, chain.start, 0.0, {.maximum_iterations = 0}), InputError);
  EXPECT_THROW(find_static_equilibrium(system, chain.start, 0.0, {.regularisation = -1.0}), InputError);
}

}  // namespace
}  // namespace fw::oracles
