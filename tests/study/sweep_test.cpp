#include "study/kinds/sweep.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdlib.h>

#include <filesystem>
#include <fstream>

#include "catalog/builtin_catalog.hpp"
#include "catalog/study_kinds.hpp"
#include "core/error.hpp"
#include "memory_archive.hpp"
#include "study/problem_spec.hpp"
#include "study/runner.hpp"

namespace fw::study {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

Plan plan_of(const std::string& text, bool quick = false) {
  return read_plan(CheckedTable::parse_text(text, "sweep.toml"), catalog::study_kinds(),
                   catalog::BuiltinCatalog(), quick);
}

StudyResult result_of(const Plan& plan) {
  MemoryArchive archive;
  return run_plan(plan, archive, {});
}

const std::string head = "kind = 'sweep'\ntitle = 'T'\n";
const std::string stiffness =
    "[[parameter]]\npath = 'problem[0].parameters.stiffness'\nvalues = [1.0, 2.5, 4]\n";
const std::string inner =
    "[study]\nkind = 'simulate'\nmethods = ['rk4']\nsteps = [0.1]\nframes = 2\n"
    "[[study.problem]]\nname = 'harmonic_oscillator'\nt_end = 1\n";

std::vector<std::string> ids_of(const Plan& plan) {
  std::vector<std::string> ids;
  for (const PlannedCase& planned : plan.cases) ids.push_back(planned.id);
  return ids;
}

double number_in(const CaseResult& result, const std::string& name) {
  for (const auto* row : {&result.parameters, &result.summary}) {
    for (const SummaryCell& cell : *row) {
      if (cell.name == name) return std::get<double>(cell.value);
    }
  }
  ADD_FAILURE() << "no column " << name;
  return 0.0;
}

std::vector<double> state(const CaseResult& result) {
  for (const Column& column : result.columns) {
    if (column.name == "state") return std::get<0>(column.values);
  }
  ADD_FAILURE() << "no column state";
  return {};
}

TEST(Sweep, RunsTheInnerStudyAtEveryPointOfTheGrid) {
  const Plan plan =
      plan_of(head + stiffness +
              "[[parameter]]\npath = 'methods[0]'\nname = 'scheme'\nvalues = ['rk4', 'heun']\n" + inner);
  EXPECT_THAT(ids_of(plan), ElementsAre("stiffness=1,scheme=rk4-harmonic_oscillator-rk4-h0.1",
                                        "stiffness=1,scheme=heun-harmonic_oscillator-heun-h0.1",
                                        "stiffness=2.5,scheme=rk4-harmonic_oscillator-rk4-h0.1",
                                        "stiffness=2.5,scheme=heun-harmonic_oscillator-heun-h0.1",
                                        "stiffness=4,scheme=rk4-harmonic_oscillator-rk4-h0.1",
                                        "stiffness=4,scheme=heun-harmonic_oscillator-heun-h0.1"));
  const StudyResult result = result_of(plan);
  ASSERT_EQ(result.cases.size(), 6u);
  EXPECT_EQ(number_in(result.cases[2], "parameter_stiffness"), 2.5);
  EXPECT_EQ(std::get<std::string>(result.cases[3].parameters[1].value), "heun");
}

TEST(Sweep, GivesTheNumbersOfTheStudyWithThatValueWrittenInIt) {
  const StudyResult swept = result_of(plan_of(head + stiffness + inner));
  for (const CaseResult& result : swept.cases) {
    const double k = number_in(result, "parameter_stiffness");
    const StudyResult single = result_of(
        plan_of("kind = 'simulate'\ntitle = 'T'\nmethods = ['rk4']\nsteps = [0.1]\nframes = "
                "2\n[[problem]]\nname = 'harmonic_oscillator'\nt_end = 1\nparameters = { stiffness = " +
                std::to_string(k) + " }\n"));
    EXPECT_EQ(number_in(result, "end_error"), number_in(single.cases.at(0), "end_error")) << k;
  }
  EXPECT_NE(number_in(swept.cases[0], "end_error"), number_in(swept.cases[1], "end_error"));
}

TEST(Sweep, TakesGeometricSequencesAndThinsThemOutWhenQuick) {
  const std::string text =
      head + "[[parameter]]\npath = 'problem[0].parameters.stiffness'\nfrom = 1\nto = 100\ncount = 5\n" +
      inner;
  EXPECT_EQ(plan_of(text).cases.size(), 5u);
  const Plan quick = plan_of(text + "[quick]\nvalues = 3\n", true);
  EXPECT_THAT(ids_of(quick), ElementsAre(HasSubstr("stiffness=1-"), HasSubstr("stiffness=10-"),
                                         HasSubstr("stiffness=100-")));
}

TEST(Sweep, NamesAnEntryOfAListByItsKey) {
  const Plan plan = plan_of(head + "[[parameter]]\npath = 'steps[0]'\nvalues = [0.1, 0.2]\n" + inner);
  EXPECT_THAT(ids_of(plan), ElementsAre("steps=0.1-harmonic_oscillator-rk4-h0.1",
                                        "steps=0.2-harmonic_oscillator-rk4-h0.2"));
}

TEST(Sweep, RefusesMistakesOfItsOwnAndOfTheInnerStudy) {
  const auto refuses = [](const std::string& text, const std::string& why) {
    EXPECT_THAT([&] { plan_of(text); }, ThrowsMessage<InputError>(HasSubstr(why))) << text;
  };
  refuses(head + inner, "found no [[parameter]]");
  refuses(head + stiffness, "[study]");
  refuses(head + stiffness + stiffness + inner, "another parameter is called \"stiffness\"");
  refuses(head + "[[parameter]]\npath = 'problem[0].parameters.stifness'\nvalues = [1]\n" + inner,
          "stifness");
  refuses(head + "[[parameter]]\npath = 'problem[1].t_end'\nvalues = [1]\n" + inner,
          "found index 1, expected less than 1");
  refuses(head + "[[parameter]]\npath = 'stepz'\nvalues = [1]\n" + inner, "stepz");
  refuses(head + "[[parameter]]\npath = 'problem[0].t_end'\nvalues = [1, 1]\n" + inner, "found 1 twice");
  refuses(head + "[[parameter]]\npath = 'problem[0].t_end'\nvalues = []\n" + inner, "empty list");
  refuses(head + "[[parameter]]\npath = 'problem[0].t_end'\nvalues = [1]\nunits = 's'\n" + inner,
          "unknown key \"units\"");
  refuses("quantities = ['end_eror']\n" + head + stiffness + inner, "did you mean \"end_error\"?");
  refuses("quantities = ['method']\n" + head + stiffness + inner, "found \"method\", expected numbers");
  EXPECT_NO_THROW(plan_of("quantities = ['end_error', 'parameter_stiffness']\n" + head + stiffness + inner));
  refuses(head + "[[parameter]]\npath = 'title'\nvalues = ['x']\n[study]\nkind = 'sweep'\n", "\"sweep\"");
}

TEST(Sweep, LetsTheInnerStudyConcludeAtEveryPoint) {
  const StudyResult result =
      result_of(plan_of(head + "[[parameter]]\npath = 'problem[0].parameters.stiffness'\nvalues = [1, 4]\n"
                               "[study]\nkind = 'work_precision'\nmethods = ['rk4', 'heun']\n"
                               "[[study.problem]]\nname = 'harmonic_oscillator'\nt_end = 2.0\n",
                        true));
  std::size_t fronts = 0;
  for (const CaseResult& one : result.cases) {
    EXPECT_EQ(one.parameters.front().name, "parameter_stiffness");
    for (const Column& column : one.columns) {
      if (column.name != "front_rhs_evaluations_method") continue;
      ++fronts;
      EXPECT_FALSE(std::get<2>(column.values).empty()) << one.id;
    }
  }
  EXPECT_EQ(fronts, 2u);
}

/// A scene file in a directory of the test's own.
class SweepOfAScene : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (std::filesystem::temp_directory_path() / "federwerk-sweep-XXXXXX").string();
    directory_ = ::mkdtemp(name.data());
    std::ofstream(directory_ / "sweep_scene.toml")
        << "[particles]\nposition = [[0,0,0], [1.2,0,0]]\nmass = 1\nfixed = [0]\n"
           "[springs]\nbetween = [[0,1]]\nstiffness = 4\nrest_length = 1\n";
  }
  void TearDown() override { std::filesystem::remove_all(directory_); }

  /// As if the study file stood beside the scene.
  Plan plan_here(const std::string& text, const std::string& name = "sweep.toml") const {
    return read_plan(CheckedTable::parse_text(text, (directory_ / name).string()), catalog::study_kinds(),
                     catalog::BuiltinCatalog(), false);
  }

  std::filesystem::path directory_;
};

TEST_F(SweepOfAScene, SetsNumbersOfTheSceneAndNeedsNoFileAfterwards) {
  const Plan plan = plan_here(head +
                              "[[parameter]]\npath = 'problem[0].set.springs.stiffness'\nvalues = [4, 9]\n"
                              "[study]\nkind = 'simulate'\nmethods = ['rk4']\nsteps = [0.1]\nframes = 2\n"
                              "[[study.problem]]\nscene = 'sweep_scene.toml'\nt_end = 1\n");
  const StudyResult first = result_of(plan);
  ASSERT_EQ(first.cases.size(), 2u);

  EXPECT_NE(state(first.cases[0]), state(first.cases[1]));
  std::filesystem::remove(directory_ / "sweep_scene.toml");
  const Plan again = read_plan(CheckedTable::parse_text(plan.spec, "result.h5 (spec)"),
                               catalog::study_kinds(), catalog::BuiltinCatalog(), false);
  const StudyResult second = result_of(again);
  EXPECT_EQ(state(second.cases.at(0)), state(first.cases[0]));
  EXPECT_EQ(state(second.cases.at(1)), state(first.cases[1]));
}

TEST_F(SweepOfAScene, OverScenesKeepsTheTextOfEach) {
  std::ofstream(directory_ / "sweep_other.toml")
      << "[particles]\nposition = [[0,0,0], [1.5,0,0]]\nmass = 2\nfixed = [0]\n"
         "[springs]\nbetween = [[0,1]]\nstiffness = 4\nrest_length = 1\n";
  const Plan plan = plan_here(
      head +
      "[[parameter]]\npath = 'problem[0].scene'\nvalues = ['sweep_scene.toml', 'sweep_other.toml']\n"
      "[study]\nkind = 'simulate'\nmethods = ['rk4']\nsteps = [0.1]\nframes = 2\n"
      "[[study.problem]]\nscene = 'sweep_scene.toml'\nt_end = 1\n");
  const StudyResult first = result_of(plan);
  std::filesystem::remove(directory_ / "sweep_other.toml");
  std::filesystem::remove(directory_ / "sweep_scene.toml");
  const StudyResult second = result_of(read_plan(CheckedTable::parse_text(plan.spec, "result.h5 (spec)"),
                                                 catalog::study_kinds(), catalog::BuiltinCatalog(), false));

  EXPECT_NE(state(first.cases.at(0)), state(first.cases.at(1)));
  EXPECT_EQ(state(second.cases.at(0)), state(first.cases.at(0)));
  EXPECT_EQ(state(second.cases.at(1)), state(first.cases.at(1)));
}

TEST(Sweep, NamesThePointOfACaseThatCouldNotBeComputed) {
  Plan plan = plan_of(head + stiffness + inner);
  plan.cases[1].run = [](const RunContext&) -> CaseResult { throw std::runtime_error("broken on purpose"); };
  const StudyResult result = result_of(plan);
  EXPECT_EQ(result.cases.at(1).verdict, Verdict::fails);
  EXPECT_EQ(number_in(result.cases.at(1), "parameter_stiffness"), 2.5);
  EXPECT_EQ(text_of(result.cases.at(1), "method"), "rk4");
  EXPECT_EQ(text_of(result.cases.at(1), "problem"), "harmonic_oscillator");
  EXPECT_EQ(number_in(result.cases.at(1), "step"), 0.1);
}

TEST(Sweep, OfTrajectoriesIsDoneAndHoldsNothing) {
  for (const CaseResult& result : result_of(plan_of(head + stiffness + inner)).cases)
    EXPECT_EQ(result.verdict, Verdict::done) << result.id << ": " << result.reason;
}

/// The sections [[problem]] alone.
struct Families {
  std::vector<FamilySpec> problems;
};
void declare(settings::Archive& a, Families& families) {
  a.sections(problem_sections, families.problems);
}

TEST_F(SweepOfAScene, FamiliesVaryANumberOfACatalogueProblemOrOfAScene) {
  std::vector<std::string> warnings;
  const CheckedTable spec = CheckedTable::parse_text(
      "[[problem]]\nname = 'harmonic_oscillator'\nvary = { parameter = 'stiffness', from = 1, to = 100, "
      "count = 3 }\n"
      "[[problem]]\nscene = 'sweep_scene.toml'\nt_end = 1\nvary = { parameter = 'springs.damping', values = "
      "[0, 0.5] }\n"
      "[[problem]]\nname = 'rotation'\n",
      (directory_ / "family.toml").string());
  Families given;
  const catalog::BuiltinCatalog catalog;
  const StudyInput input{spec, settings::read(spec, given), catalog};
  const std::vector<ProblemFamily> families = make_families(given.problems, input, warnings);
  ASSERT_EQ(families.size(), 3u);
  EXPECT_EQ(families[0].label, "harmonic_oscillator");
  ASSERT_EQ(families[0].members.size(), 3u);
  EXPECT_EQ(families[0].members[1].label, "harmonic_oscillator-stiffness=10");
  EXPECT_NE(families[0].members[0].identity, families[0].members[1].identity);
  EXPECT_EQ(families[1].values, (std::vector<double>{0.0, 0.5}));
  EXPECT_EQ(families[1].members[1].label, "sweep_scene-damping=0.5");
  EXPECT_NE(families[1].members[0].scene_toml, families[1].members[1].scene_toml);
  EXPECT_EQ(families[2].members.size(), 1u);
  EXPECT_TRUE(families[2].parameter.empty());
}

}  // namespace
}  // namespace fw::study
