#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/error.hpp"
#include "scene/scene.hpp"
#include "scene_comparison.hpp"

namespace fw::scene {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// In lines 1 to 6.
const std::string driven_pair =
    "[particles]\nposition = [[0,0,0], [1,0,0], [2,0,0]]\nmass = 2\n"
    "[springs]\nbetween = [[0,1], [1,2]]\nstiffness = [10, 30]\n";

std::string refusal_of(const std::string& text) {
  try {
    parse_scene(text, "s.toml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(DrivingScene, ReadsForcesAndSupportsInEveryForm) {
  const Scene scene =
      parse_scene(driven_pair +
                      "[[force]]\nparticle = 1\nvalue = [1, 2, 3]\n"
                      "[[force]]\nparticle = 'all'\ntable = { t = [0, 2], value = [[0,0,0], [4,0,0]] }\n"
                      "[[force]]\nparticle = [0, 2]\nexpression = ['2*cos(t)', '0', 't']\n"
                      "[[anchor]]\nparticle = 0\nstiffness = 5\nvelocity = [0.5, 0, 0]\n"
                      "[[anchor]]\nparticle = [1, 2]\nstiffness = 6\nexpression = ['0', 'sin(t)', '0']\n"
                      "[[anchor]]\nparticle = 2\nposition = [0,0,0]\nstiffness = 7\ntable = { t = [1], value "
                      "= [[1,1,1]] }\n"
                      "[[anchor]]\nparticle = 2\nstiffness = 8\n",
                  "a.toml");
  const auto& forces = scene.model.forces;
  ASSERT_EQ(forces.size(), 3u);
  EXPECT_EQ(forces[0].force(7.0).value, (Vec3<double>{1, 2, 3}));
  EXPECT_THAT(forces[1].particles, ElementsAre(0, 1, 2));
  EXPECT_EQ(forces[1].force(0.5).value, (Vec3<double>{1, 0, 0}));
  EXPECT_THAT(forces[2].particles, ElementsAre(0, 2));
  EXPECT_EQ(forces[2].force(3.0).value, (Vec3<double>{2 * std::cos(3.0), 0, 3}));
  const auto& motions = scene.model.support_motions;
  ASSERT_EQ(motions.size(), 3u);
  EXPECT_THAT(motions[0].anchors, ElementsAre(0));
  EXPECT_EQ(motions[0].displacement(2.0).value, (Vec3<double>{1, 0, 0}));
  EXPECT_EQ(motions[0].displacement(2.0).rate, (Vec3<double>{0.5, 0, 0}));
  EXPECT_THAT(motions[1].anchors, ElementsAre(1, 2));
  EXPECT_EQ(motions[1].displacement(0.0).rate, (Vec3<double>{0, 1, 0}));
  EXPECT_THAT(motions[2].anchors, ElementsAre(3));
  EXPECT_EQ(motions[2].displacement(0.0).value, (Vec3<double>{1, 1, 1}));
  EXPECT_THAT(scene.warnings, IsEmpty());
  const Scene again = parse_scene(scene.resolved_toml, "b.toml");
  expect_same_scene(scene, again);
  EXPECT_EQ(again.resolved_toml, scene.resolved_toml);
}

TEST(DrivingScene, RayleighDampingIsDragByMassAndDampersByRate) {
  const std::string rest =
      driven_pair + "damping = [0, 0.5]\n[[anchor]]\nparticle = 0\nstiffness = 5\ndamping = 1\n";
  const Scene scene = parse_scene("[world]\nrayleigh = { mass = 0.25, stiffness = 0.1 }\n" + rest, "a.toml");
  EXPECT_EQ(scene.model.mass_drag, 0.25);
  EXPECT_THAT(scene.model.springs.damping, ElementsAre(1.0, 3.5));
  EXPECT_EQ(scene.model.anchors[0].damping, 1.5);
  expect_same_scene(scene, parse_scene(scene.resolved_toml, "b.toml"));
  const Scene strain = parse_scene(
      "[world]\nrayleigh = { stiffness = 0.1 }\n" + driven_pair + "law = 'strain'\nrest_length = 0.5\n",
      "a.toml");
  EXPECT_THAT(strain.model.springs.damping, ElementsAre(2.0, 6.0)) << "k/l0 is the rate under strain";
  // The damping matrix of a chain at rest is αM + βK.
  const Ivp ivp = make_ivp(
      parse_scene("[world]\nrayleigh = { mass = 0.25, stiffness = 0.1 }\n" + driven_pair, "a.toml"), 1.0);
  const auto& system = *ivp.system->second_order();
  SparseMatrix K = system.tangent_pattern(), D = system.tangent_pattern();
  const Vector still = Vector::Zero(9);
  system.stiffness(0.0, ivp.y0.head(9), still, TangentModel::exact, K);
  system.damping(0.0, ivp.y0.head(9), still, D);
  Matrix expected = 0.1 * Matrix(K);
  expected.diagonal().array() -= 0.25 * 2.0;
  EXPECT_LT((Matrix(D) - expected).lpNorm<Eigen::Infinity>(), 1e-14);
}

TEST(DrivingScene, TextsOfScenesWithoutAreAsBefore) {
  const std::string text =
      parse_scene(driven_pair + "[[anchor]]\nparticle = 0\nstiffness = 5\n", "a.toml").resolved_toml;
  for (const char* key : {"force", "rayleigh", "expression", "table", "velocity = [0.5"}) {
    EXPECT_EQ(text.find(key), std::string::npos) << key;
  }
}

TEST(DrivingScene, WarnsOfForcesOnFixedParticles) {
  const Scene scene = parse_scene(
      "[particles]\nposition = [[0,0,0], [1,0,0]]\nmass = 2\nfixed = [0]\n[[force]]\nparticle = 'all'\nvalue "
      "= [1,0,0]\n",
      "a.toml");
  EXPECT_THAT(scene.warnings,
              ElementsAre("a.toml:5: [force[0]]: 1 of the 2 driven particles is fixed: there the force "
                          "has no effect"));
}

TEST(DrivingScene, ErrorsNamePlaceFoundAndExpected) {
  const std::string force = driven_pair + "[[force]]\nparticle = 1\n";
  const std::vector<std::pair<std::string, std::string>> scenes = {
      {force,
       "s.toml:7: [force[0]]: found none of \"value\", \"table\", \"expression\", expected exactly one"},
      {force + "value = [0,0,1]\nexpression = ['1','2','3']\n",
       "s.toml:10: [force[0]] expression: found it beside \"value\", expected one of \"value\", \"table\", "
       "\"expression\""},
      {force + "expression = ['1', '2*x', '3']\n",
       "s.toml:9: [force[0]] expression[1]: \"2*x\", character 3: found \"x\", expected t, pi or one of the "
       "functions "
       "sqrt exp log sin cos tan sinh cosh tanh abs min max"},
      {force + "expression = ['1/t', '0', '0']\n",
       "s.toml:9: [force[0]] expression[0]: \"1/t\": found the value inf and the derivative -inf at t = 0, "
       "expected "
       "finite numbers"},
      {force + "table = { t = [0, 1, 1], value = [[0,0,0],[1,0,0],[2,0,0]] }\n",
       "s.toml:9: [force[0].table]: t[2]: found 1, expected a finite number > 1"},
      {force + "table = { t = [0, 1], value = [[0,0,0]] }\n",
       "s.toml:9: [force[0].table]: value: found 1 vectors, expected 2, one per time"},
      {driven_pair + "[[anchor]]\nparticle = 1\nstiffness = 1\nvelocity = [0,0,1]\ntable = { t = [0], value "
                     "= [[0,0,0]] }\n",
       "s.toml:11: [anchor[0]] table: found it beside \"velocity\", expected one of \"velocity\", \"table\", "
       "\"expression\""}};
  for (const auto& [text, message] : scenes) EXPECT_EQ(refusal_of(text), message) << text;
  EXPECT_NE(refusal_of(force + "expression = ['1', '2']\n"), "no error");
  EXPECT_NE(refusal_of("[world]\nrayleigh = { mass = -1 }\n" + driven_pair), "no error");
  EXPECT_NE(refusal_of("[world]\nrayleigh = { mss = 1 }\n" + driven_pair), "no error");
  EXPECT_NE(refusal_of(driven_pair + "[[force]]\nparticle = 3\nvalue = [0,0,1]\n"), "no error");
}

}  // namespace
}  // namespace fw::scene
