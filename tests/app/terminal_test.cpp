#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <sstream>

#include "app/process.hpp"
#include "store/scratch_directory.hpp"
#include "text/utf8.hpp"

namespace fw::app::test {
namespace {

using store::test::ScratchDirectory;
using store::test::write_bytes;
using ::testing::HasSubstr;
using ::testing::Not;

/// The longest line that a terminal of 80 columns would break; empty: none.
std::string too_long(const std::string& text) {
  std::string longest;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (text::displayed_width(line) > 80 && line.size() > longest.size()) longest = line;
  }
  return longest;
}

constexpr const char* study =
    "kind = 'convergence'\ntitle = 'orders'\nmethods = ['heun', 'velocity_verlet']\n[convergence]\nlevels = "
    "6\n"
    "[[problem]]\nname = 'harmonic_oscillator'\nlabel = 'an_oscillator_with_a_label_that_is_rather_long'\n"
    "t_end = 4.7\n";

constexpr const char* scene =
    "title = 'damped'\n[particles]\nposition = [[0,0,0], [1,0,0]]\nmass = 1.0\nfixed = [0]\n"
    "[springs]\nbetween = [[0,1]]\nstiffness = 100.0\nrest_length = 0.9\n";

TEST(Terminal, NoTableIsWiderThanEightyColumns) {
  const ScratchDirectory scratch;
  write_bytes(scratch / "study.toml", study);
  write_bytes(scratch / "scene.toml", scene);
  const std::vector<std::vector<std::string>> calls = {
      {"list", "methods"},
      {"list", "methods", "--all"},
      {"list", "problems"},
      {"list", "scenes"},
      {"list", "studies"},
      {"list", "oracles"},
      {"run", "study.toml", "-o", "a_directory/with/a/long/name/that/has/to/be/broken/somewhere"},
      {"show", "a_directory/with/a/long/name/that/has/to/be/broken/somewhere/study.h5"},
      {"verify", "--method", "heun"},
      {"simulate", "scene.toml", "--method", "rk4", "--step", "0.01", "--t-end", "0.1", "-o",
       "made/for/it.h5"},
      {"show", "made/for/it.h5"}};
  for (const std::vector<std::string>& call : calls) {
    // A variable is no reason for wide lines in a file.
    const ProcessResult result = run(scratch.path(), call, [] { return ::setenv("COLUMNS", "300", 1) == 0; });
    EXPECT_EQ(result.exit_code, 0) << call[0] << " " << call[1] << ": " << result.err;
    EXPECT_EQ(too_long(result.out), "") << call[0] << " " << call[1];
  }
}

TEST(Terminal, ProvenanceStandsBelowTheTableAndNothingIsLost) {
  const ScratchDirectory scratch;
  write_bytes(scratch / "study.toml", study);
  EXPECT_EQ(run(scratch.path(), {"run", "study.toml", "-o", "."}).exit_code, 0);
  const std::string text = run(scratch.path(), {"show", "study.h5"}).out;
  EXPECT_LT(text.find("title     orders"), text.find("expected_order"));
  EXPECT_LT(text.find("position 2.0"), text.find("created   "));
  EXPECT_THAT(text, HasSubstr("r = 1.0000"));
}

TEST(Terminal, LongWorkSaysHowFarItIsWhereThereIsNoTerminal) {
  const ScratchDirectory scratch;
  write_bytes(scratch / "s.toml",
              "kind = 'convergence'\ntitle = 'orders'\nmethods = ['rk4']\n[convergence]\nlevels = 6\n"
              "[[problem]]\nname = 'spring_pendulum'\nt_end = 20.0\n");
  const std::string cache = (scratch / "cache").string();
  const auto with_progress = [&](const char* seconds) {
    return run(scratch.path(), {"run", "s.toml", "-o", ".", "--force"}, [&] {
      std::filesystem::remove_all(cache);
      return ::setenv("FEDERWERK_PROGRESS", seconds, 1) == 0 &&
             ::setenv("FEDERWERK_CACHE", cache.c_str(), 1) == 0;
    });
  };
  const ProcessResult often = with_progress("0.1");
  EXPECT_THAT(often.err, HasSubstr("federwerk: 0 % after 0:0"));
  EXPECT_THAT(often.err, HasSubstr("; spring_pendulum-rk4 for 0:0"));
  EXPECT_THAT(often.err, HasSubstr("(reference in binary128: "));
  EXPECT_THAT(often.err, HasSubstr(" left)"));
  EXPECT_EQ(with_progress("0").err, "");
  const ProcessResult wrong = with_progress("soon");
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("FEDERWERK_PROGRESS: found \"soon\""));
}

TEST(Terminal, FilesOfTheOtherSortAreNamed) {
  const ScratchDirectory scratch;
  write_bytes(scratch / "study.toml", study);
  write_bytes(scratch / "scene.toml", scene);
  const ProcessResult simulated =
      run(scratch.path(), {"simulate", "study.toml", "--method", "rk4", "--step", "0.1", "--t-end", "1"});
  EXPECT_EQ(simulated.exit_code, 2);
  EXPECT_THAT(simulated.err, HasSubstr("\"federwerk run study.toml\" runs the study"));
  EXPECT_EQ(run(scratch.path(), {"equilibrium", "study.toml"}).exit_code, 2);
  const ProcessResult ran = run(scratch.path(), {"run", "scene.toml"});
  EXPECT_EQ(ran.exit_code, 2);
  EXPECT_THAT(ran.err, HasSubstr("\"federwerk simulate scene.toml"));
  EXPECT_FALSE(std::filesystem::exists(scratch / "results"));
}

TEST(Terminal, AResultThatIsReplacedIsNamedOnceAndADampedRunHasNoDrift) {
  const ScratchDirectory scratch;
  write_bytes(scratch / "scene.toml", scene);
  write_bytes(scratch / "damped.toml", std::string(scene) + "damping = 0.5\n");
  const auto simulate = [&](const std::string& file) {
    return run(scratch.path(),
               {"simulate", file, "--method", "rk4", "--step", "0.01", "--t-end", "0.5", "-o", "new/a.h5"});
  };
  EXPECT_EQ(simulate("scene.toml").err, "");
  EXPECT_THAT(run(scratch.path(), {"show", "new/a.h5"}).out, HasSubstr("energy drift "));
  EXPECT_EQ(simulate("damped.toml").err, "federwerk: note: \"new/a.h5\" is there already and is replaced\n");
  const std::string shown = run(scratch.path(), {"show", "new/a.h5"}).out;
  EXPECT_THAT(shown, HasSubstr("energy change -"));
  EXPECT_THAT(shown, HasSubstr("dampers"));
  EXPECT_THAT(shown, Not(HasSubstr("energy drift")));
}

TEST(Terminal, FailuresSayWhatMendsThem) {
  const ScratchDirectory scratch;
  write_bytes(scratch / "drag.toml", std::string(scene) + "[world]\ndrag = 1e4\n");
  const ProcessResult negative = run(scratch.path(), {"simulate", "drag.toml", "--method", "forest_ruth",
                                                      "--step", "0.01", "--t-end", "0.1"});
  EXPECT_EQ(negative.exit_code, 3);
  EXPECT_THAT(negative.err, HasSubstr("a substep goes back in time by"));
  const ProcessResult instant =
      run(scratch.path(), {"simulate", "drag.toml", "--method", "sundials:ida", "--rtol", "1e-6", "--atol",
                           "1e-9", "--t-end", "1e-300"});
  EXPECT_EQ(instant.exit_code, 3);
  EXPECT_THAT(instant.err, HasSubstr("too short for it to take a step"));
  EXPECT_THAT(instant.err, Not(HasSubstr("tstop")));
}

}  // namespace
}  // namespace fw::app::test
