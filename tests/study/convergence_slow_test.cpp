#include <gtest/gtest.h>

#include "catalog/builtin_catalog.hpp"
#include "catalog/study_kinds.hpp"
#include "memory_archive.hpp"
#include "paths.hpp"
#include "study/runner.hpp"

namespace fw::study {
namespace {

TEST(Convergence, HoldsForEverySchemeOfTheMassSpringStudy) {
  const CheckedTable spec =
      CheckedTable::parse_file(fw::test::source_directory() + "/studies/convergence/mass_spring.toml");
  const Plan plan = read_plan(spec, catalog::study_kinds(), catalog::BuiltinCatalog(), true);
  MemoryArchive archive;
  const StudyResult result = run_plan(plan, archive, {});
  EXPECT_GE(result.cases.size(), 20u);
  for (const CaseResult& entry : result.cases)
    EXPECT_EQ(entry.verdict, Verdict::holds) << entry.id << ": " << entry.reason;
}

}  // namespace
}  // namespace fw::study
