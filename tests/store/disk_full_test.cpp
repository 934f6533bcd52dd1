#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/statvfs.h>

#include <functional>

#include "core/error.hpp"
#include "same_result.hpp"
#include "samples.hpp"
#include "scratch_directory.hpp"
#include "store/study_file.hpp"
#include "store/study_store.hpp"
#include "store/trajectory_summary.hpp"
#include "store/xdmf.hpp"

namespace fw::store::test {
namespace {

constexpr int no_privilege = 77;

/// Mounts an empty file system of one mebibyte at `place`, seen by this process only.
bool mount_small_disk(const std::filesystem::path& place) {
  const std::string user = "0 " + std::to_string(::geteuid()) + " 1";
  if (::unshare(CLONE_NEWNS) != 0) {
    if (::unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0) return false;
    write_bytes("/proc/self/uid_map", user);
  }
  return ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
         ::mount("small", place.c_str(), "tmpfs", 0, "size=1m") == 0;
}

std::uint64_t free_bytes(const std::filesystem::path& place) {
  struct statvfs status {};
  ::statvfs(place.c_str(), &status);
  return std::uint64_t{status.f_bavail} * status.f_frsize;
}

/// The message of the SystemError that `write` throws, or what else happened.
std::string refusal(const std::function<void()>& write) {
  try {
    write();
    return "no error";
  } catch (const SystemError& error) {
    return error.what();
  } catch (const std::exception& error) {
    return std::string("another error: ") + error.what();
  }
}

bool says_disk_full(const std::string& message, const std::string& name) {
  const bool right = message.rfind("disk full", 0) == 0 && message.find(name) != std::string::npos &&
                     message.find('\n') == std::string::npos;
  if (!right) std::fprintf(stderr, "message: %s\n", message.c_str());
  return right;
}

void limit_file_size(rlim_t bytes) {
  struct rlimit limit {};
  ::getrlimit(RLIMIT_FSIZE, &limit);
  limit.rlim_cur = bytes;
  ::setrlimit(RLIMIT_FSIZE, &limit);
}

TEST(DiskFull, AtAnyMomentOfATrajectoryIsOneErrorAndLeavesNothing) {
  const ScratchDirectory scratch;
  const int status = in_child([&] {
    if (!mount_small_disk(scratch.path())) return no_privilege;
    const auto write = [&] { write_trajectory(scratch / "a.h5", 200, 40); };  // 400 kB, written at its end
    write();
    const std::uint64_t whole = std::filesystem::file_size(scratch / "a.h5");
    std::filesystem::remove(scratch / "a.h5");
    const std::uint64_t available = free_bytes(scratch.path());
    int refused = 0;
    for (std::uint64_t left = 0; left + 8192 < whole; left += 16384) {
      write_bytes(scratch / "filler", std::string(available - left, 'x'));
      if (!says_disk_full(refusal(write), "a.h5")) return 2;
      if (scratch.names() != std::vector<std::string>{"filler"}) return 3;
      ++refused;
      std::filesystem::remove(scratch / "filler");
    }
    write();  // the library is as good as new
    return refused > 20 && read_trajectory_summary(scratch / "a.h5").frames == 40 ? 0 : 4;
  });
  if (WIFEXITED(status) && WEXITSTATUS(status) == no_privilege) GTEST_SKIP() << "not allowed to mount";
  EXPECT_EQ(status, 0);
}

TEST(DiskFull, OfALongTrajectoryIsNoticedWhileItIsComputed) {
  const ScratchDirectory scratch;
  const int status = in_child([&] {
    if (!mount_small_disk(scratch.path())) return no_privilege;
    TrajectoryWriter writer(scratch / "a.h5", header(), chain(1000), known_quantities, 100000);
    int frames = 0;
    const std::string message = refusal([&] {
      for (; frames < 1000; ++frames) writer.frame(frames, known_state(1000, frames));
    });
    if (!says_disk_full(message, "a.h5")) return 2;
    if (!scratch.names().empty()) return 3;
    // The writer is of no more use but does no harm.
    if (refusal([&] { writer.finish({}, {}); }).rfind("another error", 0) != 0) return 4;
    return frames < 100 ? 0 : 5;
  });
  if (WIFEXITED(status) && WEXITSTATUS(status) == no_privilege) GTEST_SKIP() << "not allowed to mount";
  EXPECT_EQ(status, 0);
}

TEST(DiskFull, KeepsTheFinishedCasesOfAStudy) {
  const ScratchDirectory scratch;
  const int status = in_child([&] {
    if (!mount_small_disk(scratch.path())) return no_privilege;
    {
      StudyStore store(scratch / "a.h5");
      store.keep(sample_case(0));
      write_bytes(scratch / "filler", std::string(free_bytes(scratch.path()), 'x'));
      if (!says_disk_full(refusal([&] { store.keep(sample_case(1)); }), ".a.cases")) return 2;
      if (!says_disk_full(refusal([&] { store.write("", sample_study(2)); }), "a.h5")) return 3;
    }
    std::filesystem::remove(scratch / "filler");
    StudyStore store(scratch / "a.h5");
    const auto kept = store.find(sample_case(0).key);
    if (!kept || !same(*kept, sample_case(0)) || store.find(sample_case(1).key)) return 4;
    store.write("", sample_study(2));
    return scratch.names() == std::vector<std::string>{"a.h5"} ? 0 : 5;
  });
  if (WIFEXITED(status) && WEXITSTATUS(status) == no_privilege) GTEST_SKIP() << "not allowed to mount";
  EXPECT_EQ(status, 0);
}

TEST(DiskFull, ALimitOnFileSizesIsAnErrorAtAnyMomentNotASignal) {
  const ScratchDirectory scratch;
  const int status = in_child([&] {
    const std::vector<std::function<void()>> writes{
        [&] { write_trajectory(scratch / "a.h5", 200, 40); },
        [&] { write_study(scratch / "a.h5", "", sample_study(20)); },
    };
    for (const auto& write : writes) {
      write();
      const std::uint64_t whole = std::filesystem::file_size(scratch / "a.h5");
      std::filesystem::remove(scratch / "a.h5");
      for (std::uint64_t limit = 0; limit < whole; limit += whole / 37) {
        limit_file_size(limit);
        const std::string message = refusal(write);
        limit_file_size(RLIM_INFINITY);
        if (!says_disk_full(message, "a.h5")) return 2;
        if (!scratch.names().empty()) return 3;
      }
      limit_file_size(whole + 4096);  // enough: HDF5 may use a block beyond the end before it cuts the file
      write();
      limit_file_size(RLIM_INFINITY);
      if (std::filesystem::file_size(scratch / "a.h5") != whole) return 4;
      std::filesystem::remove(scratch / "a.h5");
    }
    return 0;
  });
  EXPECT_EQ(status, 0);
}

TEST(DiskFull, OfAnXdmfFileLeavesTheTrajectoryAlone) {
  const ScratchDirectory scratch;
  write_trajectory(scratch / "a.h5", 3, 50);
  const std::string before = read_bytes(scratch / "a.h5");
  const int status = in_child([&] {
    limit_file_size(10000);
    return says_disk_full(refusal([&] { write_xdmf(scratch / "a.h5"); }), "a.xdmf") ? 0 : 2;
  });
  EXPECT_EQ(status, 0);
  EXPECT_THAT(scratch.names(), ::testing::ElementsAre("a.h5"));
  EXPECT_EQ(read_bytes(scratch / "a.h5"), before);
}

}  // namespace
}  // namespace fw::store::test
