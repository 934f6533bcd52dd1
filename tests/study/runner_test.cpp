#include "study/runner.hpp"

#include <gtest/gtest.h>

#include <sched.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <limits>
#include <new>
#include <stdexcept>

#include "core/error.hpp"
#include "memory_archive.hpp"
#include "ode/not_applicable.hpp"
#include "study/case_message.hpp"

namespace fw::study {
namespace {

/// A counter that all processes of the test share.
class SharedCounter {
 public:
  SharedCounter()
      : memory_(::mmap(nullptr, sizeof(std::atomic<int>), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS,
                       -1, 0)),
        value_(*new (memory_) std::atomic<int>(0)) {}
  ~SharedCounter() { ::munmap(memory_, sizeof(std::atomic<int>)); }
  SharedCounter(const SharedCounter&) = delete;
  SharedCounter& operator=(const SharedCounter&) = delete;
  std::atomic<int>& operator*() const { return value_; }

 private:
  void* memory_;
  std::atomic<int>& value_;
};

PlannedCase simple_case(const std::string& id, std::function<void()> action = {}) {
  return {
      .id = id, .identity = "identity of " + id, .run = [id, action](const RunContext&) {
        if (action) action();
        CaseResult result;
        result.verdict = Verdict::holds;
        result.reason = "ran";
        result.summary = {{"value", "1", static_cast<double>(id.size())}, {"count", "1", std::int64_t{3}}};
        return result;
      }};
}

Plan three_cases(std::function<void()> action = {}) {
  return {.kind = "test",
          .title = "three",
          .spec = "",
          .seed = 0,
          .summary = {{"value", "1", CellType::number, ""}, {"count", "1", CellType::integer, ""}},
          .cases = {simple_case("a"), simple_case("bb", std::move(action)), simple_case("ccc")}};
}

TEST(RunPlan, KeepsFinishedCasesAndDoesNotRunThemAgain) {
  MemoryArchive archive;
  const SharedCounter runs;
  const Plan plan = three_cases([&] { ++*runs; });
  run_plan(plan, archive, {});
  EXPECT_EQ(archive.size(), 3u);
  std::size_t kept = 0;
  RunOptions options;
  options.finished = [&](const CaseReport& report) { kept += report.kept; };
  const StudyResult again = run_plan(plan, archive, options);
  EXPECT_EQ(*runs, 1);
  EXPECT_EQ(kept, 3u);
  EXPECT_EQ(again.cases[1].id, "bb");
  options.force = true;
  run_plan(plan, archive, options);
  EXPECT_EQ(*runs, 2);
}

TEST(RunPlan, RunsACaseAgainForAnotherProgram) {
  MemoryArchive archive;
  const SharedCounter runs;
  const Plan plan = three_cases([&] { ++*runs; });
  RunOptions options;
  options.program = "one";
  run_plan(plan, archive, options);
  options.program = "two";
  run_plan(plan, archive, options);
  EXPECT_EQ(*runs, 2);
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
  EXPECT_TRUE(std::isnan(std::get<double>(result.cases[1].summary[0].value)));
  EXPECT_EQ(std::get<std::int64_t>(result.cases[1].summary[1].value), missing_integer);
  EXPECT_EQ(archive.size(), 2u);  // the failed one is tried again next time
}

TEST(RunPlan, NamesWhatIsKnownInTheRowOfACaseThatCouldNotBeComputed) {
  MemoryArchive archive;
  Plan plan = three_cases([] { throw std::runtime_error("broken on purpose"); });
  plan.cases[1].known = {{"count", std::int64_t{7}}};
  const StudyResult result = run_plan(plan, archive, {});
  EXPECT_TRUE(std::isnan(std::get<double>(result.cases[1].summary[0].value)));
  EXPECT_EQ(std::get<std::int64_t>(result.cases[1].summary[1].value), 7);
}

TEST(RunPlan, IsNotApplicableWhereTheSystemLacksWhatTheMethodNeeds) {
  MemoryArchive archive;
  Plan plan = three_cases([] { throw NotApplicable("the method needs springs"); });
  plan.cases[1].known = {{"count", std::int64_t{7}}};
  RunOptions options;
  std::vector<bool> computed;
  options.finished = [&](const CaseReport& report) { computed.push_back(report.computed); };
  const StudyResult result = run_plan(plan, archive, options);
  EXPECT_TRUE(result.complete);
  EXPECT_EQ(result.cases[1].verdict, Verdict::not_applicable);
  EXPECT_EQ(result.cases[1].reason, "the method needs springs");
  EXPECT_EQ(std::get<std::int64_t>(result.cases[1].summary[1].value), 7);
  EXPECT_EQ(computed, std::vector<bool>({true, true, true})) << "no failure of the program";
}

TEST(RunPlan, FailsACaseWhoseRowIsNotTheDeclaredOneWhenItReturns) {
  MemoryArchive archive;
  Plan plan = three_cases();
  const auto with_row = [](std::vector<SummaryCell> row) {
    return [row](const RunContext&) {
      CaseResult result;
      result.verdict = Verdict::holds;
      result.summary = row;
      return result;
    };
  };
  plan.cases[0].run = with_row({{"value", "1", 1.0}});
  plan.cases[1].run = with_row({{"value", "s", 1.0}, {"count", "1", std::int64_t{3}}});
  plan.cases[2].run = with_row({{"value", "1", 1.0}, {"count", "1", 3.0}});
  const StudyResult result = run_plan(plan, archive, {});
  EXPECT_EQ(archive.size(), 0u);
  const std::string head = "its row of the summary is not the one of its kind: ";
  EXPECT_EQ(result.cases[0].reason, head + "found 1 cells, expected 2");
  EXPECT_EQ(result.cases[1].reason, head + "cell 0 is \"value\" [s], expected \"value\" [1]");
  EXPECT_EQ(result.cases[2].reason, head + "cell 1, \"count\", has another type than the kind declares");
  for (const CaseResult& one : result.cases) EXPECT_EQ(row_mismatch(plan.summary, one.summary), "");
}

TEST(RunPlan, StopsAtAnInterruptAndSaysThatItIsIncomplete) {
  MemoryArchive archive;
  std::atomic<bool> interrupted{false};
  RunOptions options;
  options.context.stop = StopToken(interrupted);
  options.waiting = [&](const RunProgress& progress) { interrupted = progress.done == 1; };
  Plan plan = three_cases();
  plan.cases[1].run = [](const RunContext& context) -> CaseResult {
    while (true) {
      ::usleep(1000);
      context.check();
    }
  };
  const StudyResult result = run_plan(plan, archive, options);
  EXPECT_FALSE(result.complete);
  EXPECT_EQ(result.cases.size(), 1u);
  EXPECT_EQ(archive.size(), 1u);
}

TEST(RunPlan, EndsACaseThatDoesNotReactToAnInterrupt) {
  MemoryArchive archive;
  std::atomic<bool> interrupted{false};
  RunOptions options;
  options.patience = 0.1;
  options.context.stop = StopToken(interrupted);
  options.waiting = [&](const RunProgress& progress) { interrupted = progress.done == 1; };
  const StudyResult result = run_plan(three_cases([] {
                                        while (true) ::pause();
                                      }),
                                      archive, options);
  EXPECT_FALSE(result.complete);
  EXPECT_EQ(result.cases.size(), 1u);
}

TEST(RunPlan, SurvivesACaseThatCrashes) {
  MemoryArchive archive;
  std::size_t not_computed = 0;
  RunOptions options;
  options.finished = [&](const CaseReport& report) { not_computed += !report.computed; };
  const StudyResult result = run_plan(three_cases([] {
                                        std::signal(SIGABRT, SIG_DFL);
                                        std::abort();
                                      }),
                                      archive, options);
  ASSERT_EQ(result.cases.size(), 3u);
  EXPECT_EQ(not_computed, 1u);
  EXPECT_EQ(result.cases[1].verdict, Verdict::fails);
  EXPECT_EQ(result.cases[1].reason, "the process of this case ended by signal 6 (Aborted)");
  EXPECT_EQ(result.cases[1].key, "");
  EXPECT_EQ(result.cases[2].verdict, Verdict::holds);
  EXPECT_EQ(archive.size(), 2u);
}

TEST(RunPlan, SurvivesACaseThatExits) {
  MemoryArchive archive;
  const StudyResult result = run_plan(three_cases([] { ::_exit(5); }), archive, {});
  EXPECT_EQ(result.cases.at(1).reason, "the process of this case ended with exit code 5");
  EXPECT_EQ(result.cases.at(2).verdict, Verdict::holds);
}

TEST(RunPlan, EndsACaseAtItsTimeLimitAndGoesOn) {
  MemoryArchive archive;
  Plan plan = three_cases([] { ::pause(); });
  plan.time_limit = 0.2;
  const StudyResult result = run_plan(plan, archive, {});
  EXPECT_EQ(result.cases.at(1).verdict, Verdict::fails);
  EXPECT_EQ(result.cases.at(1).reason, "ran past its time limit of 0.2 s");
  EXPECT_EQ(result.cases.at(2).verdict, Verdict::holds);
  RunOptions options;
  options.time_limit = 0.1;  // goes before the plan's
  EXPECT_EQ(run_plan(plan, archive, options).cases.at(1).reason, "ran past its time limit of 0.1 s");
}

TEST(RunPlan, RunsTimedCasesLastAloneAndOnOneProcessor) {
  const SharedCounter running, most, timed_beside_others, processors;
  Plan plan{.kind = "test", .title = "timed", .spec = "", .seed = 0, .cases = {}};
  for (int i = 0; i < 8; ++i) {
    const bool is_timed = i < 4;
    PlannedCase planned = simple_case("case" + std::to_string(i), [&, is_timed] {
      const int now = ++*running;
      int before = *most;
      while (now > before && !(*most).compare_exchange_weak(before, now)) {
      }
      // All four that may run together do so at some time, however slow the machine.
      for (int k = 0; !is_timed && *most < 4 && k < 30'000; ++k) ::usleep(1000);
      if (is_timed) ::usleep(30'000);
      if (is_timed) {
        *timed_beside_others += *running > 1;
        cpu_set_t mask;
        ::sched_getaffinity(0, sizeof mask, &mask);
        *processors += CPU_COUNT(&mask);
      }
      --*running;
    });
    planned.is_timed = is_timed;
    plan.cases.push_back(planned);
  }
  MemoryArchive archive;
  RunOptions options;
  options.jobs = 4;
  const StudyResult result = run_plan(plan, archive, options);
  EXPECT_EQ(*most, 4);
  EXPECT_EQ(*timed_beside_others, 0);
  EXPECT_EQ(*processors, 4);  // one for each
  EXPECT_EQ(result.cases.front().id, "case0");
}

TEST(RunPlan, BringsEveryKindOfColumnOverFromTheWorkerUnchanged) {
  CaseResult sent;
  sent.columns = {{"x",
                   "m",
                   std::vector<double>{0.1, -0.0, std::numeric_limits<double>::quiet_NaN(), 1e308},
                   {2, 2},
                   {{"norm", "ü"}}},
                  {"n", "1", std::vector<std::int64_t>{-1, 1LL << 62}, {}, {}},
                  {"t", "", std::vector<std::string>{"", "a", std::string(100'000, 'x')}, {}, {}}};
  sent.summary = {{"a", "s", 0.25}, {"b", "1", std::int64_t{7}}, {"c", "", std::string("text")}};
  sent.verdict = Verdict::not_applicable;
  sent.reason = "why";
  Plan plan{.kind = "test",
            .title = "columns",
            .spec = "",
            .seed = 0,
            .summary = {{"a", "s", CellType::number, ""},
                        {"b", "1", CellType::integer, ""},
                        {"c", "", CellType::text, ""}},
            .cases = {}};
  plan.cases.push_back({.id = "one", .identity = "", .run = [&](const RunContext&) { return sent; }});
  MemoryArchive archive;
  const CaseResult got = run_plan(plan, archive, {}).cases.at(0);
  const auto bytes = [](CaseResult result) {
    result.id.clear();
    result.key.clear();
    return encode(result);
  };
  EXPECT_EQ(bytes(got), bytes(sent));
  ASSERT_EQ(got.columns.size(), 3u);
  EXPECT_EQ(std::get<2>(got.columns[2].values)[2].size(), 100'000u);
  EXPECT_EQ(std::get<1>(got.columns[1].values)[1], 1LL << 62);
  EXPECT_EQ(got.columns[0].attributes[0].second, "ü");
  EXPECT_TRUE(std::signbit(std::get<0>(got.columns[0].values)[1]));
}

TEST(CaseMessage, RefusesBytesThatAreNone) {
  const std::string whole = encode({.id = "a",
                                    .key = "b",
                                    .columns = {},
                                    .summary = {{"c", "s", 1.0}},
                                    .verdict = Verdict::holds,
                                    .reason = "d"});
  EXPECT_EQ(decode(whole).reason, "d");
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_THROW(decode(std::string_view(whole).substr(0, size)), std::runtime_error) << size;
  }
  EXPECT_THROW(decode(whole + "x"), std::runtime_error);
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
