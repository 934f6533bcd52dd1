#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <random>
#include <set>

#include "core/error.hpp"
#include "paths.hpp"
#include "scene/scene.hpp"
#include "scene_comparison.hpp"

namespace fw::scene {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(SceneFormat, ReadsTheContractsExample) {
  const Scene scene = parse_scene(R"(
title = "double spring"
[world]
gravity = [0.0, 0.0, -9.81]      # m/s²; default zero
drag = 0.25                      # kg/s, force −drag·v on every mass; default 0
[particles]
position = [[0,0,0], [1,0,0]]    # m
velocity = [[0,0,0], [0,0,2]]    # m/s; default zero
mass = [1.0, 2.0]                # kg, > 0; or one number for all
fixed = [0]                      # indices that never move; default none
[springs]
between = [[0,1]]
stiffness = 100.0                # one number or one per spring
damping = 0.5                    # N·s/m; default 0
rest_length = [0.9]              # m; default: the distance at the start
law = "hooke"
)",
                                  "a.toml");
  EXPECT_EQ(scene.title, "double spring");
  EXPECT_EQ(scene.model.gravity, (Vec3<double>{0, 0, -9.81}));
  EXPECT_EQ(scene.model.drag, 0.25);
  EXPECT_EQ(scene.position, (Vector(6) << 0, 0, 0, 1, 0, 0).finished());
  EXPECT_EQ(scene.velocity, (Vector(6) << 0, 0, 0, 0, 0, 2).finished());
  EXPECT_THAT(scene.model.mass, ElementsAre(1, 2));
  EXPECT_THAT(scene.model.fixed, ElementsAre(0));
  EXPECT_THAT(scene.model.springs.first, ElementsAre(0));
  EXPECT_THAT(scene.model.springs.second, ElementsAre(1));
  EXPECT_THAT(scene.model.springs.stiffness, ElementsAre(100));
  EXPECT_THAT(scene.model.springs.damping, ElementsAre(0.5));
  EXPECT_THAT(scene.model.springs.rest_length, ElementsAre(0.9));
  EXPECT_EQ(scene.model.springs.law, mechanics::SpringLaw::hooke);
  EXPECT_THAT(scene.warnings, IsEmpty());
  EXPECT_EQ(initial_state(scene), (Vector(12) << 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 2).finished());
}

TEST(SceneFormat, FillsEveryDefault) {
  const Scene scene = parse_scene(R"(
[particles]
position = [[0,0,0], [3,4,0], [3,4,2]]
mass = 2
[springs]
between = [[0,1], [1,2], [0,1]]
stiffness = 7
)",
                                  "a.toml");
  EXPECT_EQ(scene.title, "");
  EXPECT_EQ(scene.model.gravity, Vec3<double>{});
  EXPECT_EQ(scene.model.drag, 0.0);
  EXPECT_EQ(scene.velocity, Vector::Zero(9));
  EXPECT_THAT(scene.model.mass, ElementsAre(2, 2, 2));
  EXPECT_THAT(scene.model.fixed, IsEmpty());
  EXPECT_THAT(scene.model.springs.stiffness, ElementsAre(7, 7, 7));
  EXPECT_THAT(scene.model.springs.damping, ElementsAre(0, 0, 0));
  EXPECT_THAT(scene.model.springs.rest_length, ElementsAre(5, 2, 5)) << "parallel springs are allowed";
  EXPECT_EQ(scene.model.springs.law, mechanics::SpringLaw::hooke);
  EXPECT_THAT(scene.model.anchors, IsEmpty());
  EXPECT_THAT(scene.model.obstacles, IsEmpty());
  EXPECT_EQ(scene.resolved_toml,
            "title = \"\"\n"
            "\n[particles]\nfixed = []\nmass = 2\nposition = [[0, 0, 0], [3, 4, 0], [3, 4, 2]]\n"
            "velocity = [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]]\n"
            "\n[springs]\nbetween = [[0, 1], [1, 2], [0, 1]]\ndamping = 0.0\nlaw = \"hooke\"\n"
            "rest_length = [5.0, 2.0, 5.0]\nstiffness = 7\n"
            "\n[world]\ndrag = 0.0\ngravity = [0.0, 0.0, 0.0]\n");
}

TEST(SceneFormat, AllowsFreeParticlesWithoutSprings) {
  const std::string particles = "[particles]\nposition = [[1,2,3]]\nmass = 1\n";
  EXPECT_EQ(parse_scene(particles, "a.toml").model.springs.size(), 0u);
  EXPECT_EQ(parse_scene(particles + "[springs]\nbetween = []\n", "a.toml").model.springs.size(), 0u);
  EXPECT_EQ(
      parse_scene(particles + "[springs]\nbetween = []\nstiffness = 3\n", "a.toml").model.springs.size(), 0u);
}

TEST(SceneFormat, KnowsEveryLaw) {
  using mechanics::SpringLaw;
  for (const auto& [name, law] :
       {std::pair{"hooke", SpringLaw::hooke}, std::pair{"strain", SpringLaw::strain},
        std::pair{"tension_only", SpringLaw::tension_only}}) {
    const std::string text = std::string("[particles]\nposition = [[0,0,0],[1,0,0]]\nmass = 1\n[springs]\n") +
                             "between = [[0,1]]\nstiffness = 1\nlaw = '" + name + "'\n";
    EXPECT_EQ(parse_scene(text, "a.toml").model.springs.law, law);
  }
}

TEST(SceneFormat, ReadsGroupsOfSpringsWithLawsOfTheirOwn) {
  const std::string particles = "[particles]\nposition = [[0,0,0],[1,0,0],[3,0,0]]\nmass = 1\n";
  const Scene scene =
      parse_scene(particles +
                      "[[springs]]\nname = 'frame'\nbetween = [[0,1],[1,2]]\nstiffness = [7, 8]\n"
                      "[[springs]]\nbetween = []\n"
                      "[[springs]]\nname = 'rope'\nlaw = 'tension_only'\nbetween = [[0,2]]\n"
                      "stiffness = 9\ndamping = 0.5\nrest_length = 2\n",
                  "a.toml");
  const mechanics::Springs& springs = scene.model.springs;
  EXPECT_THAT(springs.first, ElementsAre(0, 1, 0));
  EXPECT_THAT(springs.second, ElementsAre(1, 2, 2));
  EXPECT_THAT(springs.stiffness, ElementsAre(7, 8, 9));
  EXPECT_THAT(springs.damping, ElementsAre(0, 0, 0.5));
  EXPECT_THAT(springs.rest_length, ElementsAre(1, 2, 2));
  ASSERT_EQ(springs.groups.size(), 3u);
  EXPECT_EQ(springs.groups[0].name, "frame");
  EXPECT_EQ(springs.groups[0].law, mechanics::SpringLaw::hooke);
  EXPECT_EQ(springs.groups[0].size, 2u);
  EXPECT_EQ(springs.groups[1].size, 0u);
  EXPECT_EQ(springs.groups[2].law, mechanics::SpringLaw::tension_only);
  EXPECT_EQ(springs.law_of(1), mechanics::SpringLaw::hooke);
  EXPECT_EQ(springs.law_of(2), mechanics::SpringLaw::tension_only);
  expect_same_scene(parse_scene(scene.resolved_toml, "resolved"), scene);
}

TEST(SceneFormat, AcceptsCoincidentPointsIfTheRestLengthIsGiven) {
  const std::string text =
      "[particles]\nposition = [[0,0,0],[0,0,0]]\nmass = 1\n[springs]\nbetween = [[0,1]]\nstiffness = 1\n";
  EXPECT_THAT(parse_scene(text + "rest_length = 0\n", "a.toml").model.springs.rest_length, ElementsAre(0));
  EXPECT_THAT(parse_scene(text + "rest_length = [2]\n", "a.toml").model.springs.rest_length, ElementsAre(2));
}

TEST(SceneFormat, IgnoresTheVelocityOfAFixedParticleAudibly) {
  const Scene scene = parse_scene(
      "[particles]\nposition = [[0,0,0],[1,0,0],[2,0,0]]\nmass = 1\nfixed = [2, 0]\n"
      "velocity = [[0,0,0],\n[1,1,1],\n[0,5,0]]\n",
      "a.toml");
  EXPECT_EQ(scene.velocity, (Vector(9) << 0, 0, 0, 1, 1, 1, 0, 0, 0).finished());
  EXPECT_THAT(scene.warnings,
              ElementsAre("a.toml:7: [particles] velocity[2]: velocity of fixed particle 2 is ignored"));
  EXPECT_THAT(scene.model.fixed, ElementsAre(2, 0));
}

TEST(SceneFormat, ReadsAnchors) {
  const std::string text = "[particles]\nposition = [[0,0,0],[1,0,0],[2,0,0]]\nmass = 1\nfixed = [1]\n";
  const Scene scene =
      parse_scene(text +
                      "[[anchor]]\nparticle = 2\nstiffness = 3\ndamping = 0.5\nposition = [0,9,0]\n"
                      "[[anchor]]\nparticle = [0, 2]\nstiffness = 4\n"
                      "[[anchor]]\nparticle = 'all'\nstiffness = 5\n",
                  "a.toml");
  const auto& anchors = scene.model.anchors;
  ASSERT_EQ(anchors.size(), 6u);
  EXPECT_EQ(anchors[0].particle, 2);
  EXPECT_EQ(anchors[0].stiffness, 3.0);
  EXPECT_EQ(anchors[0].damping, 0.5);
  EXPECT_EQ(anchors[0].rest_position, (Vec3<double>{0, 9, 0}));
  EXPECT_EQ(anchors[2].particle, 2);
  EXPECT_EQ(anchors[2].damping, 0.0);
  EXPECT_EQ(anchors[2].rest_position, (Vec3<double>{2, 0, 0})) << "by default where the particle starts";
  EXPECT_EQ(anchors[4].particle, 1);
  EXPECT_EQ(anchors[4].stiffness, 5.0);
  EXPECT_THAT(scene.warnings,
              ElementsAre("a.toml:13: [anchor[2]]: 1 of the 3 anchored particles is fixed: there the "
                          "anchor has no effect"));
}

TEST(SceneFormat, ReadsObstacles) {
  const std::string text = "[particles]\nposition = [[0,0,0]]\nmass = 1\n";
  const Scene scene = parse_scene(
      text +
          "[[obstacle]]\nshape = 'plane'\npoint = [1,2,3]\nnormal = [0,3,4]\nstiffness = 10\ndamping = 2\n"
          "[[obstacle]]\nshape = 'sphere'\ncentre = [1,0,0]\nradius = 0.5\nstiffness = 11\n"
          "[[obstacle]]\nshape = 'box'\nlower = [-1,-1,-1]\nupper = [1,2,3]\nstiffness = 12\n",
      "a.toml");
  ASSERT_EQ(scene.model.obstacles.size(), 3u);
  const auto& plane = std::get<mechanics::Plane>(scene.model.obstacles[0].shape);
  EXPECT_EQ(plane.point, (Vec3<double>{1, 2, 3}));
  EXPECT_NEAR(plane.normal.y, 0.6, 1e-16);
  EXPECT_NEAR(plane.normal.z, 0.8, 1e-15);
  EXPECT_EQ(scene.model.obstacles[0].stiffness, 10.0);
  EXPECT_EQ(scene.model.obstacles[0].damping, 2.0);
  const auto& sphere = std::get<mechanics::Sphere>(scene.model.obstacles[1].shape);
  EXPECT_EQ(sphere.centre, (Vec3<double>{1, 0, 0}));
  EXPECT_EQ(sphere.radius, 0.5);
  EXPECT_EQ(scene.model.obstacles[1].damping, 0.0);
  const auto& box = std::get<mechanics::Box>(scene.model.obstacles[2].shape);
  EXPECT_EQ(box.lower, (Vec3<double>{-1, -1, -1}));
  EXPECT_EQ(box.upper, (Vec3<double>{1, 2, 3}));
}

TEST(SceneFormat, GivesTheSameSceneFromItsResolvedText) {
  std::mt19937_64 random(20111);  // seed of this test
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::string text =
      "title = 'random \"scene\"'\n[world]\ngravity = [0.1, 1e-300, -9.81]\ndrag = "
      "0.1\n[particles]\nposition = [";
  constexpr int n = 50;
  for (int i = 0; i < n; ++i)
    text += fmt::format("[{}, {}, {}],", uniform(random), uniform(random), uniform(random));
  text += "]\nfixed = [3, 1]\nvelocity = [";
  for (int i = 0; i < n; ++i)
    text += fmt::format("[{}, {}, {}],", uniform(random), uniform(random), uniform(random));
  text += "]\nmass = [";
  for (int i = 0; i < n; ++i) text += fmt::format("{},", 1.0 + uniform(random) / 3.0);
  text += "]\n[springs]\nstiffness = 0.3\nlaw = 'strain'\nbetween = [";
  for (int i = 0; i + 7 < n; ++i) text += fmt::format("[{}, {}],", i, i + 7);
  text += "]\n[[anchor]]\nparticle = 5\nstiffness = 0.7\n[[obstacle]]\nshape = 'plane'\npoint = [0,0,0]\n";
  text += "normal = [0.1, 0.2, 0.3]\nstiffness = 1\n";
  const Scene scene = parse_scene(text, "a.toml");
  EXPECT_EQ(scene.warnings.size(), 2u);
  const Scene again = parse_scene(scene.resolved_toml, "b.toml");
  expect_same_scene(scene, again);
  EXPECT_EQ(again.resolved_toml, scene.resolved_toml);
}

TEST(SceneFormat, MakesAnInitialValueProblem) {
  const Scene scene = parse_scene(
      "[world]\ngravity = [0,0,-2]\n[particles]\nposition = [[0,0,0],[1,0,0]]\nvelocity = [[0,0,3],[0,0,0]]\n"
      "mass = 1\n[springs]\nbetween = [[0,1]]\nstiffness = 10\nrest_length = 0.5\n",
      "a.toml");
  const Ivp ivp = make_ivp(scene, 2.5);
  EXPECT_EQ(ivp.t0, 0.0);
  EXPECT_EQ(ivp.t1, 2.5);
  Vector rate(12);
  ivp.system->rhs(0.0, ivp.y0, rate);
  EXPECT_EQ(rate, (Vector(12) << 0, 0, 3, 0, 0, 0, 5, 0, -2, -5, 0, -2).finished());
  EXPECT_THROW(make_ivp(scene, 0.0), InputError);
  EXPECT_THROW(make_ivp(scene, std::numeric_limits<double>::infinity()), InputError);
}

TEST(SceneFormat, ReadsEverySceneOfTheProject) {
  // Studies disturb these: stability and propagation about a state of rest, buckling.
  const std::set<std::string> at_rest = {"free_spring", "uneven_chain", "damped_chain", "buckling_chain",
                                         "resting_cloth"};
  std::size_t scenes = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(fw::test::source_directory() + "/studies/scenes")) {
    if (entry.path().extension() != ".toml") continue;
    SCOPED_TRACE(entry.path().string());
    ++scenes;
    const Scene scene = read_scene(entry.path());
    EXPECT_FALSE(scene.title.empty());
    EXPECT_THAT(scene.warnings, IsEmpty());
    expect_same_scene(scene, parse_scene(scene.resolved_toml, "resolved"));
    Vector rate(6 * static_cast<Index>(scene.model.mass.size()));
    const Ivp ivp = make_ivp(scene, 1.0);
    ivp.system->rhs(0.0, ivp.y0, rate);
    EXPECT_TRUE(rate.allFinite());
    EXPECT_EQ(rate.norm() == 0.0, at_rest.contains(entry.path().stem().string())) << "does it move?";
  }
  EXPECT_GE(scenes, 10u);
}

TEST(SceneFormat, ReportsAMissingFile) {
  try {
    read_scene("/nonexistent/scene.toml");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "/nonexistent/scene.toml: no such file");
  }
}

}  // namespace
}  // namespace fw::scene
