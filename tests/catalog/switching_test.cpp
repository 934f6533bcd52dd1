#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "analysis/reference/binary64_reference.hpp"
#include "analysis/reference/reference_solution.hpp"
#include "catalog/methods.hpp"
#include "catalog/walls.hpp"
#include "core/error.hpp"
#include "integrators/loop/switch_cutter.hpp"
#include "integrators/saved_run.hpp"

namespace fw::catalog {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;
using Shape = Wall::Shape;

std::vector<std::shared_ptr<const Integrator>> adaptive_methods(const OdeSystem& system) {
  std::vector<std::shared_ptr<const Integrator>> list;
  for (const MethodEntry& entry : methods()) {
    // The published error estimate of ROS3P is zero on linear systems, walls or not: k_2 = k_1 there.
    if (entry.name == "ros3p") continue;
    if (!entry.info().is_adaptive || !why_not_applicable(entry.info(), system).empty()) continue;
    list.push_back(make_method(entry.name));
  }
  return list;
}

Solution solve(const Integrator& method, const Ivp& ivp, double tolerance, bool cut = true) {
  NullObserver observer;
  return method.solve(ivp, AdaptiveStep{.relative_tolerance = tolerance, .absolute_tolerance = tolerance},
                      observer, {.cut_at_switches = cut});
}

double error(const Wall& wall, const Solution& solution) {
  if (!solution.status.ok()) return std::numeric_limits<double>::infinity();
  return std::max(std::abs(solution.state[0] - wall.end_position()),
                  std::abs(solution.state[6] - wall.end_speed()));
}

/// A high-order method needs a tolerance that its error follows; all errors are within 100 tolerances.
double tolerance_for(const MethodInfo& info) {
  return info.order == 1 || info.order == 2 ? 1e-3 : 1e-6;
}

TEST(Switching, EveryAdaptiveMethodBouncesFromAThinPlate) {
  const Wall wall{.shape = Shape::box, .thickness = 0.002, .stiffness = 1e9, .speed = 10.0};
  const Ivp ivp = wall.ivp();
  int count = 0;
  for (const auto& method : adaptive_methods(*ivp.system)) {
    const double tolerance = tolerance_for(method->info());
    const Solution found = solve(*method, ivp, tolerance);
    EXPECT_TRUE(found.status.ok()) << method->info().name << ": " << found.status.describe();
    EXPECT_LT(error(wall, found), 100.0 * tolerance * wall.speed) << method->info().name;
    // A release so late in a step that it cannot matter is none.
    EXPECT_GE(found.switches, 1u) << method->info().name;
    EXPECT_LE(found.switches, 2u) << method->info().name;
    ++count;
  }
  EXPECT_GT(count, 20);
}

TEST(Switching, WithoutCutsAParticleFliesThrough) {
  const Wall wall{};
  const Solution found = solve(*make_method("dormand_prince_54"), wall.ivp(), 1e-8, false);
  ASSERT_TRUE(found.status.ok());
  EXPECT_GT(error(wall, found), 1.0);
  EXPECT_EQ(found.switches, 0u);
}

TEST(Switching, ShapesStiffnessesAndSpeeds) {
  for (const char* name : {"dormand_prince_54", "dormand_prince_853", "sundials:cvode_bdf"}) {
    const auto method = make_method(name);
    for (const Shape shape : {Shape::plane, Shape::sphere, Shape::box}) {
      for (const double thickness : {0.002, 0.2}) {
        for (const double stiffness : {1e4, 1e7, 1e10}) {
          for (const double speed : {1.0, 100.0}) {
            const Wall wall{shape, thickness, stiffness, speed};
            if (!wall.has_closed_form()) continue;
            const Solution found = solve(*method, wall.ivp(), 1e-8);
            EXPECT_LT(error(wall, found), 3e-6 * speed)
                << name << ": " << wall.name() << " " << found.status.describe();
          }
        }
      }
    }
  }
}

/// The certified error covers the truth.
TEST(Switching, ReferencesKnowOfWalls) {
  for (const Shape shape : {Shape::plane, Shape::sphere, Shape::box}) {
    for (const double stiffness : {1e4, 1e9}) {
      const Wall wall{shape, shape == Shape::plane ? 0.002 : 0.02, stiffness, stiffness > 1e5 ? 10.0 : 0.5};
      ASSERT_TRUE(wall.has_closed_form());
      const auto certified = analysis::certified_reference(wall.ivp(), wall.end);
      ASSERT_TRUE(certified.status.ok()) << wall.name() << ": " << certified.status.describe();
      const analysis::ReferenceState& state = certified.states.back();
      using boost::multiprecision::sqrt;
      const Float128 frequency = sqrt(Float128(stiffness));
      // As the obstacle has it in doubles.
      const Float128 centre = wall.face() + 0.5 * wall.thickness, radius = 0.5 * wall.thickness;
      const Float128 face = shape == Shape::sphere ? Float128(centre - radius) : Float128(wall.face());
      const Float128 speed = wall.speed;
      const Float128 pi = acos(Float128(-1));
      const Float128 truth = face - speed * (Float128(wall.end) - face / speed - pi / frequency);
      ASSERT_FALSE(wall.is_passed());
      EXPECT_LE(static_cast<double>(abs(state.value[0] - truth)), static_cast<double>(state.error[0]))
          << wall.name();
      EXPECT_LT(static_cast<double>(state.error[0]), 1e-20) << wall.name();
      const auto quick = analysis::binary64_reference(wall.ivp());
      ASSERT_TRUE(quick.status.ok());
      EXPECT_LE(std::abs(static_cast<double>(quick.states.back().value[0] - truth)),
                static_cast<double>(quick.states.back().error[0]))
          << wall.name();
    }
  }
}

/// Two particles on a rope, one at rest: both fly apart, are pulled back when it becomes taut after 0.1 s, and
/// swap their parts of the motion about the centre of mass.
TEST(Switching, RopesBecomeTautWhereTheyAreTaut) {
  constexpr double stiffness = 1e6, speed = 4.0;
  mechanics::MassSpringModel model;
  model.mass = {1.0, 1.0};
  model.springs.law = mechanics::SpringLaw::tension_only;
  model.springs.add(0, 1, {stiffness, 0.0, 1.0});
  Ivp ivp;
  ivp.system = std::make_shared<const mechanics::MassSpringSystem>(model);
  ivp.t1 = 0.2;
  ivp.y0 = Vector::Zero(12);
  ivp.y0[3] = 0.6;
  ivp.y0[9] = speed;
  const double frequency = std::sqrt(2.0 * stiffness);
  const double rest = ivp.t1 - 0.1 - std::numbers::pi / frequency;
  const double distance = 1.0 - speed * rest, centre = 0.3 + 0.5 * speed * ivp.t1;
  for (const auto& method : adaptive_methods(*ivp.system)) {
    const double tolerance = tolerance_for(method->info());
    const Solution found = solve(*method, ivp, tolerance);
    EXPECT_TRUE(found.status.ok()) << method->info().name << ": " << found.status.describe();
    EXPECT_NEAR(found.state[0], centre - 0.5 * distance, 100.0 * tolerance * speed) << method->info().name;
    EXPECT_NEAR(found.state[3], centre + 0.5 * distance, 100.0 * tolerance * speed) << method->info().name;
  }
}

/// A damper lets the force jump at the impact and ends it while the point is still inside.
TEST(Switching, DampedImpactsEndWhereThePressureDoes) {
  Wall wall{.shape = Shape::plane, .stiffness = 1e6, .speed = 2.0};
  mechanics::MassSpringModel model = wall.model();
  constexpr double damping = 400.0;
  model.obstacles[0].damping = damping;
  Ivp ivp = wall.ivp();
  ivp.system = std::make_shared<const mechanics::MassSpringSystem>(model);
  // δ'' + c δ' + k δ = 0 from δ = 0, δ' = v until k δ + c δ' = 0; then it flies freely.
  const double decay = 0.5 * damping, frequency = std::sqrt(wall.stiffness - decay * decay);
  // δ = v/ω e^{−dt} sin ωt, k δ + c δ' = v/ω e^{−dt} ((k − 2d²) sin ωt + 2dω cos ωt).
  const double end =
      (std::numbers::pi - std::atan2(2.0 * decay * frequency, wall.stiffness - 2.0 * decay * decay)) /
      frequency;
  const double depth = wall.speed / frequency * std::exp(-decay * end) * std::sin(frequency * end);
  const double speed = wall.speed * std::exp(-decay * end) *
                       (std::cos(frequency * end) - decay / frequency * std::sin(frequency * end));
  for (const char* name :
       {"dormand_prince_54", "verner_87", "sundials:cvode_bdf", "sundials:ida", "gsl:rk8pd"}) {
    const Solution found = solve(*make_method(name), ivp, 1e-8);
    ASSERT_TRUE(found.status.ok()) << name << ": " << found.status.describe();
    EXPECT_NEAR(found.state[6], speed, 3e-6) << name;
    EXPECT_NEAR(found.state[0], wall.face() + depth + speed * (wall.end - wall.impact() - end), 3e-6) << name;
    // Verner's error test shortens the step until it resolves the jump, where nothing is left to cut.
    if (std::string_view(name) != "verner_87") {
      EXPECT_GE(found.switches, 1u) << name;
    }
  }
}

TEST(Switching, ConstantStepsAreRightOrWarn) {
  const Wall thin{};
  NullObserver observer;
  const auto method = make_method("velocity_verlet");
  const Solution through = method->solve(thin.ivp(), FixedStep{.step = 1e-3}, observer);
  ASSERT_EQ(through.warnings.size(), 2u);
  EXPECT_THAT(through.warnings[0], HasSubstr("h sqrt(k/m) is 31.6"));
  EXPECT_THAT(through.warnings[0], HasSubstr("obstacles[0] and particle 0 at t = 0.05"));
  EXPECT_THAT(through.warnings[1], HasSubstr("0.01 m per step, the solid is 0.002 m thick"));
  const Solution fine = method->solve(thin.ivp(), FixedStep{.step = 1e-6}, observer);
  EXPECT_TRUE(fine.warnings.empty()) << fine.warnings[0];
  EXPECT_LT(error(thin, fine), 1e-2 * thin.speed);
}

/// A net of 4 × 4 points that falls flat onto a plate of 2 mm with 20 m/s.
Ivp falling_net(double spring_damping) {
  constexpr int n = 4;
  mechanics::MassSpringModel model;
  model.gravity = {0.0, 0.0, -9.81};
  model.mass.assign(n * n, 0.01);
  model.obstacles = {{mechanics::Box{{-1.0, -1.0, -0.002}, {1.0, 1.0, 0.0}}, 1e7, 0.0}};
  Ivp ivp;
  ivp.t1 = 0.02;
  ivp.y0 = Vector::Zero(6 * n * n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const int k = n * i + j;
      ivp.y0.segment(3 * k, 3) << 0.1 * i, 0.1 * j, 0.1 + 0.003 * std::sin(5.0 * k);
      ivp.y0[3 * n * n + 3 * k + 2] = -20.0;
      if (i + 1 < n) model.springs.add(k, k + n, {200.0, spring_damping, 0.1});
      if (j + 1 < n) model.springs.add(k, k + 1, {200.0, spring_damping, 0.1});
    }
  }
  ivp.system = std::make_shared<const mechanics::MassSpringSystem>(std::move(model));
  return ivp;
}

TEST(Switching, ANetDoesNotFallThroughAThinPlate) {
  const Ivp ivp = falling_net(0.0);
  const auto& system = dynamic_cast<const mechanics::MassSpringSystem&>(*ivp.system);
  const auto energy = [&](const Vector& y) { return system.energies(y.head(48), y.tail(48)).total(); };
  for (const char* name : {"dormand_prince_54", "dormand_prince_853", "rodasp", "sundials:cvode_adams",
                           "sundials:arkode_erk", "gsl:rk8pd", "petsc:ts_rk"}) {
    const Solution found = solve(*make_method(name), ivp, 1e-8);
    ASSERT_TRUE(found.status.ok()) << name << ": " << found.status.describe();
    for (Index k = 0; k < 16; ++k) EXPECT_GT(found.state[3 * k + 2], 0.0) << name << ", particle " << k;
    EXPECT_GE(found.switches, 16u) << name;
    EXPECT_NEAR(energy(found.state), energy(ivp.y0), 1e-4 * energy(ivp.y0)) << name;
  }
}

TEST(Switching, ARunGoesOnFromEveryCheckpointBitForBit) {
  const Wall wall{};
  const Ivp ivp = wall.ivp();
  for (const char* name : {"dormand_prince_54", "verner_87", "esdirk5", "rodasp"}) {
    const auto method = make_method(name);
    const AdaptiveStep control{.relative_tolerance = 1e-6, .absolute_tolerance = 1e-6};
    integrators::EveryStep checkpoints;
    integrators::StepRecord whole;
    const Solution all = method->solve(ivp, control, whole, {.checkpoints = &checkpoints});
    ASSERT_TRUE(all.status.ok());
    ASSERT_GT(checkpoints.saved.size(), 10u);
    for (const auto& [time, saved] : checkpoints.saved) {
      integrators::StepRecord rest(time);
      const Solution anew = method->solve(ivp, control, rest, {.resume = saved});
      EXPECT_EQ(difference_from_end(whole, rest), "") << name << " from " << time;
      EXPECT_EQ(anew.switches, all.switches) << name << " from " << time;
    }
  }
}

/// A surface that is crossed in every step, as a sliding mode would.
class EverySurface final : public SwitchingSurfaces {
 public:
  void find(const StatePath<double>& path, SwitchSink<double>& sink) const override {
    sink.add({.offset = 1e-3 * path.length, .to = 1, .at_end = 1, .jump = 1.0, .speed = 1.0, .kind = "test"});
  }
  void find(const StatePath<Float128>&, SwitchSink<Float128>&) const override {}
  void acting(const double*, SwitchSink<double>&) const override {}
};

TEST(Switching, SwitchesWithoutEndAreTold) {
  using Cutter = integrators::SwitchCutter<double>;
  Cutter cutter(1e-9, 1e-9, 1e-12, true);
  const double y[2] = {0.0, 1.0};
  double t = 0.0;
  int steps = 0;
  for (;; ++steps) {
    ASSERT_LT(steps, 100'000);
    const double end = std::min(t + 1e-9, cutter.limit());
    const Cutter::Verdict verdict = cutter.judge(EverySurface{}, {t, end - t, y, y});
    if (verdict == Cutter::Verdict::chatters) break;
    if (verdict != Cutter::Verdict::again) t = end;
  }
  EXPECT_GT(cutter.crossed(), 1000u);
}

TEST(Switching, TheLongestStepIsAnOptionOfEveryAdaptiveMethod) {
  Ivp ivp = falling_net(0.1);
  ivp.t1 = 0.004;  // before the impact
  for (const auto& method : adaptive_methods(*ivp.system)) {
    const std::string name = method->info().name;
    integrators::StepRecord record;
    const Solution found =
        make_method(name + "[maximum_step=1.01e-4]")
            ->solve(ivp, AdaptiveStep{.relative_tolerance = 1e-2, .absolute_tolerance = 1e-2}, record);
    ASSERT_TRUE(found.status.ok()) << name << ": " << found.status.describe();
    for (std::size_t k = 1; k < record.times.size(); ++k) {
      EXPECT_LE(record.times[k] - record.times[k - 1], 1.0101e-4) << name;
    }
  }
  EXPECT_THROW(make_method("rk4[maximum_step=0.1]"), InputError);
  EXPECT_THROW(make_method("dormand_prince_54[maximum_step=-1]"), InputError);
  EXPECT_THROW(make_method("dormand_prince_54[maximum_step=long]"), InputError);
}

}  // namespace
}  // namespace fw::catalog
