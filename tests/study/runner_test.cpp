#include "study/runner.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "core/error.hpp"
#include "memory_archive.hpp"

namespace fw::study {
namespace {

PlannedCase simple_case(const std::string& id, std::function<void()> action = {}) {
  return {.id = id, .identity = "identity of " + id, .run = [id, action](const RunContext&) {
            if (action) action();
            CaseResult result;
            result.verdict = Verdict::holds;
            result.reason = "ran";
            result.summary = {{"value", "1", static_cast<double>(id.size())},
                              {"verdict", "", std::string("holds")},
                              {"reason", "", std::string("ran")}};
            return result;
          }};
}

Plan three_cases(std::function<void()> action = {}) {
  return {.kind = "test",
          .title = "three",
          .spec = "",
          .seed = 0,
          .cases = {simple_case("a"), simple_case("bb", std::move(action)), simple_case("ccc")}};
}

TEST(RunPlan, KeepsFinishedCasesAndDoesNotRunThemAgain) {
  MemoryArchive archive;
  int runs = 0;
  const Plan plan = three_cases([&] { ++runs; });
  run_plan(plan, archive, {});
  EXPECT_EQ(archive.size(), 3u);
  std::size_t kept = 0;
  RunOptions options;
  options.finished = [&](const CaseReport& report) { kept += report.kept; };
  const StudyResult again = run_plan(plan, archive, options);
  EXPECT_EQ(runs, 1);
  EXPECT_EQ(kept, 3u);
  EXPECT_EQ(again.cases[1].id, "bb");
  options.force = true;
  run_plan(plan, archive, options);
  EXPECT_EQ(runs, 2);
}

TEST(RunPlan, RunsACaseAgainForAnotherProgram) {
  MemoryArchive archive;
  int runs = 0;
  const Plan plan = three_cases([&] { ++runs; });
  RunOptions options;
  options.program = "one";
  run_plan(plan, archive, options);
  options.program = "two";
  run_plan(plan, archive, options);
  EXPECT_EQ(runs, 2);
}

TEST(RunPlan, TurnsAnExceptionIntoAFailedCaseAndGoesOn) {
  MemoryArchive archive;
  const StudyResult result =
      run_plan(three_cases([] { throw std::runtime_error("broken on purpose"); }), archive, {});
  ASSERT_EQ(result.cases.size(), 3u);
  EXPECT_TRUE(result.complete);
  EXPECT_EQ(result.cases[1].verdict, Verdict::fails);
  EXPECT_EQ(result.cases[1].reason, "broken on purpose");
  ASSERT_EQ(result.cases[1].summary.size(), result.cases[0].summary.size());
  EXPECT_EQ(std::get<std::string>(result.cases[1].summary[2].value), "broken on purpose");
  EXPECT_EQ(archive.size(), 2u);  // the failed one is tried again next time
}

TEST(RunPlan, StopsAtAnInterruptAndSaysThatItIsIncomplete) {
  MemoryArchive archive;
  std::atomic<bool> interrupted{false};
  RunOptions options;
  options.context.interrupted = &interrupted;
  const StudyResult result = run_plan(three_cases([&] {
                                        interrupted = true;
                                        throw Interrupted{};
                                      }),
                                      archive, options);
  EXPECT_FALSE(result.complete);
  EXPECT_EQ(result.cases.size(), 1u);
  EXPECT_EQ(archive.size(), 1u);
}

TEST(RunPlan, GivesTheSameResultForAnyNumberOfJobs) {
  MemoryArchive one_archive, four_archive;
  Plan plan = three_cases();
  for (int i = 0; i < 40; ++i)
    plan.cases.push_back(simple_case("case" + std::string(static_cast<std::size_t>(i), 'x')));
  RunOptions options;
  const StudyResult one = run_plan(plan, one_archive, options);
  options.jobs = 4;
  const StudyResult four = run_plan(plan, four_archive, options);
  ASSERT_EQ(one.cases.size(), four.cases.size());
  for (std::size_t i = 0; i < one.cases.size(); ++i) {
    EXPECT_EQ(one.cases[i].id, four.cases[i].id);
    EXPECT_EQ(one.cases[i].key, four.cases[i].key);
  }
}

TEST(RunPlan, PassesAFailureOfTheArchiveOn) {
  class FullDisk final : public CaseArchive {
   public:
    std::optional<CaseResult> find(const std::string&) override { return std::nullopt; }
    void keep(const CaseResult&) override { throw SystemError("disk full"); }
  } archive;
  RunOptions options;
  for (int jobs : {1, 3}) {
    options.jobs = jobs;
    EXPECT_THROW(run_plan(three_cases(), archive, options), SystemError);
  }
}

}  // namespace
}  // namespace fw::study
