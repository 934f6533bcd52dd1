// Every scene by ARKODE and IDA, against CVODE.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "integrators/network.hpp"
#include "oracles/sundials/arkode.hpp"
#include "oracles/sundials/arkode_mri.hpp"
#include "oracles/sundials/cvode.hpp"
#include "oracles/sundials/ida.hpp"
#include "paths.hpp"
#include "scene/scene.hpp"

namespace fw::oracles {
namespace {

/// Large cloths for a few steps of the implicit methods only.
double end_time(const scene::Scene& scene) {
  return scene.model.mass.size() > 100 ? 0.002 : 0.1;
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
  double error = 0.0;  ///< largest difference from the run with tolerances (steps) that are coarser
};

/// The end state and how far it moved when tolerances fell from 1e-7 to 1e-9, or steps were halved.
Estimate refined(const Integrator& method, const Ivp& ivp) {
  NullObserver observer;
  const auto end = [&](const StepControl& control) {
    const Solution solution = method.solve(ivp, control, observer);
    EXPECT_TRUE(solution.status.ok()) << method.info().name << ": " << solution.status.describe();
    return solution.state;
  };
  const bool is_adaptive = method.info().is_adaptive;
  const auto control = [&](bool fine) -> StepControl {
    const int steps = ivp.y0.size() > 600 ? 10 : 100;
    if (!is_adaptive) return FixedStep{.step = (ivp.t1 - ivp.t0) / (fine ? 2 * steps : steps)};
    const double tolerance = fine ? 1e-9 : 1e-7;
    return AdaptiveStep{.relative_tolerance = tolerance, .absolute_tolerance = 1e-2 * tolerance};
  };
  Estimate estimate{end(control(true))};
  estimate.error = (estimate.state - end(control(false))).lpNorm<Eigen::Infinity>();
  return estimate;
}

TEST(Scenes, EndWhereCvodeEndsThemByEveryMethodThatApplies) {
  std::vector<std::unique_ptr<Integrator>> methods;
  methods.push_back(make_arkode_erk());
  methods.push_back(make_arkode_dirk());
  methods.push_back(make_arkode_imex());
  methods.push_back(make_arkode_mri());
  methods.push_back(make_arkode_mri({.inner_steps = 0}));
  methods.push_back(make_arkode_mri({.inner_is_implicit = true}));
  methods.push_back(make_ida());
  EXPECT_GE(scenes().size(), 14u);
  int compared = 0;
  for (const std::filesystem::path& path : scenes()) {
    const scene::Scene scene = scene::read_scene(path);
    const Ivp ivp = scene::make_ivp(scene, end_time(scene));
    const Estimate cvode = refined(*make_cvode_bdf(), ivp);
    const double scale = cvode.state.lpNorm<Eigen::Infinity>();
    for (const auto& method : methods) {
      if (!why_not_applicable(method->info(), *ivp.system).empty()) continue;
      const Estimate found = refined(*method, ivp);
      const double difference = (found.state - cvode.state).lpNorm<Eigen::Infinity>();
      RecordProperty(fmt::format("{} {}", path.stem().string(), method->info().title),
                     fmt::format("difference {:.2g}, estimates {:.2g} and {:.2g}", difference, found.error,
                                 cvode.error));
      EXPECT_LE(difference, found.error + cvode.error + 1e-11 * scale)
          << path.filename() << " " << method->info().title;
      // An estimate that is large would agree with anything.
      EXPECT_LE(found.error, 1e-4 * scale) << path.filename() << " " << method->info().title;
      ++compared;
    }
  }
  EXPECT_GE(compared, 80);
}

}  // namespace
}  // namespace fw::oracles
