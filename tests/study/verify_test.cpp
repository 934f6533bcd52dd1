#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "conformance/mutants.hpp"
#include "seeded_catalog.hpp"
#include "study_of_text.hpp"

namespace fw::study {
namespace {

using testing::HasSubstr;

std::string spec(const std::string& methods, const std::string& parts, const std::string& rest = "") {
  return "kind = \"verify\"\ntitle = \"t\"\nmethods = [" + methods + "]\n[verify]\nparts = [" + parts +
         "]\n" + rest;
}

/// The verdict on a property; "not checked" where there is none.
std::string verdict_on(const CaseResult& result, const std::string& property) {
  const auto& properties = column<std::string>(result, "property");
  const auto found = std::find(properties.begin(), properties.end(), property);
  if (found == properties.end()) return "not checked";
  return column<std::string>(result, "verdict")[static_cast<std::size_t>(found - properties.begin())];
}

TEST(VerifyStudy, StoresWhatIsClaimedDerivedAndMeasured) {
  const StudyResult study = run_study(
      spec("\"rk4\", \"velocity_verlet\"", "\"stability_function\", \"reversibility\""), SeededCatalog({}));
  ASSERT_EQ(study.cases.size(), 2u);
  for (const CaseResult& result : study.cases) {
    EXPECT_EQ(result.verdict, Verdict::holds) << result.reason;
    EXPECT_EQ(figure<std::int64_t>(result, "fail"), 0);
    EXPECT_EQ(figure<std::int64_t>(result, "hold") + figure<std::int64_t>(result, "not_applicable"),
              static_cast<std::int64_t>(column<std::string>(result, "property").size()));
  }
  EXPECT_EQ(column<std::string>(study.cases[0], "derived").front(), "1 + z + z^2/2 + z^3/6 + z^4/24");
  EXPECT_EQ(verdict_on(study.cases[1], "reversible in time"), "holds");
}

/// Five stages under a claim of eight, and the other way round: the options of a call reach its coefficients.
TEST(VerifyStudy, HoldsACallWithOptionsAgainstItsOwnCoefficients) {
  const std::string parts = "\"stability_function\", \"tableau\"";
  const StudyResult right = run_study(spec("\"rkc2[stages=5]\"", parts), SeededCatalog({}));
  EXPECT_EQ(verdict_on(right.cases.front(), "stability function"), "holds") << right.cases.front().reason;
  const SeededCatalog seeded({{"five", [] { return catalog::make_method("rkc2[stages=5]"); }}},
                             {{"five", "rkc2"}});
  const StudyResult wrong = run_study(spec("\"five\"", parts), seeded);
  EXPECT_EQ(verdict_on(wrong.cases.front(), "stability function"), "fails") << wrong.cases.front().reason;
  EXPECT_EQ(wrong.cases.front().verdict, Verdict::fails);
  EXPECT_THAT(figure<std::string>(wrong.cases.front(), "failing"), HasSubstr("stability function"));
}

/// A tangent that only springs have is not asked of equations without springs.
TEST(VerifyStudy, LeavesOutWhatTheMethodCannotRunOn) {
  const StudyResult study = run_study(
      spec("\"implicit_euler_linearised[tangent=psd_projection]\"",
           "\"polynomial_exactness\", \"stability_function\", \"stability_limits\", \"reversibility\""),
      SeededCatalog({}));
  const CaseResult& result = study.cases.front();
  EXPECT_NE(result.verdict, Verdict::fails) << result.reason;
  EXPECT_EQ(verdict_on(result, "L-stability"), "not applicable");
  EXPECT_THAT(column<std::string>(result, "reason"), testing::Contains(HasSubstr("does not run on")));
}

TEST(VerifyStudy, FailsASchemeThatThrowsAndGoesOnWithTheOtherParts) {
  const SeededCatalog seeded({{"thrower",
                               [] {
                                 return std::make_unique<conformance::ClaimingIntegrator>(
                                     catalog::make_method("rk4")->info(), ExtendedSolver{},
                                     [](const Ivp&, const StepControl&, Observer&) -> Solution {
                                       throw std::runtime_error("no memory for the stages");
                                     });
                               }}},
                             {{"thrower", "rk4"}});
  const CaseResult result =
      run_study(spec("\"thrower\"", "\"stability_function\", \"reversibility\""), seeded).cases.front();
  EXPECT_EQ(verdict_on(result, "stability_function"), "fails");
  EXPECT_EQ(verdict_on(result, "reversibility"), "fails");
  EXPECT_THAT(result.reason, HasSubstr("no memory for the stages"));
}

TEST(VerifyStudy, IsThinnedOutByQuick) {
  const std::string parts = "[verify]\nparts = [\"evaluation_count\"]\n[quick]\nmethods = 5\n";
  const StudyResult study = run_study("kind = \"verify\"\ntitle = \"t\"\n" + parts, SeededCatalog({}), true);
  EXPECT_EQ(study.cases.size(), 5u);
  EXPECT_EQ(study.cases.front().id, "explicit_euler");
}

TEST(VerifyStudy, RefusesUnknownParts) {
  EXPECT_THAT(
      refusal_of(spec("\"rk4\"", "\"orders\""), SeededCatalog({})),
      HasSubstr("parts[0]: found the string \"orders\", expected one of \"order\", \"error_estimate\""));
  EXPECT_THAT(refusal_of(spec("\"rk4\"", ""), SeededCatalog({})), HasSubstr("expected at least one entry"));
}

}  // namespace
}  // namespace fw::study
