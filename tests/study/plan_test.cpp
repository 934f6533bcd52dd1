#include "study/plan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "catalog/builtin_catalog.hpp"
#include "catalog/study_kinds.hpp"
#include "core/error.hpp"
#include "paths.hpp"

namespace fw::study {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

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

TEST(Plan, ACaseThatAppearsTwiceIsToldWhatToChange) {
  const catalog::BuiltinCatalog catalog;
  const auto message = [&](const std::string& methods, const std::string& problems) -> std::string {
    const std::string text = "kind = 'convergence'\ntitle = 't'\nmethods = " + methods + "\n" + problems;
    try {
      read_plan(CheckedTable::parse_text(text, "a.toml"), catalog::study_kinds(), catalog, false);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no InputError";
  };
  const std::string one = "[[problem]]\nname = 'rotation'\nt_end = 1.0\n";
  const std::string other = "[[problem]]\nname = 'rotation'\nt_end = 2.0\n";
  EXPECT_THAT(message("['rk4', 'heun', 'rk4']", one),
              HasSubstr("the method \"rk4\" is listed twice, remove one"));
  EXPECT_THAT(message("['rk4']", one + other), HasSubstr("give one of its problems another label"));
}

TEST(Plan, TheArithmeticOfAReferenceIsInTheTextOnlyWhereItIsGiven) {
  const catalog::BuiltinCatalog catalog;
  const auto plan = [&](const std::string& key) {
    const std::string text = "kind = 'convergence'\ntitle = 't'\nmethods = ['rk4']\n[convergence]\n" + key +
                             "\n[[problem]]\nname = 'spring_pendulum'\nt_end = 1.0\n";
    return read_plan(CheckedTable::parse_text(text, "a.toml"), catalog::study_kinds(), catalog, false);
  };
  const Plan without = plan(""), quick = plan("reference = 'binary64'"),
             full = plan("reference = 'binary128'");
  EXPECT_THAT(without.spec, Not(HasSubstr("reference")));
  EXPECT_THAT(quick.spec, HasSubstr("reference = \"binary64\""));
  EXPECT_EQ(full.cases[0].identity, without.cases[0].identity);
  EXPECT_NE(quick.cases[0].identity, without.cases[0].identity);
  EXPECT_THROW(plan("reference = 'binary32'"), InputError);
}

}  // namespace
}  // namespace fw::study
