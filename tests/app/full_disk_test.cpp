#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <unistd.h>

#include "app/process.hpp"
#include "store/scratch_directory.hpp"

namespace fw::app::test {
namespace {

using store::test::in_child;
using store::test::ScratchDirectory;
using store::test::write_bytes;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

const std::string cloth =
    "[generate]\nkind = 'cloth'\ncounts = [20, 20]\nspacing = 0.1\nmass = 1\nstiffness = 10\n";
/// 101 frames of 400 points are 2 MB.
const std::vector<std::string> simulate = {
    "simulate", "s.toml", "--method", "symplectic_euler", "--step", "0.001", "--t-end", "0.1", "-o", "a.h5"};
constexpr const char* study =
    "kind = 'simulate'\ntitle = 'T'\nmethods = ['rk4', 'heun']\nsteps = [1e-4]\nframes = 22000\n"
    "[[problem]]\nname = 'harmonic_oscillator'\nt_end = 10\n";

/// Mounts an empty file system of `size` at `place`, seen by this process and its children only.
bool mount_small_disk(const std::filesystem::path& place, const char* size) {
  if (::unshare(CLONE_NEWNS) != 0 && ::unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0) return false;
  return ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
         ::mount("small", place.c_str(), "tmpfs", 0, size) == 0;
}

bool limit_file_size(rlim_t bytes) {
  const rlimit limit{bytes, bytes};
  return ::setrlimit(RLIMIT_FSIZE, &limit) == 0;
}

/// Whether `result` is that of a full disk: exit code 3 and one message with the name of the file.
bool says_disk_full(const ProcessResult& result, const std::string& name) {
  // The last line; before it only that an earlier result is replaced.
  const std::size_t end = result.err.rfind('\n', result.err.size() < 2 ? 0 : result.err.size() - 2);
  const std::size_t start = end == std::string::npos ? 0 : end + 1;
  const std::string last = result.err.substr(start);
  const bool right = result.exit_code == 3 && last.starts_with("federwerk: disk full") &&
                     last.find(name) != std::string::npos &&
                     (start == 0 || result.err.find("is replaced") < start);
  if (!right) std::fprintf(stderr, "exit code %d: %s\n", result.exit_code, result.err.c_str());
  return right;
}

TEST(FullDisk, EndsASimulationWithOneMessageAndNoFile) {
  const ScratchDirectory scratch;
  const int status = in_child([&] {
    if (!mount_small_disk(scratch.path(), "size=1m")) return Process::not_prepared;
    write_bytes(scratch / "s.toml", cloth);
    const ProcessResult result = run(scratch.path(), simulate);
    if (!says_disk_full(result, "a.h5")) return 1;
    if (scratch.names() != std::vector<std::string>{"s.toml"}) return 2;
    return result.out.empty() ? 0 : 3;
  });
  if (WIFEXITED(status) && WEXITSTATUS(status) == Process::not_prepared)
    GTEST_SKIP() << "not allowed to mount";
  EXPECT_EQ(status, 0);
}

TEST(FullDisk, LeavesAnEarlierResultAlone) {
  const ScratchDirectory scratch;
  const int status = in_child([&] {
    if (!mount_small_disk(scratch.path(), "size=1m")) return Process::not_prepared;
    write_bytes(scratch / "s.toml", cloth);
    std::vector<std::string> few = simulate;
    few.insert(few.end(), {"--frames", "2"});
    if (run(scratch.path(), few).exit_code != 0) return 1;
    const std::string before = store::test::read_bytes(scratch / "a.h5");
    if (!says_disk_full(run(scratch.path(), simulate), "a.h5")) return 2;
    return store::test::read_bytes(scratch / "a.h5") == before && scratch.names().size() == 2 ? 0 : 3;
  });
  if (WIFEXITED(status) && WEXITSTATUS(status) == Process::not_prepared)
    GTEST_SKIP() << "not allowed to mount";
  EXPECT_EQ(status, 0);
}

TEST(FullDisk, EndsAStudyWhichGoesOnWhenThereIsRoom) {
  const ScratchDirectory scratch;
  const int status = in_child([&] {
    // Room for one case of 1.3 MB, not for the second one beside it.
    if (!mount_small_disk(scratch.path(), "size=2m")) return Process::not_prepared;
    write_bytes(scratch / "s.toml", study);
    if (!says_disk_full(run(scratch.path(), {"run", "s.toml", "-o", "r"}), "r/.s.cases")) return 1;
    if (std::filesystem::exists(scratch / "r" / "s.h5")) return 2;
    if (::mount("small", scratch.path().c_str(), "tmpfs", MS_REMOUNT, "size=30m") != 0) return 3;
    const ProcessResult again = run(scratch.path(), {"run", "s.toml", "-o", "r"});
    if (again.exit_code != 0) return 4;
    const auto kept = again.out.find("(kept)");
    if (kept == std::string::npos || again.out.find("(kept)", kept + 1) != std::string::npos) return 5;
    return std::filesystem::exists(scratch / "r" / "s.h5") ? 0 : 6;
  });
  if (WIFEXITED(status) && WEXITSTATUS(status) == Process::not_prepared)
    GTEST_SKIP() << "not allowed to mount";
  EXPECT_EQ(status, 0);
}

TEST(FullDisk, OrALimitOnFileSizesEndsASimulationAtAnyMoment) {
  const ScratchDirectory scratch;
  write_bytes(scratch / "s.toml", cloth);
  ASSERT_EQ(run(scratch.path(), simulate).exit_code, 0);
  const std::uint64_t whole = std::filesystem::file_size(scratch / "a.h5");
  std::filesystem::remove(scratch / "a.h5");
  for (std::uint64_t limit = 0; limit < whole; limit += whole / 7) {
    // memfd counts against the limit too: with a limit of 0 there would be no room for the message.
    const ProcessResult result =
        run(scratch.path(), simulate, [&] { return limit_file_size(std::max<std::uint64_t>(limit, 1000)); });
    EXPECT_EQ(result.exit_code, 3) << limit << " " << result.err;
    EXPECT_THAT(result.err, AllOf(StartsWith("federwerk: disk full (limit on file sizes): cannot write"),
                                  HasSubstr("a.h5")));
    EXPECT_THAT(scratch.names(), ElementsAre("s.toml"));
  }
  // HDF5 may use a block beyond the end before it cuts the file.
  EXPECT_EQ(run(scratch.path(), simulate, [&] { return limit_file_size(whole + 4096); }).exit_code, 0);
}

TEST(FullDisk, OfTheXdmfFileKeepsTheTrajectory) {
  const ScratchDirectory scratch;
  write_bytes(scratch / "s.toml", "[particles]\nposition = [[0,0,0]]\nvelocity = [[1,0,0]]\nmass = 1\n");
  std::vector<std::string> command = simulate;
  command.insert(command.end(), {"--xdmf", "--frames", "101"});
  ASSERT_EQ(run(scratch.path(), command).exit_code, 0);
  const std::uint64_t result_size = std::filesystem::file_size(scratch / "a.h5");
  const std::uint64_t xdmf_size = std::filesystem::file_size(scratch / "a.xdmf");
  ASSERT_GT(xdmf_size, result_size) << "the limit below has to lie between the two";
  std::filesystem::remove(scratch / "a.h5");
  std::filesystem::remove(scratch / "a.xdmf");
  const ProcessResult result =
      run(scratch.path(), command, [&] { return limit_file_size((result_size + xdmf_size) / 2); });
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err, AllOf(StartsWith("federwerk: disk full"), HasSubstr("a.xdmf")));
  EXPECT_THAT(scratch.names(), ElementsAre("a.h5", "s.toml"));
}

}  // namespace
}  // namespace fw::app::test
