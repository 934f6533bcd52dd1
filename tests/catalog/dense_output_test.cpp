#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "analysis/reference/gragg_extrapolation.hpp"
#include "analysis/verification/verification_problems.hpp"
#include "catalog/methods.hpp"
#include "problems/oscillators.hpp"

namespace fw::catalog {
namespace {

constexpr int frame_count = 60;

/// A problem and its states at evenly spaced times to 1e-20, the last of them the end.
struct KnownMotion {
  std::string name;
  Ivp ivp;
  std::vector<double> times{};
  std::vector<std::vector<Float128>> exact{};
};

KnownMotion known_motion(std::string name, Ivp ivp, double length) {
  KnownMotion motion{std::move(name), std::move(ivp)};
  motion.ivp.t1 = motion.ivp.t0 + length;
  for (int k = 1; k <= frame_count; ++k) {
    motion.times.push_back(k == frame_count ? motion.ivp.t1 : motion.ivp.t0 + length * k / frame_count);
  }
  const auto run = analysis::integrate_by_extrapolation(
      motion.ivp, motion.times,
      {.tableau = analysis::harmonic_extrapolation(8), .tolerance = 1e-20, .least_steps = 4});
  EXPECT_TRUE(run.status.ok()) << run.status.describe();
  motion.exact = run.states;
  return motion;
}

class FrameErrors final : public Observer {
 public:
  explicit FrameErrors(const KnownMotion& motion) : motion_(motion) {}
  bool observe(const StepView& view) override {
    Vector inside(view.state.size());
    const std::size_t last = motion_.times.size() - 1;
    for (; view.index > 0 && next_ < last && motion_.times[next_] < view.time; ++next_) {
      view.interpolate(motion_.times[next_], inside);
      const double error = analysis::relative_error(inside, motion_.exact[next_]);
      if (error > frames || std::isnan(error)) frames = error;
      ++seen;
    }
    if (view.last) end = analysis::relative_error(view.state, motion_.exact[last]);
    return true;
  }
  double frames = 0.0, end = 0.0;
  int seen = 0;

 private:
  const KnownMotion& motion_;
  std::size_t next_ = 0;
};

/// Every method with tolerances, own and foreign: what is stored between the steps is as good as the steps.
TEST(DenseOutput, FramesErrAtMostTenTimesAsMuchAsTheEnd) {
  const std::vector<KnownMotion> motions = {
      known_motion("harmonic oscillator", problems::harmonic_oscillator().ivp, 20.0),
      known_motion("spring network", analysis::spring_network(), 2.0),
      known_motion("damped spring network", analysis::damped_spring_network(), 2.0)};
  int methods_seen = 0;
  for (const MethodEntry& entry : methods()) {
    if (!entry.info().is_adaptive) continue;
    ++methods_seen;
    const bool is_low = entry.info().order == 1 || entry.info().order == 2;
    const double tolerance = is_low ? 1e-4 : 1e-8;
    int runs = 0;
    for (const KnownMotion& motion : motions) {
      const std::unique_ptr<Integrator> method = entry.make({});
      if (!why_not_applicable(method->info(), *motion.ivp.system).empty()) continue;
      FrameErrors errors(motion);
      const Solution solution = method->solve(
          motion.ivp, AdaptiveStep{.relative_tolerance = tolerance, .absolute_tolerance = tolerance}, errors);
      const std::string where = entry.name + " on " + motion.name;
      ASSERT_TRUE(solution.status.ok()) << where << ": " << solution.status.describe();
      EXPECT_EQ(errors.seen, frame_count - 1) << where;
      EXPECT_LE(errors.frames, 10.0 * std::max(errors.end, 1e-14)) << where;
      EXPECT_GE(errors.frames, 0.0) << where;
      ++runs;
    }
    EXPECT_GE(runs, 1) << entry.name;
  }
  EXPECT_GE(methods_seen, 46);
}

}  // namespace
}  // namespace fw::catalog
