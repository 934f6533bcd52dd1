#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/process.hpp"
#include "store/scratch_directory.hpp"

namespace fw::app::test {
namespace {

using ::testing::HasSubstr;

const std::string scene = "[particles]\nposition = [[0,0,0], [1,0,0]]\nmass = 1\n";
const std::string study =
    "kind = 'convergence'\ntitle = 'T'\nmethods = ['rk4']\n[[problem]]\nname = 'harmonic_oscillator'\n";

TEST(Check, SaysOfEveryFileWhetherItIsValidAndRunsNothing) {
  const store::test::ScratchDirectory scratch;
  store::test::write_bytes(scratch / "a.toml", scene);
  store::test::write_bytes(scratch / "b.toml", study);
  const ProcessResult result =
      run(scratch.path(), {"check", "a.toml", "b.toml", "--method", "rkc2[stages=5]"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, "a.toml: a valid scene\nb.toml: a valid study\nrkc2[stages=5]: a valid method\n");
  EXPECT_EQ(result.err, "");
  EXPECT_THAT(scratch.names(), ::testing::ElementsAre("a.toml", "b.toml"));
}

TEST(Check, GoesOnAfterAMistakeAndSaysWhatRunAndSimulateSay) {
  const store::test::ScratchDirectory scratch;
  store::test::write_bytes(scratch / "a.toml", scene + "fixd = [0]\n");
  store::test::write_bytes(scratch / "b.toml", study + "t_end = -1\n");
  store::test::write_bytes(scratch / "c.toml", scene);
  const ProcessResult result = run(scratch.path(), {"check", "a.toml", "b.toml", "missing.toml", "c.toml",
                                                    "--method", "rk4", "--method", "rk5"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.out, "c.toml: a valid scene\nrk4: a valid method\n");
  const ProcessResult of_scene =
      run(scratch.path(), {"simulate", "a.toml", "--method", "rk4", "--step", "1", "--t-end", "1"});
  const ProcessResult of_study = run(scratch.path(), {"run", "b.toml"});
  EXPECT_THAT(of_scene.err, HasSubstr("unknown key \"fixd\" in [particles]; did you mean \"fixed\"?"));
  EXPECT_THAT(of_study.err, HasSubstr("t_end: found -1, expected a finite number > 0"));
  EXPECT_THAT(result.err, ::testing::StartsWith(of_scene.err + of_study.err +
                                                "federwerk: missing.toml: no such file\n"
                                                "federwerk: unknown method \"rk5\""));
}

TEST(Check, ChecksOptionsInPetscsNotationToo) {
  const store::test::ScratchDirectory scratch;
  const ProcessResult result =
      run(scratch.path(), {"check", "--method", "petsc:ts_rk[petsc=-ts_adpat_type none]"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("-ts_adpat_type"));
}

TEST(Check, SaysWhatItExpectsOfAFileThatIsNeitherStudyNorScene) {
  const store::test::ScratchDirectory scratch;
  store::test::write_bytes(scratch / "a.toml", "title = 'T'\n");
  store::test::write_bytes(scratch / "b.toml", "knd = 'energy'\n");
  const ProcessResult result = run(scratch.path(), {"check", "a.toml", "b.toml"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(
      result.err,
      "federwerk: a.toml: missing key \"kind\", expected the kind of a study, or a scene with [particles] "
      "or [generate]\n"
      "federwerk: b.toml:1: unknown key \"knd\" at the top of the file; did you mean \"kind\"?\n");
  const ProcessResult nothing = run(scratch.path(), {"check"});
  EXPECT_EQ(nothing.exit_code, 2);
  EXPECT_THAT(nothing.err, HasSubstr("found nothing to check, expected a file or --method"));
}

TEST(Check, PrintsJson) {
  const store::test::ScratchDirectory scratch;
  store::test::write_bytes(scratch / "a.toml", scene);
  const ProcessResult result = run(scratch.path(), {"check", "--json", "a.toml", "--method", "rk5"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.err, "");
  EXPECT_THAT(result.out, HasSubstr("\"name\": \"a.toml\""));
  EXPECT_THAT(result.out, HasSubstr("\"valid\": true"));
  EXPECT_THAT(result.out, HasSubstr("\"valid\": false"));
  EXPECT_THAT(result.out, HasSubstr("unknown method \\\"rk5\\\""));
}

}  // namespace
}  // namespace fw::app::test
