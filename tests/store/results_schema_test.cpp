#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "paths.hpp"
#include "samples.hpp"
#include "scratch_directory.hpp"
#include "store/study_file.hpp"

namespace fw::store::test {
namespace {

using ::testing::HasSubstr;

const std::filesystem::path source = fw::test::source_directory();

/// What scripts/check_results_schema.py says about a file and a text of the description.
std::string deviations(const std::string& description, const std::filesystem::path& file) {
  const ScratchDirectory scratch;
  write_bytes(scratch / "schema.md", description);
  const std::string command = fw::test::python_command() + " '" +
                              (source / "scripts/check_results_schema.py").string() + "' '" +
                              (scratch / "schema.md").string() + "' '" + file.string() + "' 2>&1 || true";
  FILE* pipe = ::popen(command.c_str(), "r");
  std::string out;
  for (int c; (c = std::fgetc(pipe)) != EOF;) out += static_cast<char>(c);
  ::pclose(pipe);
  return out;
}

std::string description() {
  return read_bytes(source / "docs/results_schema.md");
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

std::string without_line(std::string text, const std::string& start) {
  const std::size_t at = text.find(start);
  EXPECT_NE(at, std::string::npos) << start;
  return text.erase(at, text.find('\n', at) + 1 - at);
}

TEST(ResultsSchema, DescribesATrajectoryExactly) {
  const ScratchDirectory scratch;
  write_trajectory(scratch / "a.h5", 4, 3);
  EXPECT_EQ(deviations(description(), scratch / "a.h5"), "1 file(s) as described\n");
}

// Convergence and simulate are checked on files of the executable: tests/app/results_schema_test.py.
TEST(ResultsSchema, DescribesStudiesInGeneral) {
  const ScratchDirectory scratch;
  study::StudyResult study = sample_study(3);
  study.kind = "some other kind";
  write_study(scratch / "a.h5", "", study);
  EXPECT_EQ(deviations(description(), scratch / "a.h5"), "1 file(s) as described\n");
}

TEST(ResultsSchema, TheCheckSeesEveryKindOfDeviation) {
  const ScratchDirectory scratch;
  write_trajectory(scratch / "a.h5", 4, 3);
  const auto says = [&](const std::string& text, const char* deviation) {
    EXPECT_THAT(deviations(text, scratch / "a.h5"), HasSubstr(deviation));
  };
  const std::string text = description();
  says(without_line(text, "| `/system/mass`"), "/system/mass is not described");
  says(without_line(text, "| `seed`"), "attribute seed is not described");
  says(replaced(text, "| `/system/mass` |",
                "| `/system/mass` | (n) | float64 | `kg` | |\n| `/system/charge` |"),
       "/system/charge is described but not there");
  says(replaced(text, "| `/system/mass` | (n)", "| `/system/mass` | (s)"), "with s = ");
  says(replaced(text, "| `/system/mass` | (n)", "| `/system/mass` | (n, 3)"), "/system/mass has shape");
  says(replaced(text, "| `/system/mass` | (n) | float64", "| `/system/mass` | (n) | int64"),
       "/system/mass is float64");
  says(replaced(text, "float64 | `kg`", "float64 | `g`"), "/system/mass has unit 'kg'");
  says(replaced(text, "| `seed` | int64", "| `seed` | text"), "attribute seed is int64");
  says(replaced(text, "| `seed` | int64 | all", "| `wind` | text | all | x |\n| `seed` | int64 | all"),
       "attribute wind is missing");
}

TEST(ResultsSchema, H5pyReadsAttributesAndTextAsStr) {
  const ScratchDirectory scratch;
  write_trajectory(scratch / "a.h5", 2, 3);
  write_study(scratch / "b.h5", "", sample_study(2));
  EXPECT_EQ(run_python(R"(
import h5py, hashlib, sys
a, b = h5py.File(sys.argv[1], 'r'), h5py.File(sys.argv[2], 'r')
assert type(a.attrs['title']) is str and a.attrs['title'] == 'Feder mit Dämpfer, Größe 1'
assert hashlib.sha256(a.attrs['spec'].encode()).hexdigest() == a.attrs['spec_sha256']
assert a.attrs['seed'] == -7 and a['trajectory/position'].shape == (3, 2, 3)
assert a['trajectory/position'].attrs['unit'] == 'm' and a['system/springs'].dtype == 'int32'
assert a['counters/rhs_evaluations'][()] == 4000000001
note = b['cases/pendel-rk0/note']
assert note.asstr()[0] == 'Überschwinger' and h5py.check_string_dtype(note.dtype).encoding == 'utf-8'
assert b['cases/pendel-rk1/error'].shape == (2, 3) and b['cases/pendel-rk1/error'].attrs['norm'] == 'größter Fehler'
assert list(b['summary/verdict'].asstr()) == ['holds', 'fails']
assert len({len(column) for column in b['summary'].values()}) == 1
print('fine')
)",
                       {(scratch / "a.h5").string(), (scratch / "b.h5").string()}),
            "fine\n");
}

}  // namespace
}  // namespace fw::store::test
