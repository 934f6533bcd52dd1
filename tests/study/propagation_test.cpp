#include "study/propagation/propagation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "seeded_catalog.hpp"
#include "seeded_schemes.hpp"
#include "study_of_text.hpp"

namespace fw::study {
namespace {

using testing::HasSubstr;

std::string spec(const std::string& methods, const std::string& keys = "",
                 const std::string& problem = "name = \"linear_chain\"\nparameters = { count = 61 }\n") {
  return "kind = \"propagation\"\ntitle = \"test\"\nmethods = [" + methods +
         "]\n[propagation]\nsteps = [0.06]\nstep_count = 80\n" + keys + "[[problem]]\n" + problem;
}

TEST(Propagation, GoesAsFarPerStepAsTheStagesReach) {
  const StudyResult result = run_study(spec("\"explicit_euler\", \"symplectic_euler\", \"velocity_verlet\", "
                                            "\"verlet\", \"heun\", \"kutta3\", \"rk4\", "
                                            "\"forest_ruth\", \"nystrom4\""),
                                       SeededCatalog({}));
  const double springs[] = {0.5, 1.0, 1.0, 1.0, 1.0, 1.5, 2.0, 3.0, 2.0};
  for (std::size_t k = 0; k < result.cases.size(); ++k) {
    const CaseResult& entry = result.cases[k];
    EXPECT_EQ(entry.verdict, Verdict::holds) << entry.id << ": " << entry.reason;
    EXPECT_NEAR(figure(entry, "springs_per_step"), springs[k], 0.01) << entry.id;
  }
}

TEST(Propagation, ReachesTheWholeSystemInOneImplicitStep) {
  const StudyResult result =
      run_study(spec("\"implicit_euler\", \"implicit_euler_linearised[linear_solver=lu]\", \"trapezoidal\", "
                     "\"newmark\", \"gauss2\""),
                SeededCatalog({}));
  for (const CaseResult& entry : result.cases) {
    EXPECT_EQ(entry.verdict, Verdict::holds) << entry.id << ": " << entry.reason;
    EXPECT_EQ(figure<std::int64_t>(entry, "first_step_position"), 30) << entry.id;
  }
}

TEST(Propagation, OfAnIterativeSolverEndsAtItsTolerance) {
  const StudyResult result = run_study(
      spec("\"implicit_euler_linearised[linear_solver=cg,linear_tolerance=1e-3]\""), SeededCatalog({}));
  const CaseResult& entry = result.cases.front();
  EXPECT_EQ(entry.verdict, Verdict::not_applicable) << entry.reason;
  EXPECT_LT(figure<std::int64_t>(entry, "first_step_position"), 15);
  EXPECT_GT(figure<std::int64_t>(entry, "first_step_position"), 1);
}

TEST(Propagation, OfTheWaveHasThePhysicalSpeed) {
  const StudyResult result =
      run_study(spec("\"velocity_verlet\", \"rk4\", \"trapezoidal\""), SeededCatalog({}));
  for (const CaseResult& entry : result.cases) {
    EXPECT_NEAR(figure(entry, "physical_wave_speed"), std::sqrt(20.0 / 0.5), 1e-12);
    EXPECT_NEAR(figure(entry, "wave_speed") / figure(entry, "physical_wave_speed"), 1.0, 0.02) << entry.id;
  }
}

TEST(Propagation, FollowsTheSpringsOfAScene) {
  const StudyResult result =
      run_study(spec("\"velocity_verlet\", \"rk4\", \"implicit_euler_linearised[linear_solver=lu]\"",
                     "mass = 7\ndirection = [0.3, 0.5, 1.0]\n",
                     "scene = \"../scenes/resting_cloth.toml\"\nt_end = 1.0\n"),
                SeededCatalog({}));
  for (const CaseResult& entry : result.cases)
    EXPECT_EQ(entry.verdict, Verdict::holds) << entry.id << ": " << entry.reason;
  EXPECT_TRUE(std::isnan(figure(result.cases[0], "physical_wave_speed")));
}

TEST(Propagation, GoesThroughDampersInTheSameStep) {
  const std::filesystem::path path = std::filesystem::temp_directory_path() /
                                     ("federwerk_propagation_" + std::to_string(::getpid()) + ".toml");
  std::ofstream(path)
      << "[generate]\nkind = \"chain\"\ncount = 30\nspacing = 1.0\nmass = 0.5\nstiffness = 20.0\n"
         "damping = 3.0\n";
  const StudyResult result =
      run_study(spec("\"explicit_euler\", \"rk4\", \"symplectic_euler\", \"velocity_verlet\"", "",
                     "scene = \"" + path.string() + "\"\nt_end = 1.0\n"),
                SeededCatalog({}));
  std::filesystem::remove(path);
  EXPECT_EQ(result.cases[0].verdict, Verdict::holds) << result.cases[0].reason;
  EXPECT_EQ(result.cases[1].verdict, Verdict::holds) << result.cases[1].reason;
  for (const std::size_t k : {2u, 3u}) {
    EXPECT_NE(result.cases[k].verdict, Verdict::fails)
        << result.cases[k].id << ": " << result.cases[k].reason;
  }
}

/// Velocity Verlet that evaluates its force once more per step, and one whose force lags a step behind.
Seeds seeded_bugs() {
  Seeds seeds;
  const auto acceleration = [](const SecondOrderSystem& s, double t, const Vector& q) {
    Vector f(q.size());
    s.force(t, q, Vector::Zero(q.size()), f);
    return Vector(f.cwiseQuotient(s.mass()));
  };
  seeds["too_fast"] = [acceleration] {
    return seeded_scheme("too_fast", 2,
                         [acceleration](auto& s, double t, double h, VectorRef q, VectorRef v, Vector&) {
                           v += 0.5 * h * acceleration(s, t, q);
                           q += h * v;
                           v += 0.5 * h * acceleration(s, t + h, q + 1e-12 * acceleration(s, t + h, q));
                         });
  };
  seeds["too_slow"] = [acceleration] {
    return seeded_scheme("too_slow", 2,
                         [acceleration](auto& s, double t, double h, VectorRef q, VectorRef v, Vector& old) {
                           const Vector a = acceleration(s, t, q);
                           if (old.size() == 0) old = a;
                           q += h * v + 0.5 * h * h * old;
                           v += h * old;
                           old = a;
                         });
  };
  return seeds;
}

TEST(Propagation, CatchesASchemeThatReachesFartherOrLessFarThanItsStages) {
  const SeededCatalog catalog(seeded_bugs(),
                              {{"too_fast", "velocity_verlet"}, {"too_slow", "velocity_verlet"}});
  const StudyResult result = run_study(spec("\"too_fast\", \"too_slow\""), catalog);
  for (const CaseResult& entry : result.cases) {
    EXPECT_EQ(entry.verdict, Verdict::fails) << entry.id << ": " << entry.reason;
    EXPECT_THAT(entry.reason, HasSubstr("predicted"));
  }
}

TEST(Propagation, CatchesAWaveOfTheWrongSpeed) {
  Seeds seeds;
  seeds["heavy"] = [] {
    return seeded_scheme("heavy", 2, [](auto& s, double t, double h, VectorRef q, VectorRef v, Vector&) {
      Vector f(q.size());
      s.force(t, q, v, f);
      v += 0.5 * h * 0.9 * f.cwiseQuotient(s.mass());
      q += h * v;
      s.force(t + h, q, v, f);
      v += 0.5 * h * 0.9 * f.cwiseQuotient(s.mass());
    });
  };
  const SeededCatalog catalog(seeds, {{"heavy", "velocity_verlet"}});
  const CaseResult entry = run_study(spec("\"heavy\""), catalog).cases.front();
  EXPECT_EQ(entry.verdict, Verdict::fails) << entry.reason;
  EXPECT_THAT(entry.reason, HasSubstr("FAILS: wave at"));
}

TEST(Propagation, RefusesBadInputBeforeAnythingRuns) {
  const SeededCatalog catalog({});
  EXPECT_THAT(refusal_of(spec("\"rk4\"", "", "name = \"henon_heiles\"\n"), catalog),
              HasSubstr("expected \"linear_chain\" or a scene"));
  EXPECT_THAT(refusal_of(spec("\"rk4\"", "mass = 99\n"), catalog), HasSubstr("expected an index below 61"));
  EXPECT_THAT(refusal_of(spec("\"rk4\"", "direction = [0, 0, 0]\n"), catalog),
              HasSubstr("expected a direction"));
  EXPECT_THAT(refusal_of(spec("\"sundials:cvode_bdf\""), catalog), HasSubstr("fixed step"));
  const std::string long_chain = "name = \"linear_chain\"\nparameters = { count = 1001 }\n";
  EXPECT_THAT(refusal_of(spec("\"rk4\"", "duration = 3600.0\n", long_chain), catalog),
              HasSubstr("duration: found 60001 states of the 1001 masses"));
}

}  // namespace
}  // namespace fw::study
