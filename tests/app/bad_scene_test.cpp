#include "app/bad_input.hpp"

namespace fw::app::test {
namespace {

class BadScene : public ::testing::TestWithParam<BadInput> {};

TEST_P(BadScene, IsRefusedWithOneMessageAndNoFile) {
  expect_refused(GetParam());
}

const std::vector<std::string> simulate = {
    "simulate", "s.toml", "--method", "velocity_verlet", "--step", "0.1", "--t-end", "1", "-o", "a.h5"};

/// `simulate` of a scene with this text.
BadInput scene(const std::string& name, const std::string& text, const std::vector<std::string>& message) {
  return {name, simulate, {{"s.toml", text}}, message};
}

/// Three particles in lines 1 to 3, two springs in lines 4 to 6.
const std::string particles = "[particles]\nposition = [[0,0,0], [1,0,0], [2,0,0]]\nmass = 1\n";
const std::string springs = particles + "[springs]\nbetween = [[0,1], [1,2]]\nstiffness = 10\n";
/// Generated systems without their sizes, in lines 1 to 4.
const std::string chain = "[generate]\nkind = 'chain'\nmass = 1\nstiffness = 10\n";
const std::string cloth = "[generate]\nkind = 'cloth'\nmass = 1\nstiffness = 10\n";
const std::string block = "[generate]\nkind = 'block'\ndensity = 1\nstiffness = 10\n";

/// Particles with another second or third line.
std::string with_position(const std::string& position) {
  return "[particles]\nposition = " + position + "\nmass = 1\n";
}
std::string with_mass(const std::string& mass) {
  return "[particles]\nposition = [[0,0,0], [1,0,0], [2,0,0]]\nmass = " + mass + "\n";
}
/// Springs with another line 6, and with the line before it changed.
std::string with_springs(const std::string& between, const std::string& rest) {
  return particles + "[springs]\nbetween = " + between + "\n" + rest + "\n";
}

TEST(BadScene, DoesNotMeanTheSceneWithoutItsFlaw) {
  for (const std::string& text :
       {particles, springs, chain + "count = 4\nlength = 1\n", cloth + "counts = [3, 3]\nspacing = 1\n",
        block + "counts = [2, 2, 2]\nspacing = 1\n"}) {
    const store::test::ScratchDirectory scratch;
    store::test::write_bytes(scratch / "s.toml", text);
    const ProcessResult result = run(scratch.path(), simulate);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(scratch.names(), ::testing::ElementsAre("a.h5", "s.toml"));
  }
}

INSTANTIATE_TEST_SUITE_P(
    File, BadScene,
    ::testing::Values(BadInput{"Missing", simulate, {}, {"s.toml", "no such file"}},
                      BadInput{"Directory", simulate, {{"s.toml/", ""}}, {"s.toml", "directory"}},
                      BadInput{"ThroughAFile",
                               {"simulate", "x/s.toml", "--method", "rk4", "--step", "1", "--t-end", "1",
                                "-o", "a.h5"},
                               {{"x", ""}},
                               {"x/s.toml"}},
                      scene("Empty", "", {"s.toml", "particles"}),
                      scene("SyntaxError", "[particles\n", {"s.toml:1", "syntax"}),
                      scene("SyntaxErrorInALaterLine", particles + "mass == 2\n", {"s.toml:4", "syntax"}),
                      scene("UnclosedArray", "[particles]\nposition = [[0,0,0]\n", {"s.toml:", "syntax"}),
                      scene("NotUtf8", "title = \"\xff\xfe\"\n" + particles, {"s.toml:1"}),
                      scene("Utf16", std::string("\xff\xfe[\0p\0", 6), {"s.toml:1"}),
                      scene("Binary", std::string("\x89HDF\r\n\x1a\n\0\0\0", 11), {"s.toml:1"}),
                      scene("NulByte", particles + std::string("\0", 1), {"s.toml:4"}),
                      scene("KeyTwice", particles + "mass = 2\n", {"s.toml:4", "mass"}),
                      scene("SectionTwice", springs + "[springs]\n", {"s.toml:7", "springs"}),
                      scene("DeepNesting", "x = " + std::string(100000, '['), {"s.toml:1"})),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Keys, BadScene,
    ::testing::Values(
        scene("UnknownAtTop", "colour = 1\n" + particles, {"s.toml:1", "colour"}),
        scene("Misspelt", springs + "stifness = 1\n", {"s.toml:7", "stifness", "did you mean \"stiffness\""}),
        scene("UnknownSection", particles + "[solver]\nstep = 1\n", {"s.toml:4", "[solver]"}),
        scene("TitleIsANumber", "title = 3\n" + particles, {"s.toml:1", "title", "found 3", "a string"}),
        scene("ParticlesAreAList", "[[particles]]\nmass = 1\n", {"s.toml:1", "particles", "section"}),
        scene("GravityOfTwo", particles + "[world]\ngravity = [0, 9.81]\n",
              {"s.toml:5", "gravity", "3 numbers"}),
        scene("GravityIsANumber", particles + "[world]\ngravity = -9.81\n", {"s.toml:5", "gravity", "-9.81"}),
        scene("GravityNotFinite", particles + "[world]\ngravity = [0, 0, inf]\n",
              {"s.toml:5", "gravity[2]", "inf"}),
        scene("DragNegative", particles + "[world]\ndrag = -1\n", {"s.toml:5", "drag", "found -1"}),
        scene("DragText", particles + "[world]\ndrag = 'much'\n", {"s.toml:5", "drag", "much"}),
        scene("GenerateBesideParticles", particles + "[generate]\nkind = 'chain'\n",
              {"s.toml:1", "[generate]"}),
        scene("Constraint", particles + "[[constraint]]\nkind = 'distance'\n", {"s.toml:4", "constraint"}),
        scene("Mesh", "[generate]\nkind = 'mesh'\nfile = 'a.msh'\n", {"s.toml:2", "kind", "mesh"})),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Particles, BadScene,
    ::testing::Values(
        scene("PositionMissing", "[particles]\nmass = 1\n", {"s.toml:1", "missing", "position"}),
        scene("PositionEmpty", with_position("[]"), {"s.toml:2", "position", "at least one"}),
        scene("PositionIsANumber", with_position("1"), {"s.toml:2", "position", "found 1"}),
        scene("PositionOfTwo", with_position("[[0,0,0], [1,0]]"), {"s.toml:2", "position[1]", "3 numbers"}),
        scene("PositionText", with_position("[[0,0,0], [1,'a',0]]"), {"s.toml:2", "position[1][1]"}),
        scene("PositionNotANumber", with_position("[[0,0,0], [1,0,nan]]"),
              {"s.toml:2", "position[1][2]", "nan"}),
        scene("PositionInfinite", with_position("[[-inf,0,0]]"), {"s.toml:2", "position[0][0]", "-inf"}),
        scene("PositionOverflows", with_position("[[1e999,0,0]]"), {"s.toml:2"}),
        scene("MassMissing", "[particles]\nposition = [[0,0,0]]\n", {"s.toml:1", "missing", "mass"}),
        scene("MassZero", with_mass("0"), {"s.toml:3", "mass", "found 0", "> 0"}),
        scene("MassNegative", with_mass("[1, 2, -3]"), {"s.toml:3", "mass[2]", "found -3"}),
        scene("MassNotFinite", with_mass("[1, inf, 1]"), {"s.toml:3", "mass[1]", "inf"}),
        scene("MassTooShort", with_mass("[1, 2]"), {"s.toml:3", "mass", "2 entries", "per particle (3)"}),
        scene("MassTooLong", with_mass("[1, 2, 3, 4]"), {"s.toml:3", "mass", "4 entries"}),
        scene("MassText", with_mass("'heavy'"), {"s.toml:3", "mass", "heavy"}),
        scene("VelocityTooShort", particles + "velocity = [[0,0,0]]\n", {"s.toml:4", "velocity", "1"}),
        scene("VelocityNotANumber", particles + "velocity = [[0,0,0],[0,nan,0],[0,0,0]]\n",
              {"s.toml:4", "velocity[1][1]", "nan"}),
        scene("FixedOutOfRange", particles + "fixed = [0, 3]\n",
              {"s.toml:4", "fixed[1]", "found 3", "0 to 2"}),
        scene("FixedNegative", particles + "fixed = [-1]\n", {"s.toml:4", "fixed[0]", "found -1"}),
        scene("FixedTwice", particles + "fixed = [1, 1]\n", {"s.toml:4", "fixed[1]", "again"}),
        scene("FixedIsNoInteger", particles + "fixed = [1.5]\n", {"s.toml:4", "fixed[0]", "1.5"}),
        scene("FixedIsNoList", particles + "fixed = 1\n", {"s.toml:4", "fixed", "array"})),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Springs, BadScene,
    ::testing::Values(
        scene("BetweenMissing", particles + "[springs]\nstiffness = 1\n", {"s.toml:4", "missing", "between"}),
        scene("IndexOutOfRange", with_springs("[[0,1], [1,3]]", "stiffness = 1"),
              {"s.toml:5", "between[1][1]", "found 3", "0 to 2"}),
        scene("IndexNegative", with_springs("[[-1,1]]", "stiffness = 1"),
              {"s.toml:5", "between[0][0]", "-1"}),
        scene("IndexHuge", with_springs("[[0,9223372036854775807]]", "stiffness = 1"),
              {"s.toml:5", "between[0][1]"}),
        scene("ToItself", with_springs("[[0,1], [2,2]]", "stiffness = 1"),
              {"s.toml:5", "between[1]", "itself"}),
        scene("Triple", with_springs("[[0,1,2]]", "stiffness = 1"), {"s.toml:5", "between[0]", "pair"}),
        scene("StiffnessMissing", with_springs("[[0,1]]", ""), {"s.toml:4", "missing", "stiffness"}),
        scene("StiffnessNegative", with_springs("[[0,1]]", "stiffness = [-1]"), {"s.toml:6", "stiffness[0]"}),
        scene("StiffnessTooShort", with_springs("[[0,1], [1,2]]", "stiffness = [1]"),
              {"s.toml:6", "stiffness", "per spring (2)"}),
        scene("DampingNegative", springs + "damping = -0.5\n", {"s.toml:7", "damping", "-0.5"}),
        scene("DampingNotFinite", springs + "damping = [0, nan]\n", {"s.toml:7", "damping[1]", "nan"}),
        scene("RestLengthNegative", springs + "rest_length = [1, -1]\n",
              {"s.toml:7", "rest_length[1]", "-1"}),
        scene("RestLengthZeroForStrain", springs + "law = 'strain'\nrest_length = 0\n",
              {"s.toml:8", "rest_length", "> 0"}),
        scene("UnknownLaw", springs + "law = 'hook'\n",
              {"s.toml:7", "law", "hook", "did you mean \"hooke\""}),
        scene("Coincident",
              with_position("[[1,1,1], [1,1,1]]") + "[springs]\nbetween = [[0,1]]\nstiffness = 1\n",
              {"s.toml:5", "between[0]", "same point", "rest_length"}),
        scene("FarApart",
              with_position("[[-1e308,0,0], [1e308,0,0]]") + "[springs]\nbetween = [[0,1]]\nstiffness = 1\n",
              {"s.toml:5", "between[0]", "overflows"})),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Generated, BadScene,
    ::testing::Values(
        scene("KindMissing", "[generate]\nmass = 1\n", {"s.toml:1", "missing", "kind"}),
        scene("KindUnknown", "[generate]\nkind = 'clot'\n", {"s.toml:2", "kind", "did you mean \"cloth\""}),
        scene("CountOne", chain + "count = 1\nlength = 1\n", {"s.toml:5", "count", "found 1"}),
        scene("CountNegative", chain + "count = -4\nlength = 1\n", {"s.toml:5", "count", "-4"}),
        scene("CountHuge", chain + "count = 2147483647\nlength = 1\n", {"s.toml:5", "count", "at most"}),
        scene("CountBeyondAnInteger", chain + "count = 99999999999999999999\nlength = 1\n", {"s.toml:5"}),
        scene("CountsHuge", cloth + "counts = [100000, 100000]\nspacing = 1\n",
              {"s.toml:5", "counts", "1e+10 particles", "at most"}),
        scene("CountsHugeInThreeAxes", block + "counts = [2147483647, 2147483647, 2147483647]\nspacing = 1\n",
              {"s.toml:5", "counts", "at most"}),
        scene("CountsOfThreeForACloth", cloth + "counts = [3, 3, 3]\nspacing = 1\n", {"s.toml:5", "counts"}),
        scene("CountsMissing", cloth + "spacing = 1\n", {"s.toml:1", "missing", "counts"}),
        scene("SizeMissing", cloth + "counts = [3, 3]\n", {"s.toml:1", "size", "spacing"}),
        scene("SizeAndSpacing", cloth + "counts = [3, 3]\nsize = [1, 1]\nspacing = 1\n",
              {"s.toml:7", "spacing"}),
        scene("SizeZero", cloth + "counts = [3, 3]\nsize = [1, 0]\n", {"s.toml:6", "size[1]", "> 0"}),
        scene("MassAndDensity", cloth + "counts = [3, 3]\nspacing = 1\ndensity = 1\n",
              {"s.toml:7", "density"}),
        scene("MassOfEachTooShort",
              "[generate]\nkind = 'chain'\ncount = 3\nlength = 1\nmass = [1, 1]\nstiffness = 1\n",
              {"s.toml:5", "mass", "per particle (3)"}),
        scene("PinnedUnknown", cloth + "counts = [3, 3]\nspacing = 1\npinned = 'top_edg'\n",
              {"s.toml:7", "pinned", "top_edg", "did you mean"}),
        scene("PinnedOutOfRange", cloth + "counts = [3, 3]\nspacing = 1\npinned = [9]\n",
              {"s.toml:7", "pinned[0]", "0 to 8"}),
        scene("SpringsTwice", cloth + "counts = [3, 3]\nspacing = 1\nsprings = ['shear', 'shear']\n",
              {"s.toml:7", "springs[1]", "again"}),
        scene("SpringsUnknown", cloth + "counts = [3, 3]\nspacing = 1\nsprings = ['cross_brace']\n",
              {"s.toml:7", "springs[0]"}),
        scene("SpacingVanishes", cloth + "counts = [3, 3]\nspacing = 1e-320\n", {"s.toml:1", "[generate]"})),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Attachments, BadScene,
    ::testing::Values(
        scene("AnchorOutOfRange", particles + "[[anchor]]\nparticle = 7\nstiffness = 1\n",
              {"s.toml:5", "[anchor[0]]", "particle", "found 7"}),
        scene("AnchorWithoutStiffness", particles + "[[anchor]]\nparticle = 1\n",
              {"s.toml:4", "[anchor[0]]", "missing", "stiffness"}),
        scene("SecondAnchorNegative",
              particles +
                  "[[anchor]]\nparticle = 1\nstiffness = 1\n[[anchor]]\nparticle = 1\nstiffness = -1\n",
              {"s.toml:9", "[anchor[1]]", "stiffness", "-1"}),
        scene("AnchorIsOneTable", particles + "[anchor]\nparticle = 1\n", {"s.toml:4", "anchor"}),
        scene("ObstacleUnknownShape", particles + "[[obstacle]]\nshape = 'cone'\n",
              {"s.toml:5", "[obstacle[0]]", "shape", "cone"}),
        scene("ObstacleWithoutNormal",
              particles + "[[obstacle]]\nshape = 'plane'\npoint = [0,0,0]\nnormal = [0,0,0]\nstiffness = 1\n",
              {"s.toml:7", "normal", "zero vector"}),
        scene("ObstacleRadiusZero",
              particles + "[[obstacle]]\nshape = 'sphere'\ncentre = [0,0,0]\nradius = 0\nstiffness = 1\n",
              {"s.toml:7", "radius", "> 0"}),
        scene("ObstacleInsideOut",
              particles + "[[obstacle]]\nshape = 'box'\nlower = [0,0,0]\nupper = [1,1,-1]\nstiffness = 1\n",
              {"s.toml:7", "upper[2]", "-1"})),
    name_of);

}  // namespace
}  // namespace fw::app::test
