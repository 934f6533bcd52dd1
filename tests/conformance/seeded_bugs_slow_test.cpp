#include "conformance/seeded_bugs.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "analysis/verification/verification.hpp"

namespace fw::conformance {
namespace {

using analysis::Finding;
using analysis::PropertyCheck;
using analysis::SchemeUnderTest;
using Part = void (*)(const SchemeUnderTest&, std::vector<PropertyCheck>&);

/// Which part of the verification reports a property.
Part part_of(const std::string& property) {
  static const std::map<std::string, Part> parts{
      {"order, forces f(t, q)", analysis::verify_order},
      {"order, forces f(t, q, v)", analysis::verify_order},
      {"order, y' = f(t, y)", analysis::verify_order},
      {"double and binary128 agree", analysis::verify_order},
      {"order of the error estimate", analysis::verify_error_estimate},
      {"attempted steps", analysis::verify_step_control},
      {"dense output", analysis::verify_dense_output},
      {"error against tolerance", analysis::verify_tolerance_proportionality},
      {"rejected steps", analysis::verify_step_control},
      {"shorter last step", analysis::verify_step_control},
      {"polynomial exactness", analysis::verify_polynomial_exactness},
      {"tableau of the running code", analysis::verify_tableau},
      {"evaluations per step", analysis::verify_evaluation_count},
      {"stability function", analysis::verify_stability_function},
      {"oscillator matrix", analysis::verify_stability_function},
      {"recurrence of the formula", analysis::verify_stability_function},
      {"A-stability", analysis::verify_stability_limits},
      {"L-stability", analysis::verify_stability_limits},
      {"symplectic", analysis::verify_symplecticity},
      {"reversible in time", analysis::verify_reversibility},
      {"linear momentum", analysis::verify_conservation},
      {"energy", analysis::verify_conservation},
      {"fixed particles", analysis::verify_conservation},
      {"agreement with the oracle", analysis::verify_agreement},
  };
  return parts.at(property);
}

const Integrator& oracle() {
  static const std::unique_ptr<Integrator> cvode = right_scheme("sundials:cvode_bdf");
  return *cvode;
}

/// The parts of the verification that the mistake must trip, on the scheme with or without it.
std::vector<PropertyCheck> checks_of(const SeededBug& bug, bool mutated) {
  const std::unique_ptr<Integrator> integrator = bug.make(mutated);
  const SchemeUnderTest scheme{*integrator, mutated && bug.wrong_data ? *bug.wrong_data : bug.data,
                               &oracle()};
  std::set<Part> parts;
  std::vector<PropertyCheck> checks;
  for (const std::string& property : bug.caught_by) {
    if (parts.insert(part_of(property)).second) part_of(property)(scheme, checks);
  }
  return checks;
}

std::string describe(const PropertyCheck& check) {
  return fmt::format("{}: claimed {}, derived {}, measured {}; {}", check.property, check.claimed,
                     check.derived, check.measured, check.reason);
}

class SeededBugs : public testing::TestWithParam<SeededBug> {};

TEST_P(SeededBugs, AreCaught) {
  const SeededBug& bug = GetParam();
  const std::vector<PropertyCheck> checks = checks_of(bug, true);
  for (const std::string& property : bug.caught_by) {
    const auto found = std::find_if(checks.begin(), checks.end(),
                                    [&](const PropertyCheck& check) { return check.property == property; });
    ASSERT_NE(found, checks.end()) << property << " is not checked";
    EXPECT_EQ(found->finding, Finding::fails) << bug.description << " escapes: " << describe(*found);
  }
}

TEST_P(SeededBugs, AreNotSeenInTheRightTwin) {
  const SeededBug& bug = GetParam();
  const std::vector<PropertyCheck> checks = checks_of(bug, false);
  ASSERT_FALSE(checks.empty());
  for (const PropertyCheck& check : checks) EXPECT_NE(check.finding, Finding::fails) << describe(check);
}

INSTANTIATE_TEST_SUITE_P(Verification, SeededBugs, testing::ValuesIn(seeded_bugs()),
                         [](const testing::TestParamInfo<SeededBug>& bug) { return bug.param.name; });

TEST(ListOfSeededBugs, IsLongAndWithoutRepetition) {
  std::set<std::string> names;
  for (const SeededBug& bug : seeded_bugs()) {
    EXPECT_TRUE(names.insert(bug.name).second) << bug.name;
    EXPECT_FALSE(bug.caught_by.empty()) << bug.name;
  }
  EXPECT_GE(names.size(), 25u);
}

/// The complete verification finds what its parts find, and nothing in the right twin.
TEST(CompleteVerification, TellsSeededBugsFromTheirTwins) {
  for (const std::string name : {"rk4_swapped_weights", "forest_ruth_swapped_kicks", "bdf2_three_halves",
                                 "dormand_prince_estimate_times_h", "listed_rk4_with_wrong_weights"}) {
    const auto bug = std::find_if(seeded_bugs().begin(), seeded_bugs().end(),
                                  [&](const SeededBug& candidate) { return candidate.name == name; });
    ASSERT_NE(bug, seeded_bugs().end()) << name;
    const auto failures = [&](bool mutated) {
      const std::unique_ptr<Integrator> integrator = bug->make(mutated);
      std::vector<PropertyCheck> failing = analysis::verify(
          {*integrator, mutated && bug->wrong_data ? *bug->wrong_data : bug->data, &oracle()});
      std::erase_if(failing, [](const PropertyCheck& check) { return check.finding != Finding::fails; });
      return failing;
    };
    EXPECT_GE(failures(true).size(), 1u) << name;
    for (const PropertyCheck& check : failures(false)) ADD_FAILURE() << name << ": " << describe(check);
  }
}

}  // namespace
}  // namespace fw::conformance
