// Result files from strangers: cut, changed, unsealed, with sizes that nobody could hold.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "samples.hpp"
#include "scratch_directory.hpp"
#include "store/file/seal.hpp"
#include "store/input_file.hpp"
#include "store/show_content.hpp"
#include "store/study_file.hpp"
#include "store/trajectory_writer.hpp"

namespace fw::store::test {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;

/// What is said of a file; empty if it is shown.
std::string complaint(const std::filesystem::path& path) {
  try {
    read_show_content(path);
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr(path.filename().string()));
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    return error.what();
  }
  return "";
}

/// A trajectory as versions without seals of trajectories wrote it.
std::string unsealed_trajectory(const ScratchDirectory& scratch) {
  const auto path = scratch / "old.h5";
  write_trajectory(path, 3, 40);
  run_python("import h5py, sys\nwith h5py.File(sys.argv[1], 'r+') as file: del file.attrs['seal']\n",
             {path.string()});
  const std::string bytes = read_bytes(path);
  EXPECT_EQ(bytes.find("federwerk sha256"), std::string::npos);
  return bytes;
}

TEST(DamagedFile, OfWhichAnyNumberOfBytesIsMissingSaysSo) {
  const ScratchDirectory scratch;
  write_trajectory(scratch / "trajectory.h5", 3, 20);
  write_study(scratch / "study.h5", "", sample_study(2));
  for (const char* name : {"trajectory.h5", "study.h5"}) {
    const std::string whole = read_bytes(scratch / name);
    EXPECT_EQ(complaint(scratch / name), "");
    for (std::size_t cut = 1; cut < seal_size; ++cut) {
      write_bytes(scratch / "cut.h5", whole.substr(0, whole.size() - cut));
      EXPECT_THAT(complaint(scratch / "cut.h5"), HasSubstr("the seal is damaged or missing")) << name << cut;
    }
    write_bytes(scratch / "cut.h5", whole.substr(0, whole.size() - seal_size));
    EXPECT_THAT(complaint(scratch / "cut.h5"),
                HasSubstr("the seal is missing: the file was interrupted, cut"));
    write_bytes(scratch / "cut.h5", whole.substr(0, whole.size() - seal_size - 1));
    EXPECT_THAT(complaint(scratch / "cut.h5"), HasSubstr("is truncated"));
    for (const std::string& more : {std::string("x"), std::string(seal_size, 'x'), whole}) {
      write_bytes(scratch / "cut.h5", whole + more);
      EXPECT_THAT(complaint(scratch / "cut.h5"), AnyOf(HasSubstr("the seal"), HasSubstr("SHA-256"))) << name;
    }
  }
}

TEST(DamagedFile, ThatAnotherProgramChangedSaysSo) {
  const ScratchDirectory scratch;
  write_study(scratch / "study.h5", "", sample_study(2));
  run_python("import h5py, sys\nwith h5py.File(sys.argv[1], 'r+') as file: file.attrs['note'] = 'mine'\n",
             {(scratch / "study.h5").string()});
  EXPECT_THAT(complaint(scratch / "study.h5"), HasSubstr("seal"));
}

TEST(DamagedFile, TrajectoriesOfVersionsWithoutSealAreShown) {
  const ScratchDirectory scratch;
  unsealed_trajectory(scratch);
  EXPECT_EQ(complaint(scratch / "old.h5"), "");
}

TEST(DamagedFile, WithoutSealNeverCrashesItsReader) {
  const ScratchDirectory scratch;
  const std::string whole = unsealed_trajectory(scratch);
  std::mt19937_64 random(20261128);
  int refused = 0;
  constexpr int files = 300;
  for (int i = 0; i < files; ++i) {
    std::string bytes = whole;
    for (std::uint64_t k = 1 + random() % 4; k > 0; --k) {
      // The first kilobytes hold most of the structure.
      const std::size_t at =
          random() % (i % 2 == 0 ? std::min<std::size_t>(bytes.size(), 4096) : bytes.size());
      bytes[at] = static_cast<char>(random());
    }
    write_bytes(scratch / "strange.h5", bytes);
    if (!complaint(scratch / "strange.h5").empty()) ++refused;
  }
  EXPECT_GT(refused, files / 10);
}

TEST(DamagedFile, WithSizesThatNobodyHoldsIsRefused) {
  const ScratchDirectory scratch;
  for (const char* program :
       {"with h5py.File(sys.argv[1], 'r+') as file: file.create_dataset('big', (1 << 44,), 'f8', "
        "chunks=(1024,))",
        "with h5py.File(sys.argv[1], 'r+') as file: file['outside'] = h5py.ExternalLink('/dev/zero', '/')",
        "with h5py.File(sys.argv[1], 'r+') as file: file['trajectory/loop'] = file['/']",
        "with h5py.File(sys.argv[1], 'r+') as file: file['named'] = numpy.dtype('f8')"}) {
    unsealed_trajectory(scratch);
    run_python(std::string("import h5py, numpy, sys\n") + program + "\n", {(scratch / "old.h5").string()});
    EXPECT_THAT(complaint(scratch / "old.h5"), HasSubstr("is damaged")) << program;
  }
}

TEST(DamagedFile, ThatIsNotHdf5SaysSo) {
  const ScratchDirectory scratch;
  for (const std::string& text : {std::string(), std::string("hello"), std::string(5000, '\0')}) {
    write_bytes(scratch / "text.h5", text);
    EXPECT_THAT(complaint(scratch / "text.h5"), HasSubstr("is not an HDF5 file"));
  }
}

}  // namespace
}  // namespace fw::store::test
