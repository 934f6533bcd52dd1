#include "study/stability/stability.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "catalog/study_kinds.hpp"
#include "core/error.hpp"
#include "memory_archive.hpp"
#include "paths.hpp"
#include "seeded_catalog.hpp"
#include "seeded_schemes.hpp"
#include "study/runner.hpp"

namespace fw::study {
namespace {

using testing::HasSubstr;

StudyResult run(const std::string& methods, const std::string& rest,
                const Catalog& catalog = SeededCatalog({})) {
  const std::string text =
      "kind = \"stability\"\ntitle = \"test\"\nseed = 3\nmethods = [" + methods + "]\n" + rest;
  const Plan plan =
      read_plan(CheckedTable::parse_text(text, fw::test::source_directory() + "/studies/stability/test.toml"),
                catalog::study_kinds(), catalog, false);
  MemoryArchive archive;
  return run_plan(plan, archive, {});
}

double figure(const CaseResult& result, const std::string& name) {
  for (const SummaryCell& cell : result.summary) {
    if (cell.name == name) return std::get<double>(cell.value);
  }
  throw std::logic_error("no figure " + name);
}

std::vector<double> column(const CaseResult& result, const std::string& name) {
  for (const Column& entry : result.columns) {
    if (entry.name == name) return std::get<std::vector<double>>(entry.values);
  }
  throw std::logic_error("no column " + name);
}

void expect_all_hold(const StudyResult& study) {
  for (const CaseResult& result : study.cases)
    EXPECT_EQ(result.verdict, Verdict::holds) << result.id << ": " << result.reason;
}

const std::string oscillator =
    "[[problem]]\nname = \"harmonic_oscillator\"\nparameters = { mass = 0.5, stiffness = 18.0 }\n";  // ω = 6
const std::string short_runs = "[limits]\nfewest_steps = 1000\nfarthest = 50.0\n";

TEST(StabilityStudy, FindsTheClassicalLimitsOfAnOscillator) {
  const StudyResult study =
      run("\"rk4\", \"velocity_verlet\", \"verlet\", \"symplectic_euler\", "
          "\"adams_bashforth3\", \"kutta3\"",
          short_runs + oscillator);
  expect_all_hold(study);
  const double limits[] = {2.0 * std::sqrt(2.0), 2.0, 2.0, 2.0, 0.7236, std::sqrt(3.0)};
  for (std::size_t k = 0; k < study.cases.size(); ++k) {
    EXPECT_NEAR(figure(study.cases[k], "predicted_limit") * 6.0, limits[k], 1e-3) << study.cases[k].id;
    EXPECT_NEAR(figure(study.cases[k], "observed_limit") * 6.0, limits[k], 0.01 * limits[k]);
  }
}

TEST(StabilityStudy, ShowsTheGrowthOfSchemesThatAreNeverStable) {
  const StudyResult study =
      run("\"explicit_euler\", \"heun\", \"adams_bashforth2\", \"fehlberg_54\"", short_runs + oscillator);
  expect_all_hold(study);
  for (const CaseResult& result : study.cases) {
    EXPECT_EQ(figure(result, "predicted_limit"), 0.0) << result.id;
    EXPECT_EQ(figure(result, "observed_limit"), 0.0) << result.id;
    EXPECT_LT(figure(result, "largest_deviation"), 0.02);
  }
}

TEST(StabilityStudy, FindsNoLimitOfAStableSchemes) {
  const StudyResult study =
      run("\"implicit_euler\", \"trapezoidal\", \"exponential_rosenbrock_euler\"", short_runs + oscillator);
  expect_all_hold(study);
  for (const CaseResult& result : study.cases) EXPECT_TRUE(std::isinf(figure(result, "observed_limit")));
}

TEST(StabilityStudy, HoldsWhereDampersCoupleTheModes) {
  const StudyResult study = run(
      "\"explicit_euler\", \"rk4\", \"velocity_verlet\", \"verlet_backward_velocity\", \"blanes_moan4\", "
      "\"nystrom4_general\", \"r_respa\"",
      short_runs + "[[problem]]\nscene = \"../scenes/uneven_chain.toml\"\nt_end = 1.0\nlinearise = true\n");
  // R-RESPA has no coefficients: its steps are only compared with themselves.
  EXPECT_EQ(study.cases.back().verdict, Verdict::not_applicable);
  EXPECT_THAT(study.cases.back().reason, HasSubstr("agree with their own spectrum"));
  for (std::size_t k = 0; k + 1 < study.cases.size(); ++k)
    EXPECT_EQ(study.cases[k].verdict, Verdict::holds) << study.cases[k].reason;
  for (const CaseResult& result : study.cases) EXPECT_GT(figure(result, "predicted_limit"), 0.0) << result.id;
}

TEST(StabilityStudy, FindsTheThresholdsOfTheLecture) {
  const StudyResult study =
      run("\"explicit_euler\", \"rk4\", \"implicit_euler\"",
          short_runs +
              "[[problem]]\nname = \"dahlquist\"\nvary = { parameter = \"lambda\", values "
              "= [-0.5, -10.0, -400.0] }\nexponent = -1.0\n");
  expect_all_hold(study);
  const double k[] = {0.5, 10.0, 400.0};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(column(study.cases[0], "monotone_observed")[i] * k[i], 1.0, 1e-4);
    EXPECT_NEAR(column(study.cases[0], "observed_limit")[i] * k[i], 2.0, 0.02);
    EXPECT_NEAR(column(study.cases[1], "observed_limit")[i] * k[i], 2.7853, 0.03);
    EXPECT_TRUE(std::isinf(column(study.cases[1], "monotone_observed")[i])) << "R(z) > 0 for rk4";
    EXPECT_TRUE(std::isinf(column(study.cases[2], "observed_limit")[i]));
  }
  EXPECT_NEAR(figure(study.cases[0], "observed_exponent"), -1.0, 1e-3);
}

TEST(StabilityStudy, FitsTheLawOfSpringsAndFailsAnotherOne) {
  const std::string family =
      "[[problem]]\nname = \"linear_chain\"\nvary = { parameter = \"stiffness\", from = 1.0, to = 1e4, count "
      "= 4 }\n";
  const StudyResult right = run("\"rk4\"", short_runs + family + "exponent = -0.5\n");
  expect_all_hold(right);
  EXPECT_NEAR(figure(right.cases.front(), "observed_exponent"), -0.5, 2e-3);
  const StudyResult wrong = run("\"rk4\"", short_runs + family + "exponent = -0.55\n");
  EXPECT_EQ(wrong.cases.front().verdict, Verdict::fails) << wrong.cases.front().reason;
}

TEST(StabilityStudy, ReportsNonlinearProblemsWithoutAVerdict) {
  const StudyResult study =
      run("\"velocity_verlet\"", short_runs + "[[problem]]\nname = \"spring_pendulum\"\n");
  const CaseResult& result = study.cases.front();
  EXPECT_EQ(result.verdict, Verdict::not_applicable);
  EXPECT_THAT(result.reason, HasSubstr("nonlinear"));
  EXPECT_NEAR(figure(result, "ratio"), 1.0, 0.4);
}

TEST(StabilityStudy, SaysThatTheLinearPartHasLostTheSpringsThatAMethodNeeds) {
  const StudyResult study =
      run("\"implicit_euler_linearised[tangent=psd_projection]\", \"discrete_gradient\"",
          short_runs +
              "[[problem]]\nscene = \"../scenes/double_spring.toml\"\n"
              "label = \"pair\"\nlinearise = true\nt_end = 0.3\n");
  for (const CaseResult& result : study.cases) {
    EXPECT_EQ(result.verdict, Verdict::not_applicable) << result.reason;
    EXPECT_THAT(result.reason, HasSubstr("needs the springs of the problem"));
    EXPECT_EQ(text_of(result, "problem"), "pair");
    EXPECT_NE(text_of(result, "method"), "");
  }
}

TEST(StabilityStudy, HoldsTheRunningCodeAgainstItsRegion) {
  const StudyResult study =
      run("\"rk4\", \"velocity_verlet\", \"adams_bashforth3\", \"bdf2\", \"implicit_euler\"",
          "[regions]\npoints = 21\n");
  expect_all_hold(study);
  EXPECT_NEAR(figure(study.cases[0], "real_interval"), 2.78529, 1e-4);
  EXPECT_NEAR(figure(study.cases[1], "imaginary_interval"), 2.0, 1e-4);
  EXPECT_NEAR(figure(study.cases[2], "real_interval"), 6.0 / 11.0, 1e-4);
  EXPECT_NEAR(figure(study.cases[3], "stability_angle"), 90.0, 1e-6);
  EXPECT_EQ(figure(study.cases[4], "growth_at_infinity"), 0.0);
  EXPECT_EQ(column(study.cases[0], "growth").size(), 21u * 21u);
}

/// Velocity Verlet with a force that is too weak or too strong by `error`, under the name of the sound
/// scheme.
Seeds altered_verlet(double error) {
  Seeds seeds;
  seeds["velocity_verlet"] = [error] {
    return seeded_scheme("velocity_verlet", 2,
                         [error](auto& s, double t, double h, VectorRef q, VectorRef v, Vector&) {
                           const auto acceleration = [&](double time) -> Vector {
                             Vector f(q.size());
                             s.force(time, q, v, f);
                             return (1.0 + error) * f.cwiseQuotient(s.mass());
                           };
                           v += 0.5 * h * acceleration(t);
                           q += h * v;
                           v += 0.5 * h * acceleration(t + h);
                         });
  };
  return seeds;
}

TEST(StabilityStudy, FailsASchemeThatIsNotWhatItsCoefficientsSay) {
  // The limit is 2/√(1 + error): 6 % more force, 3 % less step.
  const StudyResult altered =
      run("\"velocity_verlet\"", short_runs + oscillator, SeededCatalog(altered_verlet(0.06)));
  EXPECT_EQ(altered.cases.front().verdict, Verdict::fails) << altered.cases.front().reason;
  const StudyResult sound =
      run("\"velocity_verlet\"", short_runs + oscillator, SeededCatalog(altered_verlet(0.0)));
  EXPECT_EQ(sound.cases.front().verdict, Verdict::holds) << sound.cases.front().reason;
  const StudyResult region =
      run("\"velocity_verlet\"", "[regions]\npoints = 11\n", SeededCatalog(altered_verlet(0.06)));
  EXPECT_EQ(region.cases.front().verdict, Verdict::fails) << region.cases.front().reason;
}

TEST(StabilityStudy, FailsAWrongGrowthOfASchemeThatIsNeverStable) {
  Seeds seeds;
  seeds["explicit_euler"] = [] {
    return seeded_scheme("explicit_euler", 1,
                         [](auto& s, double t, double h, VectorRef q, VectorRef v, Vector&) {
                           Vector f(q.size());
                           s.force(t, q, v, f);
                           q += h * v;
                           v += 1.05 * h * f.cwiseQuotient(s.mass());
                         });
  };
  const StudyResult study = run("\"explicit_euler\"", short_runs + oscillator, SeededCatalog(seeds));
  EXPECT_EQ(study.cases.front().verdict, Verdict::fails) << study.cases.front().reason;
}

std::string refusal(const std::string& methods, const std::string& rest) {
  try {
    run(methods, rest);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(StabilityStudy, RefusesBadInputBeforeAnythingRuns) {
  EXPECT_THAT(refusal("\"rk4\"", ""), HasSubstr("found neither [regions] nor [[problem]]"));
  EXPECT_THAT(refusal("\"rk5\"", "[regions]\n"), HasSubstr("unknown method \"rk5\""));
  EXPECT_THAT(refusal("\"rk4\"", "[regions]\nreal = [1.0, -1.0]\n"),
              HasSubstr("found [1, -1], expected [from, to] with from < to"));
  EXPECT_THAT(refusal("\"rk4\"", "[[problem]]\nname = \"dahlquist\"\nlinearise = true\n"),
              HasSubstr("expected M q'' = f(t, q, q')"));
  EXPECT_THAT(refusal("\"rk4\"", "[[problem]]\nname = \"dahlquist\"\nexponent = -1.0\n"),
              HasSubstr("found without vary"));
  EXPECT_THAT(refusal("\"rk4\"", "[limits]\ngrowth = 2.0\n[[problem]]\nname = \"dahlquist\"\n"),
              HasSubstr("expected a finite number > 4"));
}

TEST(StabilityStudy, GivesTheSameNumbersWithSeveralJobs) {
  const std::string text =
      "kind = \"stability\"\ntitle = \"t\"\nmethods = [\"rk4\", \"heun\", \"velocity_verlet\"]\n" +
      short_runs + "[[problem]]\nname = \"spring_pendulum\"\n" + oscillator;
  const SeededCatalog catalog({});
  const auto results = [&](int jobs) {
    const Plan plan =
        read_plan(CheckedTable::parse_text(text, "t.toml"), catalog::study_kinds(), catalog, false);
    MemoryArchive archive;
    RunOptions options;
    options.jobs = jobs;
    return run_plan(plan, archive, options);
  };
  const StudyResult one = results(1), many = results(3);
  ASSERT_EQ(one.cases.size(), many.cases.size());
  for (std::size_t k = 0; k < one.cases.size(); ++k) {
    EXPECT_EQ(one.cases[k].reason, many.cases[k].reason);
    EXPECT_EQ(column(one.cases[k], "observed_limit"), column(many.cases[k], "observed_limit"));
  }
}

TEST(StabilityStudy, JudgesTheHomogeneousPartOfForcedProblems) {
  const StudyResult study =
      run("\"implicit_euler\", \"trapezoidal\", \"rk4\", \"heun\"",
          short_runs + "[[problem]]\nname = \"prothero_robinson\"\nparameters = { lambda = -100.0 }\n");
  expect_all_hold(study);
  EXPECT_NEAR(figure(study.cases[1], "monotone_observed"), 0.02, 1e-5);
}

TEST(StabilityStudy, JudgesNoProblemThatGrowsByItself) {
  const StudyResult study =
      run("\"rk4\"", short_runs + "[[problem]]\nname = \"dahlquist\"\nparameters = { lambda = 2.0 }\n");
  EXPECT_EQ(study.cases.front().verdict, Verdict::not_applicable);
  EXPECT_THAT(study.cases.front().reason, HasSubstr("Re λ > 0"));
}

TEST(StabilityStudy, PredictsTheLimitsOfOraclesFromTheirTables) {
  const StudyResult study =
      run("\"gsl:rk2\", \"gsl:rk4\", \"gsl:rkf45\", \"gsl:rkck\", \"gsl:rk8pd\", "
          "\"sundials:arkode_erk\", \"petsc:ts_rk[type=4]\", \"petsc:ts_basicsymplectic\"",
          short_runs + oscillator);
  expect_all_hold(study);
}

}  // namespace
}  // namespace fw::study
