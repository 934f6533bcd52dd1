#include "study/plan.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "catalog/builtin_catalog.hpp"
#include "catalog/study_kinds.hpp"
#include "paths.hpp"

namespace fw::study {
namespace {

TEST(Plan, OfTheResolvedSpecificationHasTheSameCasesForEveryStudyOfTheProject) {
  const catalog::BuiltinCatalog catalog;
  std::size_t studies = 0;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(fw::test::source_directory() + "/studies")) {
    if (entry.path().extension() != ".toml") continue;
    if (entry.path().string().find("/studies/scenes/") != std::string::npos) continue;
    SCOPED_TRACE(entry.path().string());
    ++studies;
    const Plan plan =
        read_plan(CheckedTable::parse_file(entry.path()), catalog::study_kinds(), catalog, true);
    const Plan again = read_plan(CheckedTable::parse_text(plan.spec, "result.h5 (spec)"),
                                 catalog::study_kinds(), catalog, true);
    ASSERT_EQ(again.cases.size(), plan.cases.size());
    for (std::size_t k = 0; k < plan.cases.size(); ++k) {
      EXPECT_EQ(again.cases[k].id, plan.cases[k].id);
      EXPECT_EQ(again.cases[k].identity, plan.cases[k].identity);
    }
    // Each names what it is of, also where it cannot be computed; throws where a name or type is not the kind's.
    for (const PlannedCase& planned : plan.cases) {
      EXPECT_FALSE(planned.known.empty()) << planned.id;
      EXPECT_NO_THROW(missing_row(plan.summary, planned.known)) << planned.id;
    }
    EXPECT_EQ(again.spec, plan.spec);
  }
  EXPECT_GE(studies, 40u);
}

}  // namespace
}  // namespace fw::study
