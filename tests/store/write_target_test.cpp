#include "store/write_target.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/stat.h>

#include "core/error.hpp"
#include "samples.hpp"
#include "scratch_directory.hpp"
#include "store/study_file.hpp"
#include "store/study_store.hpp"

namespace fw::store::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

void expect_refused(const std::filesystem::path& path, const char* reason) {
  EXPECT_THAT([&] { check_writable_target(path); },
              ThrowsMessage<InputError>(AllOf(HasSubstr(path.filename().string()), HasSubstr(reason))));
  EXPECT_THROW(StudyStore store(path), InputError);
}

TEST(WriteTarget, AcceptsANewFileAndLeavesNoTrace) {
  const ScratchDirectory scratch;
  EXPECT_NO_THROW(check_writable_target(scratch / "a.h5"));
  EXPECT_TRUE(scratch.names().empty());
}

TEST(WriteTarget, AcceptsAnEarlierResultOfAnyKindAndDoesNotTouchIt) {
  const ScratchDirectory scratch;
  write_trajectory(scratch / "a.h5", 2, 2);
  write_study(scratch / "b.h5", "", sample_study(1));
  const std::string before = read_bytes(scratch / "a.h5");
  EXPECT_NO_THROW(check_writable_target(scratch / "a.h5"));
  EXPECT_NO_THROW(check_writable_target(scratch / "b.h5"));
  EXPECT_EQ(read_bytes(scratch / "a.h5"), before);
}

TEST(WriteTarget, RefusesAPlaceThatCannotHoldTheFile) {
  const ScratchDirectory scratch;
  write_bytes(scratch / "file", "x");
  std::filesystem::create_directory(scratch / "directory.h5");
  expect_refused(scratch / "nowhere" / "a.h5", "there is no directory");
  expect_refused(scratch / "file" / "a.h5", "is no directory");
  expect_refused(scratch / "directory.h5", "it is a directory");
  expect_refused("/dev/null", "not a regular file");
  expect_refused(scratch / (std::string(252, 'a') + ".h5"), "too long");
  EXPECT_THROW(check_writable_target(""), InputError);
}

TEST(WriteTarget, RefusesToOverwriteWhatIsNoWholeResult) {
  const ScratchDirectory scratch;
  write_bytes(scratch / "notes.txt", "my thesis\n");
  write_bytes(scratch / "empty.h5", "");
  write_trajectory(scratch / "whole.h5", 20, 20);
  const std::string whole = read_bytes(scratch / "whole.h5");
  write_bytes(scratch / "truncated.h5", whole.substr(0, whole.size() - 100));
  run_python(
      "import h5py, sys\nf = h5py.File(sys.argv[1], 'w')\nf['x'] = [1, 2, 3]\nf.attrs['format'] = 'other'\n",
      {(scratch / "foreign.h5").string()});
  expect_refused(scratch / "notes.txt", "not an HDF5 file");
  expect_refused(scratch / "empty.h5", "not an HDF5 file");
  expect_refused(scratch / "truncated.h5", "truncated");
  expect_refused(scratch / "foreign.h5", "no federwerk result");
  EXPECT_EQ(read_bytes(scratch / "notes.txt"), "my thesis\n");
  EXPECT_EQ(scratch.names().size(), 5U);
}

TEST(WriteTarget, RefusesAResultOfALaterVersion) {
  const ScratchDirectory scratch;
  write_trajectory(scratch / "a.h5", 2, 2);
  run_python("import h5py, sys\nh5py.File(sys.argv[1], 'r+').attrs['format_version'] = 2\n",
             {(scratch / "a.h5").string()});
  expect_refused(scratch / "a.h5", "format_version 2");
}

TEST(WriteTarget, RefusesPlacesWithoutPermission) {
  const ScratchDirectory scratch;
  std::filesystem::create_directory(scratch / "closed");
  write_trajectory(scratch / "closed" / "b.h5", 2, 2);
  write_trajectory(scratch / "protected.h5", 2, 2);
  ::chmod((scratch / "closed").c_str(), 0555);
  ::chmod((scratch / "protected.h5").c_str(), 0444);
  ::chmod(scratch.path().c_str(), 0777);
  const int status = in_child([&] {
    const uid_t user = ::geteuid();
    if (user == 0 && ::seteuid(65534) != 0) return 77;  // root may write anywhere
    int refused = 0;
    for (const auto& path : {scratch / "closed" / "a.h5", scratch / "closed" / "b.h5"}) {
      try {
        check_writable_target(path);
      } catch (const InputError& error) {
        refused += std::string(error.what()).find("Permission denied") != std::string::npos;
      }
    }
    if (::seteuid(user) != 0) return 77;  // the leak checker needs the rights back at exit
    return refused == 2 ? 0 : 1;
  });
  ::chmod((scratch / "closed").c_str(), 0755);
  EXPECT_EQ(status, 0);
}

TEST(WriteTarget, RefusesAReadOnlyFileSystem) {
  const ScratchDirectory scratch;
  const int status = in_child([&] {
    if (::unshare(CLONE_NEWNS) != 0 && ::unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0) return 77;
    ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr);
    if (::mount("readonly", scratch.path().c_str(), "tmpfs", MS_RDONLY, "size=1m") != 0) return 77;
    try {
      check_writable_target(scratch / "a.h5");
      return 1;
    } catch (const InputError& error) {
      return std::string(error.what()).find("Read-only") != std::string::npos ? 0 : 2;
    }
  });
  if (WIFEXITED(status) && WEXITSTATUS(status) == 77) GTEST_SKIP() << "not allowed to mount";
  EXPECT_EQ(status, 0);
}

}  // namespace
}  // namespace fw::store::test
