#include "conformance/seeded_bugs.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "analysis/verification/verification.hpp"
#include "catalog/builtin_catalog.hpp"
#include "study/verification/verify.hpp"

namespace fw::conformance {
namespace {

using analysis::PropertyCheck;

/// Which part of the verification reports a property.
const std::string& part_of(const std::string& property) {
  static const std::map<std::string, std::string> parts{
      {"order, forces f(t, q)", "order"},
      {"order, forces f(t, q, v)", "order"},
      {"order, y' = f(t, y)", "order"},
      {"double and binary128 agree", "order"},
      {"order of the error estimate", "error_estimate"},
      {"attempted steps", "step_control"},
      {"dense output", "dense_output"},
      {"frames against the end", "frames"},
      {"error against tolerance", "tolerance_proportionality"},
      {"rejected steps", "step_control"},
      {"shorter last step", "step_control"},
      {"polynomial exactness", "polynomial_exactness"},
      {"tableau of the running code", "tableau"},
      {"evaluations per step", "evaluation_count"},
      {"stability function", "stability_function"},
      {"oscillator matrix", "stability_function"},
      {"recurrence of the formula", "stability_function"},
      {"A-stability", "stability_limits"},
      {"L-stability", "stability_limits"},
      {"symplectic", "symplecticity"},
      {"reversible in time", "reversibility"},
      {"linear momentum", "conservation"},
      {"energy", "conservation"},
      {"fixed particles", "conservation"},
      {"agreement with the oracle", "agreement"},
  };
  return parts.at(property);
}

/// A catalogue with one more scheme, "seed": the one with the mistake, or its right twin.
class CatalogueWithSeed final : public study::Catalog {
 public:
  CatalogueWithSeed(const SeededBug& bug, bool mutated) : bug_(bug), mutated_(mutated) {}
  std::unique_ptr<Integrator> method(const std::string& call) const override {
    return call == "seed" ? bug_.make(mutated_) : builtin_.method(call);
  }
  analysis::Theory theory(const std::string& call) const override {
    if (call != "seed") return builtin_.theory(call);
    return analysis::theory_of(mutated_ && bug_.wrong_data ? *bug_.wrong_data : bug_.data);
  }
  std::vector<std::string> method_names() const override { return builtin_.method_names(); }
  Problem problem(const std::string& name, const ProblemParameters& parameters) const override {
    return builtin_.problem(name, parameters);
  }

 private:
  catalog::BuiltinCatalog builtin_;
  const SeededBug& bug_;
  bool mutated_;
};

/// What a study of the kind "verify" finds on the scheme with or without the mistake, by these parts (none
/// named: all). The case runs in this process, which keeps the certified references.
std::vector<PropertyCheck> findings(const SeededBug& bug, bool mutated, const std::set<std::string>& parts) {
  std::string text = "kind = \"verify\"\ntitle = \"t\"\nmethods = [\"seed\"]\n";
  if (!parts.empty()) text += fmt::format("[verify]\nparts = [\"{}\"]\n", fmt::join(parts, "\", \""));
  const CatalogueWithSeed catalogue(bug, mutated);
  const study::Plan plan =
      study::read_plan(CheckedTable::parse_text(text, "seed.toml"), {study::verify_kind()}, catalogue, false);
  const study::CaseResult result = plan.cases.front().run({});
  const auto texts = [&](const char* name) {
    return std::get<std::vector<std::string>>(study::column_of(result, name).values);
  };
  std::vector<PropertyCheck> checks;
  for (std::size_t k = 0; k < texts("property").size(); ++k) {
    const std::string verdict = texts("verdict")[k];
    checks.push_back({.property = texts("property")[k],
                      .claimed = texts("claimed")[k],
                      .derived = texts("derived")[k],
                      .measured = texts("measured")[k],
                      .verdict = verdict == "holds"   ? Verdict::holds
                                 : verdict == "fails" ? Verdict::fails
                                                      : Verdict::not_applicable,
                      .reason = texts("reason")[k]});
  }
  const bool any_fails = std::any_of(checks.begin(), checks.end(), [](const PropertyCheck& check) {
    return check.verdict == Verdict::fails;
  });
  EXPECT_EQ(result.verdict == Verdict::fails, any_fails) << bug.name;
  return checks;
}

/// The parts of the verification that the mistake must trip.
std::set<std::string> parts_of(const SeededBug& bug) {
  std::set<std::string> parts;
  for (const std::string& property : bug.caught_by) parts.insert(part_of(property));
  return parts;
}

/// What a part finds on the right twin. A scheme of the catalogue is the twin of many mistakes, and is verified once.
const std::vector<PropertyCheck>& findings_in_twin(const SeededBug& bug, const std::string& part) {
  static std::map<std::pair<std::string, std::string>, std::vector<PropertyCheck>> known;
  const auto [found, is_new] = known.try_emplace({bug.twin.empty() ? bug.name : bug.twin, part});
  if (is_new) found->second = findings(bug, false, {part});
  return found->second;
}

std::string describe(const PropertyCheck& check) {
  return fmt::format("{}: claimed {}, derived {}, measured {}; {}", check.property, check.claimed,
                     check.derived, check.measured, check.reason);
}

class SeededBugs : public testing::TestWithParam<SeededBug> {};

TEST_P(SeededBugs, AreCaught) {
  const SeededBug& bug = GetParam();
  const std::vector<PropertyCheck> checks = findings(bug, true, parts_of(bug));
  for (const std::string& property : bug.caught_by) {
    const auto found = std::find_if(checks.begin(), checks.end(),
                                    [&](const PropertyCheck& check) { return check.property == property; });
    ASSERT_NE(found, checks.end()) << property << " is not checked";
    EXPECT_EQ(found->verdict, Verdict::fails) << bug.description << " escapes: " << describe(*found);
  }
}

TEST_P(SeededBugs, AreNotSeenInTheRightTwin) {
  const SeededBug& bug = GetParam();
  for (const std::string& part : parts_of(bug)) {
    const std::vector<PropertyCheck>& checks = findings_in_twin(bug, part);
    ASSERT_FALSE(checks.empty());
    for (const PropertyCheck& check : checks) EXPECT_NE(check.verdict, Verdict::fails) << describe(check);
  }
}

INSTANTIATE_TEST_SUITE_P(Verification, SeededBugs, testing::ValuesIn(seeded_bugs()),
                         [](const testing::TestParamInfo<SeededBug>& bug) { return bug.param.name; });

TEST(ListOfSeededBugs, IsLongAndWithoutRepetition) {
  std::set<std::string> names;
  for (const SeededBug& bug : seeded_bugs()) {
    EXPECT_TRUE(names.insert(bug.name).second) << bug.name;
    EXPECT_FALSE(bug.caught_by.empty()) << bug.name;
  }
  EXPECT_GE(names.size(), 70u);
}

/// The complete verification finds what its parts find, and nothing in the right twin.
TEST(CompleteVerification, TellsSeededBugsFromTheirTwins) {
  for (const std::string name : {"rk4_swapped_weights", "forest_ruth_swapped_kicks", "bdf2_three_halves",
                                 "dormand_prince_estimate_times_h", "listed_rk4_with_wrong_weights"}) {
    const auto bug = std::find_if(seeded_bugs().begin(), seeded_bugs().end(),
                                  [&](const SeededBug& candidate) { return candidate.name == name; });
    ASSERT_NE(bug, seeded_bugs().end()) << name;
    const auto failures = [&](bool mutated) {
      std::vector<PropertyCheck> failing = findings(*bug, mutated, {});
      std::erase_if(failing, [](const PropertyCheck& check) { return check.verdict != Verdict::fails; });
      return failing;
    };
    EXPECT_GE(failures(true).size(), 1u) << name;
    for (const PropertyCheck& check : failures(false)) ADD_FAILURE() << name << ": " << describe(check);
  }
}

}  // namespace
}  // namespace fw::conformance
