#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include "app/process.hpp"
#include "app/result_text.hpp"

namespace fw::app::test {
namespace {

using store::test::ScratchDirectory;
using store::test::write_bytes;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using Words = std::vector<std::string>;

/// Four cases of well under a second each; `settings` goes into [convergence].
std::string convergence(const std::string& settings) {
  return "kind = 'convergence'\ntitle = 'orders'\nmethods = ['heun', 'rk4']\n[convergence]\n" + settings +
         "\n[[problem]]\nname = 'harmonic_oscillator'\nt_end = 4.7\n[[problem]]\nname = 'rotation'\nt_end = "
         "2.3\n";
}

std::size_t count(const std::string& text, const std::string& word) {
  std::size_t number = 0;
  for (auto at = text.find(word); at != text.npos; at = text.find(word, at + 1)) ++number;
  return number;
}

class Run : public ::testing::Test {
 protected:
  /// Waits until the run of s.toml into r has kept a case, at most a minute.
  void wait_for_a_kept_case() const {
    for (int tenth = 0; tenth < 600; ++tenth) {
      std::error_code missing;
      for (const auto& entry : std::filesystem::directory_iterator(scratch_ / "r" / ".s.cases", missing)) {
        const std::string name = entry.path().filename().string();
        if (name.front() != '.' && entry.path().extension() == ".h5") return;
      }
      ::usleep(100'000);
    }
    FAIL() << "no case was kept within a minute";
  }

  ProcessResult run_study(const std::string& directory, const Words& options = {}) const {
    Words all{"run", "s.toml", "-o", directory};
    all.insert(all.end(), options.begin(), options.end());
    return run(scratch_.path(), all);
  }
  std::string file(const std::string& name) const { return (scratch_ / name).string(); }

  ScratchDirectory scratch_;
};

TEST_F(Run, ExitsWith0WhereEveryVerdictHolds) {
  write_bytes(scratch_ / "s.toml", convergence("levels = 6"));
  const ProcessResult result = run_study("r");
  EXPECT_EQ(result.exit_code, 0) << result.out;
  EXPECT_EQ(result.err, "");
  EXPECT_THAT(result.out, HasSubstr("r/s.h5: 4 hold, 0 fail, 0 not applicable"));
  inspect(R"(
s = f['summary']
assert f.attrs['status'] == 'complete' and f.attrs['kind'] == 'convergence'
assert all(v == b'holds' for v in s['verdict'][()]) and len(s['reason']) == 4
assert list(s['expected_order']) == [2, 4, 2, 4]
assert np.abs(s['order'][()] - s['expected_order'][()]).max() < 0.1
assert len(f['cases']) == 4
)",
          {file("r/s.h5")});
  EXPECT_THAT(run(scratch_.path(), {"show", "r/s.h5"}).out,
              AllOf(HasSubstr("holds"), HasSubstr("heun"), Not(HasSubstr("fails"))));
}

TEST_F(Run, ExitsWith1WhereAVerdictFails) {
  write_bytes(scratch_ / "s.toml", convergence("levels = 6\ntolerance = 1e-9"));
  const ProcessResult result = run_study("r");
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_THAT(result.out, HasSubstr("0 hold, 4 fail"));
  inspect(
      "assert f.attrs['status'] == 'complete'\nassert all(v == b'fails' for v in f['summary/verdict'][()])\n",
      {file("r/s.h5")});
  // Kept verdicts count as well.
  EXPECT_EQ(run_study("r").exit_code, 1);
}

TEST_F(Run, StrictCountsWhatIsNotApplicable) {
  // A method of mechanics on an equation of first order.
  write_bytes(
      scratch_ / "s.toml",
      "kind = 'convergence'\ntitle = 'orders'\nmethods = ['velocity_verlet']\n[convergence]\nlevels = 6\n"
      "[[problem]]\nname = 'rotation'\nt_end = 2.3\n");
  const ProcessResult result = run_study("r");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("0 hold, 0 fail, 1 not applicable"));
  EXPECT_EQ(run_study("r", {"--strict"}).exit_code, 1);
  write_bytes(scratch_ / "s.toml", convergence("levels = 6"));
  EXPECT_EQ(run_study("q", {"--strict"}).exit_code, 0);
}

TEST_F(Run, AnExplosionIsAPictureButNoSuccess) {
  write_bytes(
      scratch_ / "s.toml",
      "kind = 'simulate'\ntitle = 'motion'\nmethods = ['explicit_euler', 'velocity_verlet']\nsteps = [0.1]\n"
      "[[problem]]\nname = 'harmonic_oscillator'\nt_end = 200.0\n");
  const ProcessResult result = run_study("r");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  inspect(
      "assert list(f['summary/verdict'][()]) == [b'not applicable', b'done']\n"
      "assert list(f['summary/status'][()]) == [b'blow_up', b'success']\n"
      "assert b'grows by the factor' in f['summary/reason'][0]\n",
      {file("r/s.h5")});
  write_bytes(scratch_ / "s.toml",
              "kind = 'simulate'\ntitle = 'motion'\nmethods = ['rk4']\nsteps = [1000.0]\n"
              "[[problem]]\nname = 'harmonic_oscillator'\nt_end = 1.0\n");
  const ProcessResult too_long = run_study("r");
  EXPECT_EQ(too_long.exit_code, 2);
  EXPECT_THAT(too_long.err, HasSubstr("found 1000, expected at most the whole interval of 1 s"));
}

TEST_F(Run, KeepsFinishedCasesUnlessForced) {
  write_bytes(scratch_ / "s.toml", convergence("levels = 6"));
  EXPECT_EQ(count(run_study("r").out, "(kept)"), 0U);
  std::filesystem::copy_file(scratch_ / "r" / "s.h5", scratch_ / "first.h5");
  const ProcessResult again = run_study("r");
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_EQ(count(again.out, "(kept)"), 4U) << again.out;
  EXPECT_THAT(again.out, HasSubstr("4 kept from an earlier run"));
  inspect(
      "same(f, g)\nfor n in f['cases']: assert np.array_equal(f['cases'][n]['seconds'], "
      "g['cases'][n]['seconds'])\n",
      {file("r/s.h5"), file("first.h5")});
  const ProcessResult forced = run_study("r", {"--force"});
  EXPECT_EQ(forced.exit_code, 0);
  EXPECT_EQ(count(forced.out, "(kept)"), 0U) << forced.out;
  inspect("same(f, g)\n", {file("r/s.h5"), file("first.h5")});
}

TEST_F(Run, RunsOnlyTheCasesThatHaveChanged) {
  write_bytes(scratch_ / "s.toml", convergence("levels = 6"));
  ASSERT_EQ(run_study("r").exit_code, 0);
  std::string text = convergence("levels = 6");
  text.replace(text.find("t_end = 2.3"), 11, "t_end = 2.4");
  write_bytes(scratch_ / "s.toml", text);
  EXPECT_EQ(count(run_study("r").out, "(kept)"), 2U);
  write_bytes(scratch_ / "s.toml", convergence("levels = 7"));
  EXPECT_EQ(count(run_study("r").out, "(kept)"), 0U);
}

TEST_F(Run, GivesTheSameNumbersWithAnyNumberOfJobs) {
  write_bytes(scratch_ / "s.toml", convergence("levels = 6"));
  ASSERT_EQ(run_study("one", {"--jobs", "1"}).exit_code, 0);
  ASSERT_EQ(run_study("two", {"--jobs", "2"}).exit_code, 0);
  ASSERT_EQ(run_study("many", {"--jobs", "1000000000"}).exit_code, 0);
  inspect("same(f, g)\n", {file("one/s.h5"), file("two/s.h5")});
  inspect("same(f, g)\n", {file("one/s.h5"), file("many/s.h5")});
}

TEST_F(Run, QuickAppliesTheStudysOwnSection) {
  write_bytes(scratch_ / "s.toml", convergence("levels = 9") + "[quick]\nlevels = 6\n");
  ASSERT_EQ(run_study("r").exit_code, 0);
  ASSERT_EQ(run_study("q", {"--quick"}).exit_code, 0);
  inspect(
      "n = 'harmonic_oscillator-heun'\nassert len(f['cases'][n]['step']) == 9 and len(g['cases'][n]['step']) "
      "== 6\n",
      {file("r/s.h5"), file("q/s.h5")});
}

TEST_F(Run, GoesOnWhereItWasInterrupted) {
  // One case of a moment, one of minutes, which the interrupt stops.
  const std::string head = "kind = 'simulate'\ntitle = 'T'\nmethods = ['rk4']\nframes = 11\nsteps = [1e-2, ";
  const std::string problem = "]\n[[problem]]\nname = 'harmonic_oscillator'\nt_end = 100\n";
  write_bytes(scratch_ / "s.toml", head + "1e-9" + problem);
  Process process(scratch_.path(), {"run", "s.toml", "-o", "r"});
  wait_for_a_kept_case();
  process.send(SIGINT);
  const ProcessResult stopped = process.wait();
  EXPECT_EQ(stopped.exit_code, 3) << stopped.signal;
  EXPECT_THAT(stopped.err, HasSubstr("interrupted; finished cases are saved"));
  inspect("assert f.attrs['status'] == 'incomplete' and len(f['cases']) == 1\n", {file("r/s.h5")});

  write_bytes(scratch_ / "s.toml", head + "1e-3" + problem);
  const ProcessResult again = run_study("r");
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_EQ(count(again.out, "(kept)"), 1U) << again.out;
  inspect("assert f.attrs['status'] == 'complete' and len(f['cases']) == 2\n", {file("r/s.h5")});
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(scratch_ / "r"), {}), 1);
}

TEST_F(Run, LosesNoFinishedCaseWhenKilled) {
  write_bytes(scratch_ / "s.toml",
              "kind = 'simulate'\ntitle = 'T'\nmethods = ['rk4']\nframes = 11\nsteps = [1e-2, 1e-9]\n"
              "[[problem]]\nname = 'harmonic_oscillator'\nt_end = 100\n");
  Process process(scratch_.path(), {"run", "s.toml", "-o", "r"});
  wait_for_a_kept_case();
  process.send(SIGKILL);
  EXPECT_EQ(process.wait().signal, SIGKILL);
  EXPECT_FALSE(std::filesystem::exists(scratch_ / "r" / "s.h5"));
  std::string text = store::test::read_bytes(scratch_ / "s.toml");
  text.replace(text.find("1e-9"), 4, "1e-3");
  write_bytes(scratch_ / "s.toml", text);
  const ProcessResult again = run_study("r");
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_EQ(count(again.out, "(kept)"), 1U) << again.out;
}

TEST_F(Run, RunsStudiesOfScenesWhosePathIsRelativeToTheStudy) {
  std::filesystem::create_directory(scratch_ / "d");
  write_bytes(scratch_ / "d" / "scene.toml",
              "[particles]\nposition = [[0,0,0], [1.2,0,0]]\nmass = 1\nfixed = [0]\n"
              "[springs]\nbetween = [[0,1]]\nstiffness = 4\nrest_length = 1\n");
  write_bytes(scratch_ / "d" / "s.toml",
              "kind = 'simulate'\ntitle = 'T'\nmethods = ['velocity_verlet']\nsteps = [0.01]\n"
              "[[problem]]\nscene = 'scene.toml'\nt_end = 1\n");
  const ProcessResult result = run(scratch_.path(), {"run", "d/s.toml", "-o", "r"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(std::filesystem::exists(scratch_ / "r" / "s.h5"));
}

TEST_F(Run, RepeatsTheStudyOfAResultFileAndFindsNoDifference) {
  write_bytes(scratch_ / "s.toml", convergence("levels = 9") + "[quick]\nlevels = 6\n");
  ASSERT_EQ(run_study("r", {"--quick"}).exit_code, 0);
  std::filesystem::remove(scratch_ / "s.toml");
  const ProcessResult result = run(scratch_.path(), {"run", "r/s.h5"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("r/s.h5: repeated, "));
  EXPECT_THAT(result.out, HasSubstr("columns of 4 cases are the same bit for bit"));
  inspect("assert f.attrs['quick'] == 1 and g.attrs['quick'] == 1\n",
          {file("r/s.h5"), file("r/s.repeated.h5")});
  EXPECT_EQ(run(scratch_.path(), {"run", "r/s.h5", "-o", "elsewhere"}).exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(scratch_ / "elsewhere" / "s.repeated.h5"));
}

TEST_F(Run, RepeatsAStudyOfASceneWhoseFileIsGone) {
  write_bytes(scratch_ / "scene.toml",
              "[particles]\nposition = [[0,0,0], [1.2,0,0]]\nmass = 1\nfixed = [0]\n"
              "[springs]\nbetween = [[0,1]]\nstiffness = 4\nrest_length = 1\n");
  write_bytes(scratch_ / "s.toml",
              "kind = 'simulate'\ntitle = 'T'\nmethods = ['velocity_verlet']\nsteps = [0.01]\n"
              "[[problem]]\nscene = 'scene.toml'\nt_end = 1\n");
  ASSERT_EQ(run_study("r").exit_code, 0);
  std::filesystem::remove(scratch_ / "scene.toml");
  const ProcessResult result = run(scratch_.path(), {"run", "r/s.h5"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("are the same bit for bit"));
}

TEST_F(Run, ReportsWhatDiffersInARepetition) {
  write_bytes(scratch_ / "s.toml", convergence("levels = 6"));
  ASSERT_EQ(run_study("r").exit_code, 0);
  inspect(
      "import h5py\np = f.filename\nf.close()\ng.close()\nf = h5py.File(p, 'r+')\n"
      "f['cases/rotation-rk4/error'][2] *= 1.5\nf.close()\n"
      "import hashlib\nb = open(p, 'rb').read()\n"
      "open(p, 'ab').write(b'federwerk sha256 ' + hashlib.sha256(b).hexdigest().encode() + b'\\n')\n",
      {file("r/s.h5")});
  const ProcessResult result = run(scratch_.path(), {"run", "r/s.h5"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, HasSubstr("rotation-rk4: error: 1 of "));
  EXPECT_EQ(count(result.out, "differ, by at most"), 1U) << result.out;
}

TEST_F(Run, RepeatsFromNothingEveryTime) {
  write_bytes(scratch_ / "s.toml", convergence("levels = 6"));
  ASSERT_EQ(run_study("r").exit_code, 0);
  for (int k = 0; k < 2; ++k) EXPECT_EQ(count(run(scratch_.path(), {"run", "r/s.h5"}).out, "(kept)"), 0U);
}

TEST_F(Run, RefusesToRepeatADamagedFileOrToShrinkIt) {
  write_bytes(scratch_ / "s.toml", convergence("levels = 6"));
  ASSERT_EQ(run_study("r").exit_code, 0);
  EXPECT_THAT(run(scratch_.path(), {"run", "r/s.h5", "--quick"}).err, HasSubstr("expected no --quick"));
  inspect(
      "p = f.filename\nf.close()\ng.close()\nf = h5py.File(p, 'r+')\n"
      "f.attrs['spec'] = f.attrs['spec'].replace('levels = 6', 'levels = 7')\nf.close()\n"
      "import hashlib\nb = open(p, 'rb').read()\n"
      "open(p, 'ab').write(b'federwerk sha256 ' + hashlib.sha256(b).hexdigest().encode() + b'\\n')\n",
      {file("r/s.h5")});
  const ProcessResult result = run(scratch_.path(), {"run", "r/s.h5"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("does not match \"spec_sha256\""));
  EXPECT_FALSE(std::filesystem::exists(scratch_ / "r" / "s.repeated.h5"));
}

TEST_F(Run, RefusesToRepeatATrajectory) {
  write_bytes(scratch_ / "scene.toml",
              "[particles]\nposition = [[0,0,0], [1.2,0,0]]\nmass = 1\nfixed = [0]\n"
              "[springs]\nbetween = [[0,1]]\nstiffness = 4\nrest_length = 1\n");
  ASSERT_EQ(run(scratch_.path(),
                {"simulate", "scene.toml", "--method", "rk4", "--step", "0.1", "--t-end", "1", "-o", "t.h5"})
                .exit_code,
            0);
  const ProcessResult result = run(scratch_.path(), {"run", "t.h5"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("holds no study"));
}

}  // namespace
}  // namespace fw::app::test
