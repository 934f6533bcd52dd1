#include <gtest/gtest.h>

#include <set>

#include "catalog/builtin_catalog.hpp"
#include "catalog/study_kinds.hpp"
#include "memory_archive.hpp"
#include "paths.hpp"
#include "study/runner.hpp"

namespace fw::study {
namespace {

const std::string chain_study = fw::test::source_directory() + "/studies/stability/chain.toml";

TEST(StabilityStudy, NamesEveryExplicitSchemeOfTheCatalogue) {
  const std::vector<std::string> listed = CheckedTable::parse_file(chain_study).strings("methods");
  const std::set<std::string> methods(listed.begin(), listed.end());
  for (const catalog::MethodEntry& entry : catalog::methods()) {
    // Its inner solver chooses steps by tolerances: a step is no linear map.
    if (entry.name == "sundials:arkode_mri") continue;
    if (entry.info().is_explicit && entry.info().has_fixed_step) {
      EXPECT_TRUE(methods.contains(entry.name)) << entry.name;
    }
  }
}

TEST(StabilityStudy, HoldsForEveryExplicitSchemeOnAChain) {
  const Plan plan = read_plan(CheckedTable::parse_file(chain_study), catalog::study_kinds(),
                              catalog::BuiltinCatalog(), true);
  MemoryArchive archive;
  const StudyResult result = run_plan(plan, archive, {});
  EXPECT_GE(result.cases.size(), 60u);
  int held = 0;
  for (const CaseResult& entry : result.cases) {
    EXPECT_NE(entry.verdict, Verdict::fails) << entry.id << ": " << entry.reason;
    held += entry.verdict == Verdict::holds;
  }
  EXPECT_GE(held, 58);
}

}  // namespace
}  // namespace fw::study
