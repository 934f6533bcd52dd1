#include <gmock/gmock.h>

#include "core/error.hpp"
#include "integrators/energy_momentum/discrete_gradient.hpp"
#include "integrators/graphics/projective_dynamics.hpp"
#include "integrators/graphics/xpbd.hpp"
#include "integrators/special/r_respa.hpp"
#include "mechanics/extended_list.hpp"
#include "network.hpp"

namespace fw::integrators {
namespace {

using mechanics::MassSpringModel;
using mechanics::MassSpringSystem;
using mechanics::SpringGroup;
using mechanics::SpringLaw;

/// A damped network of 16 springs whose springs are in these groups.
Ivp grouped_network(const std::vector<SpringGroup>& groups, double end_time) {
  Ivp ivp = random_network(81, {}, end_time);
  MassSpringModel model = dynamic_cast<const MassSpringSystem&>(*ivp.system).model();
  model.springs.groups = groups;
  ivp.system = std::make_shared<const MassSpringSystem>(std::move(model));
  return ivp;
}

std::vector<std::unique_ptr<Integrator>> schemes_that_look_at_springs() {
  std::vector<std::unique_ptr<Integrator>> list;
  list.push_back(make_xpbd());
  list.push_back(make_projective_dynamics({.iterations = 20}));
  list.push_back(make_discrete_gradient());
  list.push_back(make_r_respa({}));
  return list;
}

TEST(GroupsOfSprings, AreTakenByEverySchemeThatLooksAtSingleSprings) {
  const std::vector<SpringGroup> groups = {
      {"", SpringLaw::tension_only, 5}, {"", SpringLaw::strain, 6}, {"", SpringLaw::hooke, 5}};
  const Ivp ivp = grouped_network(groups, 0.25);
  const Vector reference = run(*explicit_runge_kutta("rk4"), ivp, 0.25 / 2048).state;
  const Vector of_one_law = run(*explicit_runge_kutta("rk4"), grouped_network({}, 0.25), 0.25 / 2048).state;
  EXPECT_GT((reference - of_one_law).norm(), 0.1) << "the laws make a difference";
  for (const auto& scheme : schemes_that_look_at_springs()) {
    const double coarse = (run(*scheme, ivp, 0.25 / 256).state - reference).norm();
    const double fine = (run(*scheme, ivp, 0.25 / 1024).state - reference).norm();
    EXPECT_LT(fine, 0.01) << scheme->info().name;
    EXPECT_LT(fine, 0.45 * coarse) << scheme->info().name;
  }
}

TEST(GroupsOfSprings, OfOneLawAreThatLawToTheLastBitInEveryScheme) {
  const Ivp one = grouped_network({}, 0.2);
  const Ivp two = grouped_network({{"a", SpringLaw::hooke, 7}, {"", SpringLaw::hooke, 9}}, 0.2);
  for (const auto& scheme : schemes_that_look_at_springs()) {
    EXPECT_EQ(run(*scheme, one, 0.01).state, run(*scheme, two, 0.01).state) << scheme->info().name;
  }
}

/// A network with two triangles and a tetrahedron, all damped but the tetrahedron.
struct Membrane {
  std::shared_ptr<std::vector<mechanics::TestBatch>> further =
      std::make_shared<std::vector<mechanics::TestBatch>>();
  std::shared_ptr<MassSpringSystem> system;
  Ivp ivp = random_network(82, {}, 0.5);

  Membrane() {
    further->push_back(
        mechanics::TriangleAreaBatch{{{{0, 1, 2}, 0.3, 60.0, 0.5}, {{3, 5, 2}, 0.8, 40.0, 0.2}}});
    further->push_back(mechanics::TetrahedronVolumeBatch{{{{0, 1, 2, 7}, 0.2, 80.0}}});
    system = std::make_shared<MassSpringSystem>(
        dynamic_cast<const MassSpringSystem&>(*ivp.system).model(),
        mechanics::with_elements(std::shared_ptr<const std::vector<mechanics::TestBatch>>(further)));
    ivp.system = system;
  }

  /// A triangle comes, the tetrahedron goes, a spring joins two particles that had nothing to do with each
  /// other.
  void change() {
    further->pop_back();
    std::get<mechanics::TriangleAreaBatch>(further->front()).triangles.push_back({{4, 6, 7}, 0.4, 50.0, 0.1});
    MassSpringModel model = system->model();
    mechanics::RandomModels random(5);
    random.add_spring(model.springs, 0, 5, true);
    system->change_elements(model);
  }
};

TEST(ElementsOfThreeAndFourNodes, RunWithImplicitSchemesOfTheirOrder) {
  const Membrane membrane;
  const Vector reference = run(*explicit_runge_kutta("rk4"), membrane.ivp, 0.5 / 4096).state;
  const Ivp springs_only = random_network(82, {}, 0.5);
  EXPECT_GT((run(*explicit_runge_kutta("rk4"), springs_only, 0.5 / 512).state - reference).norm(), 0.1);
  const auto order = [&](const Integrator& scheme, double h) {
    const double coarse = (run(scheme, membrane.ivp, h).state - reference).norm();
    return std::log2(coarse / (run(scheme, membrane.ivp, 0.5 * h).state - reference).norm());
  };
  EXPECT_NEAR(order(*make_implicit_euler(), 0.5 / 512), 1.0, 0.1);
  EXPECT_NEAR(order(*make_discrete_gradient(), 0.5 / 64), 2.0, 0.15);
  EXPECT_NEAR(order(*make_implicit_euler_linearised({}), 0.5 / 1024), 1.0, 0.15);
  EXPECT_NEAR(order(*make_r_respa({}), 0.5 / 128), 2.0, 0.15);
}

TEST(ElementsOfThreeAndFourNodes, MakeNewtonConvergeQuadratically) {
  const Membrane membrane;
  const Solution solution = run(*make_discrete_gradient(), membrane.ivp, 0.01);
  ASSERT_TRUE(solution.status.ok()) << solution.status.describe();
  EXPECT_LE(solution.work.newton_iterations, 6u * 50u);
}

TEST(ElementsOfThreeAndFourNodes, AreRefusedBySchemesMadeOfSpringsAndAnchors) {
  const Membrane membrane;
  for (const auto& scheme : {make_xpbd(), make_projective_dynamics()}) {
    try {
      run(*scheme, membrane.ivp, 0.01);
      FAIL() << scheme->info().name << " ran";
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(),
                  testing::HasSubstr("found triangles, expected springs and anchors alone to be elastic"));
    }
  }
}

TEST(ElementsThatChange, BetweenTwoRunsGiveWhatTwoSystemsGive) {
  for (const auto& scheme : {make_implicit_euler(), make_discrete_gradient(), make_r_respa({})}) {
    Membrane changing;
    Ivp first = changing.ivp;
    first.t1 = 0.2;
    const Vector middle = run(*scheme, first, 0.01).state;
    changing.change();
    EXPECT_EQ(changing.system->pattern_revision(), 1u);
    Ivp second = changing.ivp;
    second.t0 = 0.2;
    second.y0 = middle;
    second.y0_extended.clear();
    Ivp fresh = second;
    fresh.system = std::make_shared<const MassSpringSystem>(
        changing.system->model(),
        mechanics::with_elements(std::vector<mechanics::TestBatch>(*changing.further)));
    const Solution after = run(*scheme, second, 0.01);
    ASSERT_TRUE(after.status.ok()) << scheme->info().name << ": " << after.status.describe();
    EXPECT_EQ(after.state, run(*scheme, fresh, 0.01).state) << scheme->info().name;
    EXPECT_NE(after.state, run(*scheme, changing.ivp, 0.01).state);
  }
}

/// Changes the elements of a membrane at the first accepted step from t = 0.2 on.
class ComeAndGo final : public StepHook {
 public:
  explicit ComeAndGo(Membrane& membrane) : membrane_(membrane) {}
  Change on_accepted(double t, VectorRef) override {
    if (is_done_ || t < 0.2 - 1e-9) return Change::none;
    is_done_ = true;
    membrane_.change();
    return Change::pattern;
  }

 private:
  Membrane& membrane_;
  bool is_done_ = false;
};

TEST(ElementsThatChange, AtAnAcceptedStepGiveWhatTwoRunsGive) {
  for (const auto& scheme : {make_implicit_euler(), make_discrete_gradient(), make_r_respa({})}) {
    Membrane in_one;
    ComeAndGo hook(in_one);
    NullObserver observer;
    const Solution whole = scheme->solve(in_one.ivp, FixedStep{.step = 0.01}, observer, {.hook = &hook});
    ASSERT_TRUE(whole.status.ok()) << scheme->info().name << ": " << whole.status.describe();
    EXPECT_EQ(in_one.system->pattern_revision(), 1u);

    Membrane in_two;
    Ivp part = in_two.ivp;
    part.t1 = 0.2;
    const Vector middle = run(*scheme, part, 0.01).state;
    in_two.change();
    part = in_two.ivp;
    part.t0 = 0.2;
    part.y0 = middle;
    part.y0_extended.clear();
    EXPECT_LE((run(*scheme, part, 0.01).state - whole.state).norm(), 1e-11) << scheme->info().name;
    EXPECT_GT((run(*scheme, Membrane().ivp, 0.01).state - whole.state).norm(), 1e-3) << scheme->info().name;
  }
}

}  // namespace
}  // namespace fw::integrators
