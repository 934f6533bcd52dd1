#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/error.hpp"
#include "scene/scene.hpp"

namespace fw::scene {
namespace {

struct BadScene {
  std::string text;
  std::string message;  ///< all of it
};

std::string message_of(const std::string& text) {
  try {
    parse_scene(text, "s.toml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

void expect_messages(const std::vector<BadScene>& scenes) {
  for (const auto& [text, message] : scenes) EXPECT_EQ(message_of(text), message) << text;
}

/// Three particles in lines 1 to 3.
const std::string particles = "[particles]\nposition = [[0,0,0], [1,0,0], [2,0,0]]\nmass = 1\n";
/// Two springs between them in lines 4 to 6.
const std::string springs = particles + "[springs]\nbetween = [[0,1], [1,2]]\nstiffness = 10\n";
/// A chain in lines 1 to 5.
const std::string chain = "[generate]\nkind = 'chain'\ncount = 4\nmass = 1\nstiffness = 10\n";
/// A cloth in lines 1 to 4.
const std::string cloth = "[generate]\nkind = 'cloth'\nmass = 1\nstiffness = 10\n";

TEST(SceneErrors, AreNotReportedForTheScenesBelowBeforeTheirFlaw) {
  EXPECT_EQ(message_of(particles), "no error");
  EXPECT_EQ(message_of(springs), "no error");
  EXPECT_EQ(message_of(chain + "length = 1\n"), "no error");
  EXPECT_EQ(message_of(cloth + "counts = [3, 3]\nspacing = 1\n"), "no error");
}

TEST(SceneErrors, NameUnknownKeysAndSections) {
  expect_messages({
      {"tilte = 'x'\n" + particles,
       "s.toml:1: unknown key \"tilte\" at the top of the file; did you mean \"title\"?"},
      {springs + "stifness = 1\n",
       "s.toml:7: unknown key \"stifness\" in [springs]; did you mean \"stiffness\"?"},
      {springs + "colour = 1\n", "s.toml:7: unknown key \"colour\" in [springs]"},
      {particles + "velocty = []\n",
       "s.toml:4: unknown key \"velocty\" in [particles]; did you mean \"velocity\"?"},
      {particles + "[world]\ngravty = [0,0,1]\n",
       "s.toml:5: unknown key \"gravty\" in [world]; did you mean \"gravity\"?"},
      {particles + "[spring]\n", "s.toml:4: unknown section [spring]; did you mean \"springs\"?"},
      {particles + "[[anchors]]\n", "s.toml:4: unknown section [[anchors]]; did you mean \"anchor\"?"},
      {particles + "[solver]\nstep = 1\n", "s.toml:4: unknown section [solver]"},
      {"[particle]\nposition = []\n", "s.toml:1: unknown section [particle]; did you mean \"particles\"?"},
      {"[genrate]\n", "s.toml:1: unknown section [genrate]; did you mean \"generate\"?"},
      {"", "s.toml: missing key \"particles\", expected a section [particles] or [generate]"},
      {"[springs]\nbetween = []\n",
       "s.toml: missing key \"particles\", expected a section [particles] or [generate]"},
      {"[generate]\nkind = 'chain'\ncount = 2\nlength = 1\nmass = 1\nstiffness = 1\ncounts = [1]\n",
       "s.toml:7: unknown key \"counts\" in [generate]; did you mean \"count\"?"},
      {particles +
           "[[obstacle]]\nshape = 'plane'\npoint = [0,0,0]\nnormal = [0,0,1]\nstiffness = 1\nradius = 1\n",
       "s.toml:9: unknown key \"radius\" in [obstacle[0]]"},
      {particles + "[[constraint]]\nkind = 'distance'\n",
       "s.toml:4: constraint: constraints are not available in this version"},
      {chain + "length = 1\n[particles]\nmass = 1\n",
       "s.toml:7: particles: found [particles] beside [generate], expected one of them"},
      {particles + "[[springs]]\nname = 'a'\nbetween = []\n[[springs]]\nname = 'a'\nbetween = []\n",
       "s.toml:8: [springs[1]] name: found \"a\" again, expected each name once"},
      {chain + "length = 1\n[springs]\nbetween = []\n",
       "s.toml:7: springs: found [springs] beside [generate], expected one of them"},
  });
}

TEST(SceneErrors, NameSyntaxErrors) {
  const std::string message = message_of("[particles]\nposition = [[0,0,0]\nmass = 1\n");
  EXPECT_EQ(message.rfind("s.toml:3:", 0), 0u) << message;
  EXPECT_NE(message.find("TOML syntax error"), std::string::npos) << message;
}

TEST(SceneErrors, NameWrongWorlds) {
  const std::string vector = "expected an array of 3 numbers [x, y, z]";
  expect_messages({
      {"title = 3\n" + particles, "s.toml:1: title: found 3, expected a string"},
      {"world = 3\n" + particles, "s.toml:1: world: found 3, expected a section [world]"},
      {"[world]\ngravity = 9.81\n" + particles, "s.toml:2: [world] gravity: found 9.81, " + vector},
      {"[world]\ngravity = [0, 9.81]\n" + particles,
       "s.toml:2: [world] gravity: found an array of 2 entries, " + vector},
      {"[world]\ngravity = [0, 0,\n-inf]\n" + particles,
       "s.toml:3: [world] gravity[2]: found -inf, expected a finite number"},
      {"[world]\ndrag = -0.1\n" + particles,
       "s.toml:2: [world] drag: found -0.1, expected a finite number >= 0"},
      {"[world]\ndrag = nan\n" + particles,
       "s.toml:2: [world] drag: found nan, expected a finite number >= 0"},
      {"[world]\ndrag = '1'\n" + particles,
       "s.toml:2: [world] drag: found the string \"1\", expected a finite number >= 0"},
  });
}

TEST(SceneErrors, NameWrongParticles) {
  const std::string p = "[particles]\nmass = 1\n";
  const std::string vector = "expected an array of 3 numbers [x, y, z]";
  const std::string index = "expected the index of a particle, an integer from 0 to 2";
  expect_messages({
      {p, "s.toml:1: [particles]: missing key \"position\", expected an array of vectors [x, y, z]"},
      {p + "position = []\n",
       "s.toml:3: [particles] position: found an empty list, expected at least one entry"},
      {p + "position = 1\n",
       "s.toml:3: [particles] position: found 1, expected an array of vectors [x, y, z]"},
      {p + "position = [0,0,0]\n", "s.toml:3: [particles] position[0]: found 0, " + vector},
      {p + "position = [[0,0,0],\n[0,0]]\n",
       "s.toml:4: [particles] position[1]: found an array of 2 entries, " + vector},
      {p + "position = [[0,0,0],\n[0,0,0,0]]\n",
       "s.toml:4: [particles] position[1]: found an array of 4 entries, " + vector},
      {p + "position = [[0,0,0],\n[0,nan,0]]\n",
       "s.toml:4: [particles] position[1][1]: found nan, expected a finite number"},
      {p + "position = [[0,0,0],\n[0,0,true]]\n",
       "s.toml:4: [particles] position[1][2]: found true, expected a finite number"},
      {"[particles]\nposition = [[0,0,0]]\n",
       "s.toml:1: [particles]: missing key \"mass\", expected one number, or an array with one number per "
       "particle (1)"},
      {"[particles]\nposition = [[0,0,0]]\nmass = 0\n",
       "s.toml:3: [particles] mass: found 0, expected a finite number > 0"},
      {"[particles]\nposition = [[0,0,0]]\nmass = [-2.5]\n",
       "s.toml:3: [particles] mass[0]: found -2.5, expected a finite number > 0"},
      {"[particles]\nposition = [[0,0,0],[1,0,0]]\nmass = [1,\n0.0]\n",
       "s.toml:4: [particles] mass[1]: found 0.0, expected a finite number > 0"},
      {"[particles]\nposition = [[0,0,0]]\nmass = inf\n",
       "s.toml:3: [particles] mass: found inf, expected a finite number > 0"},
      {"[particles]\nposition = [[0,0,0]]\nmass = [1, 2]\n",
       "s.toml:3: [particles] mass: found an array of 2 entries, expected one number, or an array with one "
       "number per particle (1)"},
      {"[particles]\nposition = [[0,0,0]]\nmass = 'heavy'\n",
       "s.toml:3: [particles] mass: found the string \"heavy\", expected one number, or an array with one "
       "number per particle (1)"},
      {particles + "velocity = [[0,0,0]]\n",
       "s.toml:4: [particles] velocity: found an array of length 1, expected one vector per particle (3)"},
      {particles + "velocity = [[0,0,0],[0,0,0],[0,inf,0]]\n",
       "s.toml:4: [particles] velocity[2][1]: found inf, expected a finite number"},
      {particles + "velocity = 0\n",
       "s.toml:4: [particles] velocity: found 0, expected an array of vectors [x, y, z]"},
      {particles + "fixed = 0\n",
       "s.toml:4: [particles] fixed: found 0, expected an array of particle indices"},
      {particles + "fixed = [0, 3]\n", "s.toml:4: [particles] fixed[1]: found 3, " + index},
      {particles + "fixed = [-1]\n", "s.toml:4: [particles] fixed[0]: found -1, " + index},
      {particles + "fixed = [1.0]\n", "s.toml:4: [particles] fixed[0]: found 1.0, " + index},
      {particles + "fixed = [2, 1,\n2]\n",
       "s.toml:5: [particles] fixed[2]: found particle 2 again, expected each particle once"},
      {"[[particles]]\nmass = 1\n",
       "s.toml:1: particles: found an array of tables, expected a section [particles]"},
  });
}

TEST(SceneErrors, NameWrongSprings) {
  const std::string s = particles + "[springs]\n";
  const std::string b = s + "between = [[0,1],\n[1,2]]\n";
  const std::string index = "expected the index of a particle, an integer from 0 to 2";
  const std::string list = "expected one number, or an array with one number per spring (2)";
  expect_messages({
      {s + "stiffness = 1\n",
       "s.toml:4: [springs]: missing key \"between\", expected an array of pairs [i, j] of particle indices"},
      {s + "between = [0, 1]\n",
       "s.toml:5: [springs] between[0]: found 0, expected a pair [i, j] of particle indices"},
      {s + "between = [[0, 1], [1]]\n",
       "s.toml:5: [springs] between[1]: found an array of 1 entry, expected a pair [i, j] of particle "
       "indices"},
      {s + "between = [[0, 1],\n[1, 3]]\n", "s.toml:6: [springs] between[1][1]: found 3, " + index},
      {s + "between = [[0, 1],\n[-1, 2]]\n", "s.toml:6: [springs] between[1][0]: found -1, " + index},
      {s + "between = [[0, 1],\n[1, 2.0]]\n", "s.toml:6: [springs] between[1][1]: found 2.0, " + index},
      {s + "between = [[0, 1],\n[2, 2]]\nstiffness = 1\n",
       "s.toml:6: [springs] between[1]: found a spring from particle 2 to itself, expected two different "
       "particles"},
      {b, "s.toml:4: [springs]: missing key \"stiffness\", " + list},
      {b + "stiffness = [1, 2, 3]\n", "s.toml:7: [springs] stiffness: found an array of 3 entries, " + list},
      {b + "stiffness = [1]\n", "s.toml:7: [springs] stiffness: found an array of 1 entry, " + list},
      {b + "stiffness = -1\n", "s.toml:7: [springs] stiffness: found -1, expected a finite number >= 0"},
      {b + "stiffness = [1,\n-2]\n",
       "s.toml:8: [springs] stiffness[1]: found -2, expected a finite number >= 0"},
      {b + "stiffness = [1, nan]\n",
       "s.toml:7: [springs] stiffness[1]: found nan, expected a finite number >= 0"},
      {springs + "damping = -0.5\n",
       "s.toml:7: [springs] damping: found -0.5, expected a finite number >= 0"},
      {springs + "damping = [0, inf]\n",
       "s.toml:7: [springs] damping[1]: found inf, expected a finite number >= 0"},
      {springs + "damping = [0]\n", "s.toml:7: [springs] damping: found an array of 1 entry, " + list},
      {springs + "rest_length = -1\n",
       "s.toml:7: [springs] rest_length: found -1, expected a finite number >= 0"},
      {springs + "rest_length = [1, 1, 1]\n",
       "s.toml:7: [springs] rest_length: found an array of 3 entries, " + list},
      {springs + "law = 'strain'\nrest_length = [1, 0]\n",
       "s.toml:8: [springs] rest_length[1]: found 0, expected a finite number > 0"},
      {springs + "law = 'hook'\n",
       "s.toml:7: [springs] law: found the string \"hook\", expected one of \"hooke\", \"strain\", "
       "\"tension_only\"; did you mean \"hooke\"?"},
      {springs + "law = 1\n",
       "s.toml:7: [springs] law: found 1, expected one of \"hooke\", \"strain\", \"tension_only\""},
      {"[particles]\nposition = [[0,0,0], [0,0,0]]\nmass = 1\n[springs]\nbetween = [[0,1]]\nstiffness = 1\n",
       "s.toml:5: [springs] between[0]: found particles 0 and 1 at the same point, expected a rest_length "
       "for such a spring"},
      {"[particles]\nposition = [[-1e308,0,0], [1e308,0,0]]\nmass = 1\n[springs]\nbetween = "
       "[[0,1]]\nstiffness = 1\n",
       "s.toml:5: [springs] between[0]: found particles 0 and 1 so far apart that their distance overflows, "
       "expected a finite distance"},
  });
}

TEST(SceneErrors, NameWrongAnchorsAndObstacles) {
  const std::string a = particles + "[[anchor]]\n";
  const std::string o = particles + "[[obstacle]]\nstiffness = 1\n";
  expect_messages({
      {particles + "[anchor]\nparticle = 0\n",
       "s.toml:4: anchor: found a table, expected sections [[anchor]]"},
      {a + "stiffness = 1\n",
       "s.toml:4: [anchor[0]]: missing key \"particle\", expected the index of a particle or a name, or an "
       "array of these"},
      {a + "particle = 3\n",
       "s.toml:5: [anchor[0]] particle: found 3, expected the index of a particle, an integer from 0 to 2"},
      {a + "particle = 'al'\n",
       "s.toml:5: [anchor[0]] particle: found the string \"al\", expected \"all\"; did you mean \"all\"?"},
      {a + "particle = [0, 0]\nstiffness = 1\n",
       "s.toml:5: [anchor[0]] particle[1]: found particle 0 again, expected each particle once"},
      {a + "particle = []\nstiffness = 1\n",
       "s.toml:5: [anchor[0]] particle: found no particle, expected at least one"},
      {a + "particle = 0\n",
       "s.toml:4: [anchor[0]]: missing key \"stiffness\", expected a finite number >= 0"},
      {a + "particle = 0\nstiffness = -1\n",
       "s.toml:6: [anchor[0]] stiffness: found -1, expected a finite number >= 0"},
      {a + "particle = 0\nstiffness = 1\ndamping = -1\n",
       "s.toml:7: [anchor[0]] damping: found -1, expected a finite number >= 0"},
      {a + "particle = [0, 1]\nstiffness = 1\nposition = [0,0,0]\n",
       "s.toml:7: [anchor[0]] position: found a position for 2 particles, expected one only for a single "
       "particle"},
      {o, "s.toml:4: [obstacle[0]]: missing key \"shape\", expected one of \"plane\", \"sphere\", \"box\""},
      {o + "shape = 'spere'\n",
       "s.toml:6: [obstacle[0]] shape: found the string \"spere\", expected one of \"plane\", \"sphere\", "
       "\"box\"; did you mean \"sphere\"?"},
      {o + "shape = 'plane'\nnormal = [0,0,1]\n",
       "s.toml:4: [obstacle[0]]: missing key \"point\", expected an array of 3 numbers [x, y, z]"},
      {o + "shape = 'plane'\npoint = [0,0,0]\nnormal = [0,0,0]\n",
       "s.toml:8: [obstacle[0]] normal: found the zero vector, expected a direction"},
      {o + "shape = 'sphere'\ncentre = [0,0,0]\nradius = 0\n",
       "s.toml:8: [obstacle[0]] radius: found 0, expected a finite number > 0"},
      {o + "shape = 'sphere'\ncenter = [0,0,0]\nradius = 1\n",
       "s.toml:7: unknown key \"center\" in [obstacle[0]]; did you mean \"centre\"?"},
      {o + "shape = 'box'\nlower = [0,0,0]\nupper = [1,0,1]\n",
       "s.toml:8: [obstacle[0]] upper[1]: found 0, expected a number > lower[1] = 0"},
      {particles + "[[obstacle]]\nshape = 'box'\nlower = [0,0,0]\nupper = [1,1,1]\n",
       "s.toml:4: [obstacle[0]]: missing key \"stiffness\", expected a finite number >= 0"},
      {o + "shape = 'box'\nlower = [0,0,0]\nupper = [1,1,1]\ndamping = -2\n",
       "s.toml:9: [obstacle[0]] damping: found -2, expected a finite number >= 0"},
  });
}

TEST(SceneErrors, NameWrongGenerators) {
  const std::string kinds = "expected one of \"chain\", \"cloth\", \"grid\", \"block\"";
  const std::string grid = "[generate]\nkind = 'grid'\nmass = 1\nstiffness = 1\n";
  const std::string block = "[generate]\nkind = 'block'\nstiffness = 1\n";
  const std::string c = chain + "length = 1\n";
  const std::string sheet = cloth + "counts = [3, 3]\nspacing = 1\n";
  expect_messages({
      {"[generate]\n", "s.toml:1: [generate]: missing key \"kind\", " + kinds},
      {"[generate]\nkind = 'mesh'\n", "s.toml:2: [generate] kind: found the string \"mesh\", " + kinds},
      {"[generate]\nkind = 'chian'\n",
       "s.toml:2: [generate] kind: found the string \"chian\", " + kinds + "; did you mean \"chain\"?"},
      {"[generate]\nkind = 'chain'\n",
       "s.toml:1: [generate]: missing key \"count\", expected an integer from 2 to 2147483647"},
      {"[generate]\nkind = 'chain'\ncount = 1\n",
       "s.toml:3: [generate] count: found 1, expected an integer from 2 to 2147483647"},
      {"[generate]\nkind = 'chain'\ncount = 3.0\n",
       "s.toml:3: [generate] count: found 3.0, expected an integer from 2 to 2147483647"},
      {"[generate]\nkind = 'chain'\ncount = 1000000000\nlength = 1\nmass = 1\nstiffness = 1\n",
       "s.toml:3: [generate] count: found 1e+09 particles, expected at most 357913941"},
      {chain, "s.toml:1: [generate]: found none of \"length\" and \"spacing\", expected exactly one"},
      {c + "spacing = 1\n",
       "s.toml:7: [generate] spacing: found both of \"length\" and \"spacing\", expected exactly one"},
      {chain + "length = 0\n", "s.toml:6: [generate] length: found 0, expected a finite number > 0"},
      {chain + "spacing = -1\n", "s.toml:6: [generate] spacing: found -1, expected a finite number > 0"},
      {c + "direction = [0,0,0]\n",
       "s.toml:7: [generate] direction: found the zero vector, expected a direction"},
      {chain + "length = 1e308\norigin = [1e308, 0, 0]\n",
       "s.toml:1: [generate]: found positions that overflow, expected finite positions"},
      {chain + "length = 1\norigin = [1e20, 0, 0]\n",
       "s.toml:1: [generate]: found points that coincide or lie too far apart in double precision, expected "
       "springs of finite length > 0"},
      {c + "total_mass = 1\n",
       "s.toml:7: [generate] total_mass: found \"mass\" and \"total_mass\", expected exactly one of "
       "\"mass\", "
       "\"total_mass\" and \"density\""},
      {"[generate]\nkind = 'chain'\ncount = 2\nlength = 1\nstiffness = 1\n",
       "s.toml:1: [generate]: found none of \"mass\", \"total_mass\" and \"density\", expected exactly one"},
      {"[generate]\nkind = 'chain'\ncount = 2\nlength = 1\nstiffness = 1\nmass = [1, 2, 3]\n",
       "s.toml:6: [generate] mass: found an array of 3 entries, expected one number, or an array with one "
       "number per particle (2)"},
      {"[generate]\nkind = 'chain'\ncount = 2\nlength = 1\nstiffness = 1\ndensity = 0\n",
       "s.toml:6: [generate] density: found 0, expected a finite number > 0"},
      {"[generate]\nkind = 'chain'\ncount = 2\nlength = 1e-200\nstiffness = 1\ndensity = 1e-200\n",
       "s.toml:6: [generate] density: found masses that vanish or overflow in double precision, expected "
       "finite masses > 0"},
      {"[generate]\nkind = 'chain'\ncount = 2\nlength = 1\nmass = 1\n",
       "s.toml:1: [generate]: missing key \"stiffness\", expected a number"},
      {c + "damping = -1\n", "s.toml:7: [generate] damping: found -1, expected a finite number >= 0"},
      {c + "springs = ['structural', 'shear']\n",
       "s.toml:7: [generate] springs[1]: found the string \"shear\", expected one of \"structural\", "
       "\"bend\""},
      {c + "springs = ['bend', 'bend']\n",
       "s.toml:7: [generate] springs[1]: found \"bend\" again, expected each name once"},
      {c + "springs = 'bend'\n",
       "s.toml:7: [generate] springs: found the string \"bend\", expected an array of strings"},
      {c + "law = 'strain'\nrest_length_factor = 0\n",
       "s.toml:8: [generate] rest_length_factor: found 0, expected a finite number > 0"},
      {c + "rest_length_factor = -1\n",
       "s.toml:7: [generate] rest_length_factor: found -1, expected a finite number >= 0"},
      {c + "pinned = 'top_edge'\n",
       "s.toml:7: [generate] pinned: found the string \"top_edge\", expected one of \"all\", \"start\", "
       "\"end\", \"ends\""},
      {c + "pinned = ['start',\n4]\n",
       "s.toml:8: [generate] pinned[1]: found 4, expected the index of a particle, an integer from 0 to 3"},
      {c + "pinned = ['start', 'start']\n",
       "s.toml:7: [generate] pinned[1]: found \"start\" again, expected each name once"},
      {c + "velocity = 1\n",
       "s.toml:7: [generate] velocity: found 1, expected an array of 3 numbers [x, y, z]"},
      {cloth,
       "s.toml:1: [generate]: missing key \"counts\", expected a list of integers from 2 to 2147483647"},
      {cloth + "counts = [3, 3, 3]\n", "s.toml:5: [generate] counts: found 3 entries, expected 2"},
      {cloth + "counts = [3, 1]\n",
       "s.toml:5: [generate] counts[1]: found 1, expected an integer from 2 to 2147483647"},
      {cloth + "counts = [100000, 100000]\nspacing = 1\n",
       "s.toml:5: [generate] counts: found 1e+10 particles, expected at most 357913941"},
      {cloth + "counts = [18000, 19000]\nspacing = 1\nsprings = []\nplane = 'zx'\n",
       "s.toml:8: [generate] plane: found the string \"zx\", expected one of \"xy\", \"xz\", \"yz\""},
      {cloth + "counts = [3, 3]\nsize = [1, 1, 1]\n",
       "s.toml:6: [generate] size: found 3 entries, expected 2"},
      {cloth + "counts = [3, 3]\nsize = [1, -1]\n",
       "s.toml:6: [generate] size[1]: found -1, expected a finite number > 0"},
      {"[generate]\nkind = 'cloth'\ncounts = [3, 3]\nspacing = 1\nmass = 1\nstiffness = { structural = 1, "
       "shear = 1 }\n",
       "s.toml:6: [generate.stiffness]: missing key \"bend\", expected a number"},
      {"[generate]\nkind = 'cloth'\ncounts = [3, 3]\nspacing = 1\nmass = 1\nsprings = ['shear']\nstiffness = "
       "{ shear = 1, bend = 1 }\n",
       "s.toml:7: unknown key \"bend\" in [generate.stiffness]"},
      {sheet + "damping = { structral = 1 }\n",
       "s.toml:7: unknown key \"structral\" in [generate.damping]; did you mean \"structural\"?"},
      {grid + "counts = [2000, 2000, 2000]\nspacing = 1\n",
       "s.toml:5: [generate] counts: found 8e+09 particles, expected at most 357913941"},
      {grid + "counts = [700, 700, 700]\nspacing = 1e-3\n",
       "s.toml:1: [generate] springs: found 3.08e+09 springs, expected at most 2147483647"},
      {block + "counts = [2, 2]\n", "s.toml:4: [generate] counts: found 2 entries, expected 3"},
      {block + "counts = [2, 2, 2]\nspacing = 1\ndensity = 1\nsprings = ['shear']\n",
       "s.toml:7: [generate] springs[0]: found the string \"shear\", expected \"structural\""},
  });
}

}  // namespace
}  // namespace fw::scene
