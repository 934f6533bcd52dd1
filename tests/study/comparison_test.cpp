#include "study/comparison.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>

namespace fw::study {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

StudyResult sample() {
  StudyResult study;
  for (const char* id : {"a", "b"}) {
    CaseResult& result = study.cases.emplace_back();
    result.id = id;
    result.key = std::string("key of ") + id;
    result.verdict = Verdict::holds;
    result.reason = "1.0";
    result.columns = {
        {"error", "m", std::vector<double>{1.0, std::numeric_limits<double>::quiet_NaN(), 0.0}, {}, {}},
        {"count", "1", std::vector<std::int64_t>{3, 4}, {}, {}},
        {"solve_seconds", "s", std::vector<double>{0.5}, {}, {}}};
    result.summary = {{"method", "", std::string("rk4")}, {"order", "1", 4.0}, {"seconds", "s", 1.0}};
  }
  return study;
}

std::vector<std::string> after(const std::function<void(StudyResult&)>& change) {
  StudyResult changed = sample();
  change(changed);
  return compare(sample(), changed).differences;
}

TEST(Comparison, FindsNoDifferenceInEqualResultsOfDifferentSpeed) {
  StudyResult again = sample();
  std::get<0>(again.cases[0].columns[2].values)[0] = 9.0;
  again.cases[1].summary[2].value = 7.0;
  again.cases[1].reason = "another";
  const Comparison comparison = compare(sample(), again);
  EXPECT_THAT(comparison.differences, ElementsAre());
  EXPECT_EQ(comparison.cases, 2u);
  EXPECT_EQ(comparison.columns, 8u);
}

TEST(Comparison, SeesTheLastBitTheSignOfZeroAndEveryOtherChange) {
  EXPECT_THAT(
      after([](StudyResult& s) { std::get<0>(s.cases[0].columns[0].values)[0] = std::nextafter(1.0, 2.0); }),
      ElementsAre("a: error: 1 of 3 values differ, by at most 2.22e-16 of the larger"));
  EXPECT_THAT(after([](StudyResult& s) { std::get<0>(s.cases[0].columns[0].values)[2] = -0.0; }),
              ElementsAre(HasSubstr("a: error")));
  EXPECT_THAT(after([](StudyResult& s) { std::get<0>(s.cases[1].columns[0].values)[1] = 1.0; }),
              ElementsAre("b: error: 1 of 3 values differ, by at most inf of the larger"));
  EXPECT_THAT(after([](StudyResult& s) { std::get<1>(s.cases[1].columns[1].values).push_back(1); }),
              ElementsAre("b: count: 2 values before, 3 now"));
  EXPECT_THAT(after([](StudyResult& s) {
                s.cases[1].columns[1].values = std::vector<double>{3.0, 4.0};
              }),
              ElementsAre("b: count: has another type now"));
  EXPECT_THAT(after([](StudyResult& s) { s.cases[0].columns.erase(s.cases[0].columns.begin()); }),
              ElementsAre("a: error: is missing now"));
  EXPECT_THAT(after([](StudyResult& s) {
                s.cases[0].columns.push_back({"new", "1", std::vector<double>{}, {}, {}});
              }),
              ElementsAre("a: new: was not there before"));
  EXPECT_THAT(after([](StudyResult& s) { s.cases[0].verdict = Verdict::fails; }),
              ElementsAre("a: verdict: holds before, fails now"));
  EXPECT_THAT(after([](StudyResult& s) { s.cases[0].summary[1].value = 3.0; }),
              ElementsAre(HasSubstr("a: summary/order: 1 of 1 values differ")));
  EXPECT_THAT(after([](StudyResult& s) { s.cases[0].summary[0].value = std::string("rk5"); }),
              ElementsAre("a: summary/method: 1 of 1 values differ"));
  EXPECT_THAT(after([](StudyResult& s) { s.cases.pop_back(); }), ElementsAre("b: case: is missing now"));
  EXPECT_THAT(after([](StudyResult& s) { s.cases.push_back(s.cases[0]), s.cases.back().id = "c"; }),
              ElementsAre("c: case: was not there before"));
}

TEST(Comparison, SeesUnitsShapesAndAttributesAndCasesThatCouldNotBeComputed) {
  EXPECT_THAT(after([](StudyResult& s) { s.cases[0].columns[0].unit = "s"; }),
              ElementsAre(HasSubstr("a: error: has another unit")));
  EXPECT_THAT(after([](StudyResult& s) {
                s.cases[0].columns[1].shape = {2, 1};
              }),
              ElementsAre(HasSubstr("a: count: has another")));
  EXPECT_THAT(after([](StudyResult& s) {
                s.cases[0].columns[1].attributes = {{"norm", "x"}};
              }),
              ElementsAre(HasSubstr("a: count: has another")));
  EXPECT_THAT(after([](StudyResult& s) { s.cases[1].key.clear(); }),
              ElementsAre("b: case: could not be computed now"));
}

TEST(Comparison, OfAnIncompleteResultAllowsForTheCasesThatWereMissing) {
  StudyResult before = sample();
  before.cases.pop_back();
  before.complete = false;
  EXPECT_THAT(compare(before, sample()).differences, ElementsAre());
}

}  // namespace
}  // namespace fw::study
