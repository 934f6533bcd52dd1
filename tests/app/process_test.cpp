#include "app/process.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include "store/scratch_directory.hpp"

namespace fw::app::test {
namespace {

using store::test::ScratchDirectory;
using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(Process, CapturesOutputAndExitCode) {
  const ScratchDirectory scratch;
  const ProcessResult version = run(scratch.path(), {"--version"});
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_FALSE(version.out.empty());
  EXPECT_EQ(version.err, "");
  EXPECT_GT(version.peak_memory, 1000);
  const ProcessResult nothing = run(scratch.path(), {});
  EXPECT_EQ(nothing.exit_code, 2);
  EXPECT_EQ(nothing.out, "");
  EXPECT_THAT(nothing.err, StartsWith("federwerk: "));
}

TEST(Process, ReportsAChildThatCouldNotBePrepared) {
  const ScratchDirectory scratch;
  EXPECT_EQ(run(scratch.path(), {"--version"}, [] { return false; }).exit_code, Process::not_prepared);
}

TEST(Process, HasHelpOnEveryLevel) {
  const ScratchDirectory scratch;
  const ProcessResult top = run(scratch.path(), {"--help"});
  EXPECT_EQ(top.exit_code, 0);
  for (const std::string command : {"list", "describe", "simulate", "run", "show"}) {
    EXPECT_THAT(top.out, HasSubstr(command));
    const ProcessResult help = run(scratch.path(), {command, "--help"});
    EXPECT_EQ(help.exit_code, 0) << command;
    EXPECT_THAT(help.out, HasSubstr("--help")) << command;
    EXPECT_EQ(help.err, "") << command;
  }
}

TEST(Process, ReportsOutputThatCannotBeWritten) {
  const ScratchDirectory scratch;
  const ProcessResult full =
      run(scratch.path(), {"list", "methods"}, [] { return ::freopen("/dev/full", "w", stdout) != nullptr; });
  EXPECT_EQ(full.exit_code, 3);
  EXPECT_THAT(full.err, HasSubstr("cannot write to standard output: No space left on device"));
}

}  // namespace
}  // namespace fw::app::test
