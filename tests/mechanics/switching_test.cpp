#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "mechanics/mass_spring_system.hpp"

namespace fw::mechanics {
namespace {

struct Found final : SwitchSink<double> {
  void add(const Switch<double>& found) override { list.push_back(found); }
  std::vector<Switch<double>> list;
};

MassSpringModel with_obstacle(const Obstacle& obstacle) {
  MassSpringModel model;
  model.mass = {2.0};
  model.obstacles = {obstacle};
  return model;
}

std::vector<Switch<double>> switches(const MassSpringSystem& system, const Vector& from, const Vector& to,
                                     double h) {
  Found found;
  system.switching_surfaces()->find({0.0, h, from.data(), to.data()}, found);
  return found.list;
}

/// The Hermite cubic of a state (q, v) at the fraction s of the step.
Vector on_path(const Vector& from, const Vector& to, double h, double s) {
  const Index n = from.size() / 2;
  const double r = 1.0 - s;
  Vector y(2 * n);
  y.head(n) = from.head(n) + (s * s * (1.0 + 2.0 * r)) * (to.head(n) - from.head(n)) +
              (h * s * r) * (r * from.tail(n) - s * to.tail(n));
  y.tail(n) = (6.0 * s * r / h) * (to.head(n) - from.head(n)) + r * (1.0 - 3.0 * s) * from.tail(n) +
              s * (3.0 * s - 2.0) * to.tail(n);
  return y;
}

/// Where a fine sampling of the path first sees another force law, by whether the force is zero; infinite: nowhere.
double sampled(const MassSpringSystem& system, const Vector& from, const Vector& to, double h) {
  const auto acts = [&](double s) {
    Found found;
    system.switching_surfaces()->acting(on_path(from, to, h, s).data(), found);
    return found.list.empty() ? 0 : found.list.front().to;
  };
  const int start = acts(0.0);
  constexpr int samples = 4000;
  for (int k = 1; k <= samples; ++k) {
    if (acts(static_cast<double>(k) / samples) != start) return static_cast<double>(k) / samples;
  }
  return std::numeric_limits<double>::infinity();
}

TEST(SwitchingSurfaces, AreThoseThatAFineSamplingFinds) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  const std::vector<Obstacle> obstacles = {{Plane{{0.1, 0.0, 0.0}, {0.6, 0.0, 0.8}}, 100.0, 0.0},
                                           {Sphere{{0.1, 0.2, 0.0}, 0.5}, 100.0, 0.0},
                                           {Box{{-0.3, -0.4, -0.2}, {0.1, 0.5, 0.3}}, 100.0, 0.0},
                                           {Plane{{0.1, 0.0, 0.0}, {0.6, 0.0, 0.8}}, 100.0, 60.0},
                                           {Sphere{{0.1, 0.2, 0.0}, 0.5}, 100.0, 60.0},
                                           {Box{{-0.3, -0.4, -0.2}, {0.1, 0.5, 0.3}}, 100.0, 60.0}};
  int met = 0;
  for (const Obstacle& obstacle : obstacles) {
    const MassSpringSystem system(with_obstacle(obstacle));
    for (int trial = 0; trial < 60; ++trial) {
      Vector from(6), to(6);
      for (Index i = 0; i < 6; ++i) {
        from[i] = number(random);
        to[i] = number(random);
      }
      const double h = 0.5;
      const double expected = sampled(system, from, to, h);
      const auto found = switches(system, from, to, h);
      const double place = found.empty() ? std::numeric_limits<double>::infinity() : found.front().offset / h;
      if (std::isfinite(expected)) {
        ++met;
        // A sample may pass over a dip that the search finds, never the other way round.
        EXPECT_LE(place, expected + 1e-12) << trial;
        if (place < expected - 2.0 / 4000) {
          const Vector y = on_path(from, to, h, place);
          Found at;
          system.switching_surfaces()->acting(y.data(), at);
          EXPECT_EQ(at.list.empty() ? 0 : at.list.front().to, found.front().to) << trial;
        }
      }
    }
  }
  EXPECT_GT(met, 100);
}

TEST(SwitchingSurfaces, AThinPlateIsNotPassedOverHoweverLongTheStep) {
  for (const double thickness : {1e-1, 1e-4, 1e-9}) {
    const MassSpringSystem system(
        with_obstacle({Box{{0.3, -1.0, -1.0}, {0.3 + thickness, 1.0, 1.0}}, 1e9, 0.0}));
    Vector from(6), to(6);
    from << 0.0, 0.1, 0.2, 1000.0, 0.0, 0.0;
    to << 1000.0, 0.1, 0.2, 1000.0, 0.0, 0.0;
    const auto found = switches(system, from, to, 1.0);
    ASSERT_EQ(found.size(), 1u) << thickness;
    EXPECT_NEAR(found[0].offset, 3e-4, 1e-13);
    EXPECT_EQ(found[0].at_end, 0);
    EXPECT_DOUBLE_EQ(found[0].thickness, (0.3 + thickness) - 0.3);
    EXPECT_DOUBLE_EQ(found[0].frequency, std::sqrt(1e9 / 2.0));
  }
}

TEST(SwitchingSurfaces, ARopeThatIsTautWithinAStepOnlyIsSeen) {
  MassSpringModel model;
  model.mass = {1.0, 3.0};
  model.springs.law = SpringLaw::tension_only;
  model.springs.add(0, 1, {50.0, 0.0, 1.0});
  const MassSpringSystem system(model);
  Vector from = Vector::Zero(12), to = Vector::Zero(12);
  from[3] = to[3] = 0.9;
  from[9] = 2.0;
  to[9] = -2.0;  // out to 0.9 + 2·0.2/4 = 1.0 and a little beyond
  const double h = 0.21;
  const auto found = switches(system, from, to, h);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].to, 1);
  EXPECT_EQ(found[0].at_end, 0);
  const double s = found[0].offset / h;
  EXPECT_NEAR(0.9 + 2.0 * h * s * (1.0 - s), 1.0, 1e-14);
  EXPECT_EQ(place_of(found[0]), "springs[0] between particles 0 and 1");
}

TEST(SwitchingSurfaces, RoundingAtRestIsNoSwitchInsideAStep) {
  const MassSpringSystem system(with_obstacle({Plane{{0.1, 0.0, 0.0}, {1.0, 0.0, 0.0}}, 1e9, 0.0}));
  Vector from = Vector::Zero(6), to = Vector::Zero(6);
  from[0] = to[0] = 0.1;
  EXPECT_TRUE(switches(system, from, to, 0.1).empty());
  to[0] = std::nextafter(0.1, 0.0);
  const auto found = switches(system, from, to, 0.1);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].offset, 0.1);  // the end of the step, where it can do nothing
}

TEST(SwitchingSurfaces, SmoothSystemsAnnounceNone) {
  MassSpringModel model;
  model.mass = {1.0, 1.0};
  model.springs.add(0, 1, {10.0, 0.1, 1.0});
  EXPECT_EQ(MassSpringSystem(model).switching_surfaces(), nullptr);
}

}  // namespace
}  // namespace fw::mechanics
