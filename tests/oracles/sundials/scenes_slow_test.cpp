// Every scene by ARKODE and IDA, against CVODE.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "integrators/network.hpp"
#include "mechanics/mass_spring_system.hpp"
#include "oracles/sundials/arkode.hpp"
#include "oracles/sundials/arkode_mri.hpp"
#include "oracles/sundials/cvode.hpp"
#include "oracles/sundials/ida.hpp"
#include "paths.hpp"
#include "scene/scene.hpp"

namespace fw::oracles {
namespace {

/// Cloths and grids for a few steps of the implicit methods only.
constexpr Index small = 200, large = 300;  ///< unknowns

double end_time(const scene::Scene& scene) {
  return 6 * static_cast<Index>(scene.model.mass.size()) > large ? 0.002 : 0.1;
}

std::vector<std::filesystem::path> scenes() {
  std::vector<std::filesystem::path> list;
  for (const auto& entry :
       std::filesystem::directory_iterator(fw::test::source_directory() + "/studies/scenes")) {
    if (entry.path().extension() == ".toml") list.push_back(entry.path());
  }
  std::sort(list.begin(), list.end());
  return list;
}

struct Estimate {
  Vector state;
  double error = 0.0;  ///< largest difference from runs with tolerances (steps) that are coarser
};

/// The end state and how far it moved when tolerances fell from 1e-7 to 1e-9, or steps were halved. A kink of the
/// forces falls anywhere into a step, so that halving it can leave the error as it was: there a third run, with steps of
/// twice the length, takes part.
Estimate refined(const Integrator& method, const Ivp& ivp, bool has_kinks) {
  NullObserver observer;
  const auto end = [&](const StepControl& control) {
    const Solution solution = method.solve(ivp, control, observer);
    EXPECT_TRUE(solution.status.ok()) << method.info().name << ": " << solution.status.describe();
    return solution.state;
  };
  const bool is_adaptive = method.info().is_adaptive;
  const auto control = [&](int refinement) -> StepControl {
    const int steps = ivp.y0.size() > large ? 4 : ivp.y0.size() > small ? 25 : 100;
    if (!is_adaptive) return FixedStep{.step = std::ldexp((ivp.t1 - ivp.t0) / steps, -refinement)};
    const double tolerance = refinement > 0 ? 1e-9 : 1e-7;
    return AdaptiveStep{.relative_tolerance = tolerance, .absolute_tolerance = 1e-2 * tolerance};
  };
  Estimate estimate{end(control(1))};
  for (const int coarser : has_kinks && !is_adaptive ? std::vector{0, -1} : std::vector{0}) {
    estimate.error =
        std::max(estimate.error, (estimate.state - end(control(coarser))).lpNorm<Eigen::Infinity>());
  }
  return estimate;
}

class Scenes : public ::testing::TestWithParam<std::filesystem::path> {};

TEST_P(Scenes, EndWhereCvodeEndsThemByEveryMethodThatApplies) {
  const scene::Scene scene = scene::read_scene(GetParam());
  const Ivp ivp = scene::make_ivp(scene, end_time(scene));
  std::vector<std::unique_ptr<Integrator>> methods;
  methods.push_back(make_arkode_erk());
  methods.push_back(make_arkode_dirk());
  methods.push_back(make_arkode_imex());
  methods.push_back(make_arkode_mri());
  methods.push_back(make_arkode_mri({.inner_steps = 0}));
  methods.push_back(
      make_arkode_mri({.inner_is_implicit = true, .inner_steps = ivp.y0.size() > small ? 5 : 20}));
  methods.push_back(make_ida());
  const auto& system = dynamic_cast<const mechanics::MassSpringSystem&>(*ivp.system);
  const bool has_kinks = system.elements().has_kinks();
  const Estimate cvode = refined(*make_cvode_bdf(), ivp, has_kinks);
  const double scale = cvode.state.lpNorm<Eigen::Infinity>();
  EXPECT_LE(cvode.error, 1e-4 * scale);
  int compared = 0;
  for (const auto& method : methods) {
    if (!why_not_applicable(method->info(), *ivp.system).empty()) continue;
    const Estimate found = refined(*method, ivp, has_kinks);
    const double difference = (found.state - cvode.state).lpNorm<Eigen::Infinity>();
    RecordProperty(method->info().title, fmt::format("difference {:.2g}, estimates {:.2g} and {:.2g}",
                                                     difference, found.error, cvode.error));
    EXPECT_LE(difference, found.error + cvode.error + 1e-11 * scale) << method->info().title;
    // An estimate that is large would agree with anything.
    EXPECT_LE(found.error, 1e-4 * scale) << method->info().title;
    ++compared;
  }
  // ARKODE explicit and implicit and IDA go everywhere; the four with splitting where there are springs to split.
  EXPECT_EQ(compared, system.force_splitting() == nullptr ? 3 : 7);
}

TEST(ListOfScenes, IsWhole) {
  EXPECT_GE(scenes().size(), 25u);
}

INSTANTIATE_TEST_SUITE_P(Studies, Scenes, ::testing::ValuesIn(scenes()),
                         [](const auto& tested) { return tested.param.stem().string(); });

}  // namespace
}  // namespace fw::oracles
