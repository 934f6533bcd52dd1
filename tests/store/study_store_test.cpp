#include "store/study_store.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <thread>

#include "core/error.hpp"
#include "same_result.hpp"
#include "samples.hpp"
#include "scratch_directory.hpp"
#include "store/show_table.hpp"
#include "store/study_file.hpp"

namespace fw::store::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(StudyFile, ComesBackInEveryBit) {
  const ScratchDirectory scratch;
  const study::StudyResult study = sample_study(12);
  write_study(scratch / "a.h5", "federwerk run a.toml", study);
  const StudyFile back = read_study(scratch / "a.h5");
  EXPECT_EQ(back.result.kind, study.kind);
  EXPECT_EQ(back.result.title, study.title);
  EXPECT_EQ(back.result.spec, study.spec);
  EXPECT_EQ(back.result.seed, study.seed);
  EXPECT_TRUE(back.result.complete);
  EXPECT_EQ(text_of(back.attributes, "command_line"), "federwerk run a.toml");
  ASSERT_EQ(back.result.cases.size(), study.cases.size());
  for (std::size_t i = 0; i < study.cases.size(); ++i)
    EXPECT_TRUE(same(back.result.cases[i], study.cases[i]));
}

TEST(StudyFile, TheComparisonOfTheseTestsSeesEveryChange) {
  const study::CaseResult a = sample_case(1);
  EXPECT_TRUE(same(a, a));
  study::CaseResult b = a;
  std::get<std::vector<double>>(b.columns[0].values)[2] = 0.0;  // was NaN
  EXPECT_FALSE(same(a, b));
  b = a;
  b.columns[1].shape = {3, 2};
  EXPECT_FALSE(same(a, b));
  b = a;
  b.columns[1].attributes[0].second = "other";
  EXPECT_FALSE(same(a, b));
  b = a;
  b.summary[1].value = 1.0;  // was NaN
  EXPECT_FALSE(same(a, b));
  b = a;
  b.columns[3].values = std::vector<std::string>{"Überschwinger", "", "ss"};
  EXPECT_FALSE(same(a, b));
}

TEST(StudyFile, AnEmptyStudyIsAValidFile) {
  const ScratchDirectory scratch;
  study::StudyResult study = sample_study(0);
  study.complete = false;
  write_study(scratch / "a.h5", "", study);
  EXPECT_TRUE(read_study(scratch / "a.h5").result.cases.empty());
  EXPECT_FALSE(read_study(scratch / "a.h5").result.complete);
}

TEST(StudyFile, MarksIntegersThatACaseDoesNotHaveAndKeepsParametersApart) {
  const ScratchDirectory scratch;
  study::StudyResult study = sample_study(3);
  study.cases[1].summary[2].value = study::missing_integer;
  for (study::CaseResult& result : study.cases) result.parameters = {{"parameter_k", "N/m", 4.0}};
  write_study(scratch / "a.h5", "", study);
  const auto cases = read_study(scratch / "a.h5").result.cases;
  ASSERT_EQ(cases.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_TRUE(same(cases[i], study.cases[i]));
  EXPECT_EQ(cases[1].parameters.at(0).name, "parameter_k");
  EXPECT_THAT(show_table(scratch / "a.h5", {.format = TableFormat::csv, .of_case = "", .columns = {}}),
              HasSubstr("pendel-rk1,4,rk1,nan,,0.5,fails,"));
}

TEST(StudyFile, RefusesResultsThatContradictThemselvesAndWritesNothing) {
  const ScratchDirectory scratch;
  const auto refuses = [&](const study::StudyResult& study, const char* part) {
    EXPECT_THAT([&] { write_study(scratch / "a.h5", "", study); },
                ThrowsMessage<InputError>(HasSubstr(part)));
    EXPECT_TRUE(scratch.names().empty());
  };
  study::StudyResult study = sample_study(3);
  study.cases[2].id = study.cases[0].id;
  refuses(study, "twice");
  study = sample_study(3);
  study.cases[1].id = "a/b";
  refuses(study, "a/b");
  study = sample_study(3);
  study.cases[1].columns[1].shape = {2, 4};
  refuses(study, "\"error\" has 6 values, but its shape holds 8");
  study = sample_study(3);
  study.cases[2].summary[1].value = std::int64_t{4};
  refuses(study, "order");
  study = sample_study(3);
  study.cases[2].summary.erase(study.cases[2].summary.begin());
  refuses(study, "pendel-rk2");
  study = sample_study(3);
  study.cases[0].summary[0].name = "case";
  refuses(study, "written from the case itself");
}

TEST(StudyFile, ASpecOfMoreThan64KiBFits) {
  const ScratchDirectory scratch;
  study::StudyResult study = sample_study(1);
  study.spec.assign(300000, 'x');
  write_study(scratch / "a.h5", "", study);
  EXPECT_EQ(read_study(scratch / "a.h5").result.spec, study.spec);
}

TEST(StudyFile, AnyChangedByteIsNoticed) {
  const ScratchDirectory scratch;
  write_study(scratch / "a.h5", "", sample_study(2));
  const std::string whole = read_bytes(scratch / "a.h5");
  std::mt19937_64 random(20260131);
  for (int i = 0; i < 300; ++i) {
    std::string bytes = whole;
    const std::size_t at = random() % bytes.size();
    bytes[at] = static_cast<char>(bytes[at] ^ static_cast<char>(1 + random() % 255));
    write_bytes(scratch / "b.h5", bytes);
    EXPECT_THROW(read_study(scratch / "b.h5"), InputError) << "byte " << at;
  }
}

TEST(StudyFile, AnyTruncationIsNoticed) {
  const ScratchDirectory scratch;
  write_study(scratch / "a.h5", "", sample_study(2));
  const std::string whole = read_bytes(scratch / "a.h5");
  for (std::size_t size = 0; size + 83 < whole.size(); size += 97) {
    write_bytes(scratch / "b.h5", whole.substr(0, size));
    EXPECT_THROW(read_study(scratch / "b.h5"), InputError) << size << " bytes";
  }
  for (std::size_t cut = 1; cut <= 90; ++cut) {
    write_bytes(scratch / "b.h5", whole.substr(0, whole.size() - cut));
    EXPECT_THROW(read_study(scratch / "b.h5"), InputError) << cut << " bytes less";
  }
  write_bytes(scratch / "b.h5", whole + "x");
  EXPECT_THROW(read_study(scratch / "b.h5"), InputError);
}

TEST(StudyStore, FindsWhatItKept) {
  const ScratchDirectory scratch;
  StudyStore store(scratch / "a.h5");
  EXPECT_FALSE(store.find(sample_case(3).key));
  store.keep(sample_case(3));
  store.keep(sample_case(4));
  ASSERT_TRUE(store.find(sample_case(3).key));
  EXPECT_TRUE(same(*store.find(sample_case(3).key), sample_case(3)));
  EXPECT_TRUE(same(*store.find(sample_case(4).key), sample_case(4)));
  EXPECT_FALSE(store.find(sample_case(5).key));
  EXPECT_EQ(store.case_directory(), scratch / ".a.cases");
  EXPECT_TRUE(std::filesystem::exists(scratch / ".a.cases" / (sample_case(3).key + ".h5")));
}

TEST(StudyStore, ACompleteStudyReplacesTheKeptCasesByOneFile) {
  const ScratchDirectory scratch;
  {
    StudyStore store(scratch / "a.h5");
    for (int i = 0; i < 3; ++i) store.keep(sample_case(i));
    store.write("federwerk run", sample_study(3));
    EXPECT_THAT(scratch.names(), ElementsAre("a.h5"));
  }
  StudyStore again(scratch / "a.h5");
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(again.find(sample_case(i).key));
    EXPECT_TRUE(same(*again.find(sample_case(i).key), sample_case(i)));
  }
}

TEST(StudyStore, LeavesNothingBehindIfNothingWasKept) {
  const ScratchDirectory scratch;
  { StudyStore store(scratch / "a.h5"); }
  EXPECT_TRUE(scratch.names().empty());
}

TEST(StudyStore, AnInterruptedStudyKeepsItsCases) {
  const ScratchDirectory scratch;
  {
    StudyStore store(scratch / "a.h5");
    store.keep(sample_case(0));
    study::StudyResult study = sample_study(1);
    study.complete = false;
    store.write("", study);
  }
  EXPECT_THAT(scratch.names(), ElementsAre(".a.cases", "a.h5"));
  EXPECT_EQ(text_of(read_study(scratch / "a.h5").attributes, "status"), "incomplete");
  std::filesystem::remove(scratch / "a.h5");
  StudyStore store(scratch / "a.h5");
  EXPECT_TRUE(store.find(sample_case(0).key));
}

TEST(StudyStore, AnInterruptedSecondRunLosesNoCaseOfTheFirst) {
  const ScratchDirectory scratch;
  write_study(scratch / "a.h5", "", sample_study(5));
  {
    StudyStore store(scratch / "a.h5");
    study::StudyResult study = sample_study(0);
    study.cases = {sample_case(0), sample_case(8)};
    study.complete = false;
    store.keep(sample_case(8));
    store.write("", study);
  }
  StudyStore store(scratch / "a.h5");
  for (const int i : {0, 1, 2, 3, 4, 8}) {
    ASSERT_TRUE(store.find(sample_case(i).key)) << i;
    EXPECT_TRUE(same(*store.find(sample_case(i).key), sample_case(i)));
  }
}

TEST(StudyStore, ForgetsOnRequest) {
  const ScratchDirectory scratch;
  write_study(scratch / "a.h5", "", sample_study(2));
  { StudyStore(scratch / "a.h5").keep(sample_case(5)); }
  StudyStore store(scratch / "a.h5", StudyStore::Earlier::forget);
  for (const int i : {0, 1, 5}) EXPECT_FALSE(store.find(sample_case(i).key));
  EXPECT_EQ(read_study(scratch / "a.h5").result.cases.size(), 2U)
      << "the old result stays until there is a new one";
}

TEST(StudyStore, IgnoresDamagedCasesAndReplacesThem) {
  const ScratchDirectory scratch;
  const study::CaseResult kept = sample_case(1);
  StudyStore store(scratch / "a.h5");
  store.keep(kept);
  const auto file = scratch / ".a.cases" / (kept.key + ".h5");
  const std::string whole = read_bytes(file);
  std::vector<std::string> damaged{"", "rubbish", whole.substr(0, whole.size() / 2),
                                   whole.substr(0, whole.size() - 1), whole + "x"};
  std::mt19937_64 random(7);
  for (int i = 0; i < 200; ++i) {
    std::string bytes = whole;
    bytes[random() % bytes.size()] ^= static_cast<char>(1U << (random() % 8));
    damaged.push_back(bytes);
  }
  for (const std::string& bytes : damaged) {
    write_bytes(file, bytes);
    EXPECT_FALSE(store.find(kept.key)) << bytes.size() << " bytes";
  }
  store.keep(kept);
  EXPECT_TRUE(same(store.find(kept.key).value(), kept));
}

TEST(StudyStore, ACaseUnderTheNameOfAnotherIsNotFound) {
  const ScratchDirectory scratch;
  StudyStore store(scratch / "a.h5");
  store.keep(sample_case(1));
  std::filesystem::rename(scratch / ".a.cases" / (sample_case(1).key + ".h5"),
                          scratch / ".a.cases" / (sample_case(2).key + ".h5"));
  EXPECT_FALSE(store.find(sample_case(2).key));
}

TEST(StudyStore, RefusesKeysThatAreNoFileNames) {
  const ScratchDirectory scratch;
  StudyStore store(scratch / "a.h5");
  study::CaseResult result = sample_case(1);
  for (const char* key : {"", "../a", "a/b", "."}) {
    result.key = key;
    EXPECT_THROW(store.keep(result), InputError);
    EXPECT_THROW(store.find(key), InputError);
  }
}

TEST(StudyStore, ASecondRunOfTheSameStudyIsRefused) {
  const ScratchDirectory scratch;
  StudyStore store(scratch / "a.h5");
  EXPECT_THAT([&] { StudyStore second(scratch / "a.h5"); },
              ThrowsMessage<InputError>(HasSubstr("another run")));
  StudyStore other(scratch / "b.h5");
}

TEST(StudyStore, KeepsCasesFromSeveralThreads) {
  const ScratchDirectory scratch;
  StudyStore store(scratch / "a.h5");
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&store, t] {
      for (int i = t; i < 40; i += 4) store.keep(sample_case(i));
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (int i = 0; i < 40; ++i) EXPECT_TRUE(same(store.find(sample_case(i).key).value(), sample_case(i)));
}

TEST(StudyStore, KillingTheProcessAtAnyMomentLosesNoFinishedCase) {
  const ScratchDirectory scratch;
  std::mt19937_64 random(11);
  for (int round = 0; round < 12; ++round) {
    const auto output = scratch / ("study" + std::to_string(round) + ".h5");
    int pipe_ends[2];
    ASSERT_EQ(::pipe(pipe_ends), 0);
    const pid_t child = ::fork();
    if (child == 0) {
      StudyStore store(output);
      for (int i = 0; i < 400; ++i) {
        store.keep(sample_case(i));
        if (::write(pipe_ends[1], &i, sizeof i) != sizeof i) ::_exit(1);
        if (i % 3 == 2)
          store.write("", [&] {
            study::StudyResult part = sample_study(i + 1);
            part.complete = false;
            return part;
          }());
      }
      ::_exit(0);
    }
    ::close(pipe_ends[1]);
    // Somewhere between the reports of cases `round` and about `round + 2`.
    int finished = 0;
    const auto next = [&] {
      int i = 0;
      if (::read(pipe_ends[0], &i, sizeof i) != sizeof i) return false;
      finished = i + 1;
      return true;
    };
    while (finished < round && next()) {
    }
    ::usleep(static_cast<useconds_t>(random() % 20000));
    ::kill(child, SIGKILL);
    int status = 0;
    ::waitpid(child, &status, 0);
    while (next()) {
    }
    EXPECT_TRUE(WIFSIGNALED(status));
    EXPECT_GE(finished, round);
    ::close(pipe_ends[0]);
    StudyStore store(output);
    for (int i = 0; i < finished; ++i) {
      const auto found = store.find(sample_case(i).key);
      ASSERT_TRUE(found) << "round " << round << ", case " << i << " of " << finished;
      EXPECT_TRUE(same(*found, sample_case(i)));
    }
    store.write("", sample_study(1));
    EXPECT_FALSE(std::filesystem::exists(store.case_directory())) << "temporary files are removed as well";
  }
}

}  // namespace
}  // namespace fw::store::test
