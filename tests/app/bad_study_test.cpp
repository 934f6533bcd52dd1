#include "app/bad_input.hpp"

namespace fw::app::test {
namespace {

using Words = std::vector<std::string>;

class BadStudy : public ::testing::TestWithParam<BadInput> {};

TEST_P(BadStudy, IsRefusedWithOneMessageAndNoFile) {
  expect_refused(GetParam());
}

/// `run` of a study with this text.
BadInput study(const std::string& name, const std::string& text, const Words& message) {
  return {name, {"run", "s.toml", "-o", "results"}, {{"s.toml", text}}, message};
}

/// The head of a study in lines 1 and 2.
const std::string convergence = "kind = 'convergence'\ntitle = 'T'\n";
const std::string simulate = "kind = 'simulate'\ntitle = 'T'\n";
/// Line 3, and a problem in two lines.
const std::string rk4 = "methods = ['rk4']\n";
const std::string oscillator = "[[problem]]\nname = 'harmonic_oscillator'\n";

TEST(BadStudy, DoesNotMeanTheStudyWithoutItsFlaw) {
  const store::test::ScratchDirectory scratch;
  store::test::write_bytes(scratch / "s.toml", convergence + rk4 + oscillator);
  const ProcessResult result = run(scratch.path(), {"run", "s.toml", "-o", "results"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(std::filesystem::exists(scratch / "results" / "s.h5"));
}

INSTANTIATE_TEST_SUITE_P(
    Head, BadStudy,
    ::testing::Values(
        BadInput{"MissingFile", {"run", "s.toml"}, {}, {"s.toml", "no such file"}},
        BadInput{"Directory", {"run", "s.toml"}, {{"s.toml/", ""}}, {"s.toml", "directory"}},
        study("Syntax", "kind = \n", {"s.toml:1", "syntax"}),
        study("NotUtf8", "title = '\xff'\n", {"s.toml:1"}), study("Empty", "", {"s.toml", "missing", "kind"}),
        study("KindMissing", "title = 'T'\n", {"s.toml", "missing", "kind"}),
        study("KindUnknown", "kind = 'convergense'\ntitle = 'T'\n",
              {"s.toml:1", "kind", "convergense", "did you mean \"convergence\""}),
        study("TitleMissing", "kind = 'convergence'\n" + rk4 + oscillator, {"s.toml", "missing", "title"}),
        study("TitleIsANumber", "kind = 'convergence'\ntitle = 1\n", {"s.toml:2", "title", "found 1"}),
        study("SeedNegative", convergence + "seed = -1\n" + rk4 + oscillator, {"s.toml:3", "seed", "-1"}),
        study("UnknownKey", convergence + rk4 + "colour = 1\n" + oscillator, {"s.toml:4", "colour"}),
        study("UnknownSection", convergence + rk4 + oscillator + "[plot]\nx = 1\n", {"s.toml:6", "[plot]"})),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Methods, BadStudy,
    ::testing::Values(
        study("Missing", convergence + oscillator, {"s.toml", "missing", "methods"}),
        study("Empty", convergence + "methods = []\n" + oscillator, {"s.toml:3", "methods", "empty"}),
        study("NoList", convergence + "methods = 'rk4'\n" + oscillator, {"s.toml:3", "methods", "array"}),
        study("NoString", convergence + "methods = ['rk4', 4]\n" + oscillator,
              {"s.toml:3", "methods[1]", "found 4"}),
        study("Unknown", convergence + "methods = ['rk4', 'hein']\n" + oscillator,
              {"s.toml:3", "methods[1]", "hein", "did you mean \"heun\""}),
        study("UnknownOption", convergence + "methods = ['rk4[x=1]']\n" + oscillator,
              {"s.toml:3", "methods[0]", "no options", "\"x\""}),
        study("Adaptive", convergence + "methods = ['rk4', 'sundials:cvode_bdf']\n" + oscillator,
              {"s.toml:3", "methods[1]", "sundials:cvode_bdf", "fixed step"}),
        study("SecondOrderOnly",
              simulate + "methods = ['verlet']\nsteps = [0.1]\n[[problem]]\nname = 'prothero_robinson'\n",
              {"s.toml:3", "methods[0]", "verlet", "prothero_robinson"}),
        study("Twice", convergence + "methods = ['rk4', 'rk4']\n" + oscillator,
              {"s.toml", "harmonic_oscillator-rk4", "twice"})),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Problems, BadStudy,
    ::testing::Values(
        study("Missing", convergence + rk4, {"s.toml", "[[problem]]"}),
        study("OneTable", convergence + rk4 + "[problem]\nname = 'kepler'\n", {"s.toml:4", "problem"}),
        study("Unknown", convergence + rk4 + oscillator + "[[problem]]\nname = 'keplr'\n",
              {"s.toml:7", "[problem[1]]", "name", "keplr", "did you mean \"kepler\""}),
        study("NeitherNameNorScene", convergence + rk4 + "[[problem]]\nt_end = 1\n",
              {"s.toml:4", "[problem[0]]", "name", "scene"}),
        study("NameAndScene", convergence + rk4 + oscillator + "scene = 'a.toml'\n",
              {"s.toml:6", "[problem[0]]", "both"}),
        study("UnknownKey", convergence + rk4 + oscillator + "tend = 1\n",
              {"s.toml:6", "tend", "did you mean \"t_end\""}),
        study("UnknownParameter", convergence + rk4 + oscillator + "parameters = { omga = 1 }\n",
              {"s.toml:", "[problem[0]]", "omga"}),
        study("ParameterText", convergence + rk4 + oscillator + "parameters = { omega = 'x' }\n",
              {"s.toml:6: [problem[0].parameters] omega: found"}),
        study("EndBeforeTheStart", convergence + rk4 + oscillator + "t_end = -1\n",
              {"s.toml:6", "[problem[0]]", "t_end", "-1"}),
        study("SceneMissing", convergence + rk4 + "[[problem]]\nscene = 'a.toml'\nt_end = 1\n",
              {"s.toml:5", "[problem[0]]", "scene", "a.toml", "no such file"}),
        study("SceneWithoutEnd", convergence + rk4 + "[[problem]]\nscene = 'a.toml'\n",
              {"s.toml:4", "[problem[0]]", "missing", "t_end"}),
        BadInput{"SceneBroken",
                 {"run", "s.toml", "-o", "results"},
                 {{"s.toml", convergence + rk4 + "[[problem]]\nscene = 'a.toml'\nt_end = 1\n"},
                  {"a.toml", "[particles]\nposition = [[0,0,0]]\nmass = 0\n"}},
                 {"s.toml:5", "a.toml:3", "mass", "found 0"}},
        study("LabelTwice", convergence + rk4 + oscillator + "t_end = 1\n" + oscillator + "t_end = 2\n",
              {"s.toml", "harmonic_oscillator-rk4", "twice", "label"}),
        study("LabelIsANumber", convergence + rk4 + oscillator + "label = 1\n",
              {"s.toml:6", "label", "found 1"})),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Settings, BadStudy,
    ::testing::Values(study("RatioOne", convergence + rk4 + oscillator + "[convergence]\nratio = 1\n",
                            {"s.toml:7", "ratio"}),
                      study("LevelsNegative", convergence + rk4 + oscillator + "[convergence]\nlevels = -1\n",
                            {"s.toml:7", "levels", "-1"}),
                      study("ToleranceText",
                            convergence + rk4 + oscillator + "[convergence]\ntolerance = 'x'\n",
                            {"s.toml:7", "tolerance"}),
                      study("QuickUnknownKey", convergence + rk4 + oscillator + "[quick]\nlevel = 6\n",
                            {"s.toml:7", "level", "did you mean \"levels\""}),
                      study("StepsMissing", simulate + rk4 + oscillator, {"s.toml", "steps", "rk4"}),
                      study("StepZero", simulate + rk4 + "steps = [0.1, 0]\n" + oscillator,
                            {"s.toml:4", "steps[1]", "found 0"}),
                      study("StepTooSmall", simulate + rk4 + "steps = [0.1, 1e-300]\n" + oscillator,
                            {"s.toml:4", "steps[1]", "1e-300", "harmonic_oscillator"}),
                      study("StepDoesNotDivide",
                            simulate + "methods = ['verlet']\nsteps = [0.3]\n" + oscillator + "t_end = 1\n",
                            {"s.toml:4", "steps[0]", "0.25", "verlet"}),
                      study("FramesOne", simulate + rk4 + "steps = [0.1]\nframes = 1\n" + oscillator,
                            {"s.toml:5", "frames", "found 1"}),
                      study("VectorFieldOfThreeCounts",
                            simulate + rk4 + "steps = [0.1]\n" + oscillator +
                                "[vector_field]\nlower = [0, 0]\nupper = [1, 1]\ncounts = [2, 2, 2]\n",
                            {"s.toml:10", "counts"})),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Commands, BadStudy,
    ::testing::Values(
        BadInput{"JobsZero", {"run", "s.toml", "--jobs", "0"}, {{"s.toml", ""}}, {"--jobs", "found 0"}},
        BadInput{"JobsNegative", {"run", "s.toml", "--jobs", "-2"}, {{"s.toml", ""}}, {"--jobs", "-2"}},
        BadInput{"JobsBeyondAnInteger",
                 {"run", "s.toml", "--jobs", "99999999999999999999"},
                 {{"s.toml", ""}},
                 {"--jobs", "found 99999999999999999999,"}},
        BadInput{"JobsText", {"run", "s.toml", "--jobs", "all"}, {{"s.toml", ""}}, {"--jobs", "all"}},
        BadInput{"SecondStudyBroken",
                 {"run", "s.toml", "t.toml", "-o", "results"},
                 {{"s.toml", convergence + rk4 + oscillator}, {"t.toml", "kind = 1\n"}},
                 {"t.toml:1", "kind"}},
        BadInput{"SameResultFile",
                 {"run", "s.toml", "d/s.toml", "-o", "results"},
                 {{"s.toml", convergence + rk4 + oscillator},
                  {"d/", ""},
                  {"d/s.toml", convergence + rk4 + oscillator}},
                 {"d/s.toml", "results/s.h5"}},
        BadInput{"OutputIsAFile",
                 {"run", "s.toml", "-o", "results"},
                 {{"s.toml", convergence + rk4 + oscillator}, {"results", "x"}},
                 {"\"results\""}},
        BadInput{"OutputCannotBeMade",
                 {"run", "s.toml", "-o", "/proc/results"},
                 {{"s.toml", convergence + rk4 + oscillator}},
                 {"/proc/results"}},
        BadInput{"ForeignResultOfTheSecondStudy",
                 {"run", "s.toml", "t.toml", "-o", "results"},
                 {{"s.toml", convergence + rk4 + oscillator},
                  {"t.toml", convergence + rk4 + oscillator},
                  {"results/", ""},
                  {"results/t.h5", "my thesis"}},
                 {"results/t.h5", "will not overwrite"}}),
    name_of);

}  // namespace
}  // namespace fw::app::test
