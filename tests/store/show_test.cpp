#include "store/show.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/error.hpp"
#include "samples.hpp"
#include "scratch_directory.hpp"
#include "store/show_table.hpp"
#include "store/study_file.hpp"
#include "store/trajectory_summary.hpp"
#include "text/json_writer.hpp"
#include "text/text_table.hpp"
#include "text/utf8.hpp"

namespace fw::store::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::ThrowsMessage;

TEST(TextTable, AlignsNumbersRightAndTextLeftCountingUmlautsOnce) {
  text::TextTable table;
  table.add_column("name", text::TextTable::Align::left, {"Übergröße", "x"});
  table.add_column("order", text::TextTable::Align::right, {"4", "10.25"});
  table.add_column("reason", text::TextTable::Align::left, {"a\nb", ""});
  EXPECT_EQ(table.text(),
            "name       order  reason\n"
            "---------  -----  ------\n"
            "Übergröße      4  a b\n"
            "x          10.25\n");
}

TEST(Utf8, ReplacesWhatIsNotUtf8AndKeepsTheRest) {
  EXPECT_EQ(text::valid_utf8("aü€𝄞"), "aü€𝄞");
  EXPECT_EQ(text::valid_utf8("a\xFFz"), "a\uFFFDz");
  EXPECT_EQ(text::valid_utf8("\xC0\xAF"), "\uFFFD\uFFFD") << "overlong";
  EXPECT_EQ(text::valid_utf8("\xED\xA0\x80"), "\uFFFD\uFFFD\uFFFD") << "surrogate";
  EXPECT_EQ(text::valid_utf8("\xE2\x82"), "\uFFFD\uFFFD") << "cut short";
  EXPECT_EQ(text::printable_line("a\x1b[31mb\u009bc"), "a [31mb c")
      << "no escape sequences reach the terminal";
}

TEST(JsonWriter, NestsEscapesAndWritesNullForNan) {
  text::JsonWriter json;
  json.begin_object().key("a\"b").value("x\\\n\x01").key("list").begin_array();
  json.value(4.0)
      .value(1e300)
      .value(-0.1)
      .value(std::nan(""))
      .value(std::int64_t{-3})
      .value(true)
      .end_array();
  json.key("none").begin_object().end_object().end_object();
  EXPECT_EQ(json.text(),
            "{\n  \"a\\\"b\": \"x\\\\\\n\\u0001\",\n  \"list\": [\n    4.0,\n    1e+300,\n    -0.1,\n    "
            "null,\n    -3,\n    true\n  ],\n"
            "  \"none\": {}\n}\n");
}

TEST(Show, AStudyAsATableWithItsVerdicts) {
  const ScratchDirectory scratch;
  write_study(scratch / "a.h5", "federwerk run a.toml", sample_study(4));
  const std::string text = show(scratch / "a.h5");
  EXPECT_THAT(text, HasSubstr("kind      convergence\n"));
  EXPECT_THAT(text, HasSubstr("title     Ordnung der Verfahren für Federn\n"));
  EXPECT_THAT(text, HasSubstr("status    complete\n"));
  EXPECT_THAT(text, HasSubstr("command   federwerk run a.toml\n"));
  EXPECT_THAT(text, HasSubstr("seed      42\n"));
  EXPECT_THAT(
      text,
      HasSubstr(
          "case        method  order  rhs_evaluations  seconds [s]  verdict         reason\n"
          "----------  ------  -----  ---------------  -----------  --------------  ---------------\n"
          "pendel-rk0  rk0         4              100          0.5  holds           Ordnung 0 ± 0.1\n"
          "pendel-rk1  rk1       nan              101          0.5  fails           Ordnung 1 ± 0.1\n"
          "pendel-rk2  rk2         6              102          0.5  not applicable  Ordnung 2 ± 0.1\n"));
  EXPECT_THAT(text, HasSubstr("4 cases: 2 hold, 1 fails, 1 not applicable\n"));
}

TEST(Show, AStudyAsJsonThatPythonReads) {
  const ScratchDirectory scratch;
  write_study(scratch / "a.h5", "federwerk run", sample_study(4));
  write_bytes(scratch / "a.json", show_json(scratch / "a.h5"));
  EXPECT_EQ(run_python(R"(
import json, sys
a = json.load(open(sys.argv[1], encoding='utf-8'))
assert a['attributes']['title'] == 'Ordnung der Verfahren für Federn', a
assert a['attributes']['format_version'] == 1 and a['attributes']['seed'] == 42
assert [r['method'] for r in a['summary']] == ['rk0', 'rk1', 'rk2', 'rk3']
assert a['summary'][1]['order'] is None and a['summary'][2]['order'] == 6.0
assert a['summary'][3]['rhs_evaluations'] == 103 and a['units']['seconds'] == 's'
assert a['verdicts'] == {'holds': 2, 'fails': 1, 'not applicable': 1, 'done': 0}
print('fine')
)",
                       {(scratch / "a.json").string()}),
            "fine\n");
}

TEST(Show, ATrajectoryWithItsEnergies) {
  const ScratchDirectory scratch;
  write_trajectory(scratch / "a.h5", 3, 5);
  // kinetic 1 + t, elastic 2 + q₀ with q₀ = frame, gravitational 3, obstacle 4 + v₀ with v₀ = frame + 0.009
  const TrajectorySummary summary = read_trajectory_summary(scratch / "a.h5");
  EXPECT_EQ(summary.frames, 5U);
  EXPECT_EQ(summary.particles, 3U);
  EXPECT_EQ(summary.springs, 2U);
  EXPECT_EQ(summary.time_start, 0.0);
  EXPECT_EQ(summary.time_end, 2.0);
  EXPECT_EQ(summary.kinetic_end, 3.0);
  EXPECT_DOUBLE_EQ(summary.potential_start, 9.009);
  EXPECT_DOUBLE_EQ(summary.potential_end, 17.009);
  EXPECT_DOUBLE_EQ(summary.drift, 10.0);
  EXPECT_DOUBLE_EQ(summary.largest_drift, 10.0);
  const std::string text = show(scratch / "a.h5");
  EXPECT_THAT(text, HasSubstr("5 frames of 3 particles and 2 springs, t = 0 s to 2 s\n"));
  EXPECT_THAT(text, HasSubstr("total       10.009  20.009\n"));
  EXPECT_THAT(text, HasSubstr("energy drift 10 J, at most 10 J (relative 0.999101, at most 0.999101)\n"));
  EXPECT_THAT(text, HasSubstr("rhs_evaluations       4000000001\n"));
  EXPECT_THAT(text, HasSubstr("solver    success\n"));
  write_bytes(scratch / "a.json", show_json(scratch / "a.h5"));
  EXPECT_EQ(run_python("import json, sys\na = json.load(open(sys.argv[1]))\n"
                       "print(a['trajectory']['frames'], a['trajectory']['energy_drift'], "
                       "a['counters']['rhs_evaluations'], a['counters']['seconds'])\n",
                       {(scratch / "a.json").string()}),
            "5 10.0 4000000001 0.25\n");
}

TEST(Show, FindsTheLargestDriftBetweenTheEndsAndNanIfThereIsOne) {
  const ScratchDirectory scratch;
  const auto drift = [&](double middle) {
    TrajectoryWriter writer(scratch / "a.h5", header(), chain(1),
                            {.list = {{"kinetic_energy", "J"}, {"potential_energy", "J"}},
                             .evaluate =
                                 [&](double t, ConstVectorRef, ConstVectorRef, std::span<double> values) {
                                   values[0] = t == 1.0 ? middle : 5.0;
                                   values[1] = 0.0;
                                 }},
                            3);
    for (int f = 0; f < 4; ++f) writer.frame(f, known_state(1, f));
    writer.finish({}, {});
    return read_trajectory_summary(scratch / "a.h5");
  };
  EXPECT_EQ(drift(2.0).largest_drift, 3.0);
  EXPECT_EQ(drift(2.0).drift, 0.0);
  EXPECT_TRUE(std::isnan(drift(std::nan("")).largest_drift));
}

TEST(Show, ATrajectoryWithoutFramesIsNoError) {
  const ScratchDirectory scratch;
  write_trajectory(scratch / "a.h5", 2, 0, {StatusCode::non_finite, "at t = 0"});
  EXPECT_THAT(show(scratch / "a.h5"), HasSubstr("0 frames of 2 particles"));
  EXPECT_THAT(show_json(scratch / "a.h5"), HasSubstr("\"time_end\": null"));
}

TEST(Show, AStudyWithoutCasesIsNoError) {
  const ScratchDirectory scratch;
  write_study(scratch / "a.h5", "", sample_study(0));
  EXPECT_THAT(show(scratch / "a.h5"), HasSubstr("no finished cases"));
}

TEST(Show, SaysWhyAFileCannotBeShown) {
  const ScratchDirectory scratch;
  write_trajectory(scratch / "a.h5", 20, 20);
  write_bytes(scratch / "truncated.h5", read_bytes(scratch / "a.h5").substr(0, 5000));
  write_bytes(scratch / "text.h5", "nothing");
  std::filesystem::create_directory(scratch / "directory");
  run_python(
      "import h5py, sys\nf = h5py.File(sys.argv[1], 'r+')\ndel f['trajectory/kinetic_energy']\ndel "
      "f.attrs['seal']\n",
      {(scratch / "a.h5").string()});
  const auto refuses = [&](const std::string& name, const char* reason) {
    EXPECT_THAT([&] { show(scratch / name); },
                ThrowsMessage<InputError>(
                    ::testing::AllOf(HasSubstr(name), HasSubstr(reason), Not(HasSubstr("\n")))));
    EXPECT_THROW(show_json(scratch / name), InputError);
  };
  refuses("a.h5", "kinetic_energy");
  refuses("truncated.h5", "truncated");
  refuses("text.h5", "not an HDF5 file");
  refuses("directory", "not a regular file");
  refuses("missing.h5", "No such file");
}

TEST(Show, TheColumnsThatAreNamed) {
  const ScratchDirectory scratch;
  write_study(scratch / "a.h5", "", sample_study(2));
  EXPECT_THAT(show(scratch / "a.h5", {"order", "method"}),
              HasSubstr("order  method\n-----  ------\n    4  rk0\n  nan  rk1\n"));
  EXPECT_THAT(([&] { show(scratch / "a.h5", {"methd"}); }),
              ThrowsMessage<InputError>(HasSubstr("did you mean \"method\"")));
  write_trajectory(scratch / "t.h5", 3, 4);
  EXPECT_THAT(([&] { show(scratch / "t.h5", {"time"}); }), ThrowsMessage<InputError>(HasSubstr("--csv")));
}

TEST(ShowTable, WritesCsvThatReadsBackInEveryDigit) {
  const ScratchDirectory scratch;
  study::StudyResult study = sample_study(2);
  study.cases[0].reason = "a, \"b\"\nc";
  for (study::SummaryCell& cell : study.cases[0].summary) {
    if (cell.name == "reason") cell.value = study.cases[0].reason;
    if (cell.name == "order") cell.value = 0.1 + 0.2;
  }
  write_study(scratch / "a.h5", "", study);
  EXPECT_EQ(show_table(scratch / "a.h5", {.format = TableFormat::csv,
                                          .of_case = "",
                                          .columns = {"method", "order", "seconds", "reason"}}),
            "method,order,seconds [s],reason\n"
            "rk0,0.30000000000000004,0.5,\"a, \"\"b\"\"\nc\"\n"
            "rk1,nan,0.5,Ordnung 1 ± 0.1\n");
}

TEST(ShowTable, WritesMarkdownAndLatexThatNeedNoMending) {
  const ScratchDirectory scratch;
  study::StudyResult study = sample_study(2);
  for (study::SummaryCell& cell : study.cases[0].summary) {
    if (cell.name == "method") cell.value = std::string("a|b_c 5%");
    if (cell.name == "order") cell.value = -1.23456789e-7;
  }
  write_study(scratch / "a.h5", "", study);
  EXPECT_EQ(show_table(scratch / "a.h5",
                       {.format = TableFormat::markdown, .of_case = "", .columns = {"method", "order"}}),
            "| method | order |\n|---|---:|\n| a\\|b_c 5% | -1.23457e-07 |\n| rk1 | nan |\n");
  EXPECT_EQ(
      show_table(scratch / "a.h5",
                 {.format = TableFormat::latex, .of_case = "", .columns = {"method", "order"}}),
      "\\begin{tabular}{lr}\n  \\toprule\n  method & order \\\\\n  \\midrule\n"
      "  a|b\\_c 5\\% & $-1.235 \\cdot 10^{-7}$ \\\\\n  rk1 & -- \\\\\n  \\bottomrule\n\\end{tabular}\n");
  EXPECT_THAT(show_table(scratch / "a.h5", {.format = TableFormat::latex, .of_case = "", .columns = {}}),
              Not(HasSubstr("reason")));
}

TEST(ShowTable, ShowsTheColumnsOfACaseAndTheFramesOfATrajectory) {
  const ScratchDirectory scratch;
  write_study(scratch / "a.h5", "", sample_study(2));
  const std::string of_case =
      show_table(scratch / "a.h5", {.format = TableFormat::csv, .of_case = "pendel-rk0", .columns = {}});
  EXPECT_THAT(of_case, HasSubstr("step [s]"));
  write_trajectory(scratch / "t.h5", 3, 4);
  const std::string frames =
      show_table(scratch / "t.h5",
                 {.format = TableFormat::csv, .of_case = "", .columns = {"time", "linear_momentum_y"}});
  EXPECT_EQ(frames, "time [s],linear_momentum_y [kg*m/s]\n0,5\n0.5,5\n1,5\n1.5,5\n");
}

TEST(ShowTable, NamesWhatIsThereWhereSomethingIsNot) {
  const ScratchDirectory scratch;
  write_study(scratch / "a.h5", "", sample_study(2));
  EXPECT_THAT(
      ([&] {
        show_table(scratch / "a.h5", {.format = TableFormat::csv, .of_case = "", .columns = {"ordr"}});
      }),
      ThrowsMessage<InputError>(::testing::AllOf(HasSubstr("a.h5"), HasSubstr("did you mean \"order\""))));
  EXPECT_THAT(([&] {
                show_table(scratch / "a.h5",
                           {.format = TableFormat::csv, .of_case = "pendel-rk7", .columns = {}});
              }),
              ThrowsMessage<InputError>(HasSubstr("found no case \"pendel-rk7\"")));
}

}  // namespace
}  // namespace fw::store::test
