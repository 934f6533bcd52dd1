#include "study/kinds/dissipation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "seeded_catalog.hpp"
#include "seeded_schemes.hpp"
#include "study_of_text.hpp"

namespace fw::study {
namespace {

using testing::HasSubstr;

std::string spec(const std::string& methods, const std::string& keys = "") {
  return "kind = \"dissipation\"\ntitle = \"test\"\nmethods = [" + methods +
         "]\n[dissipation]\nfrom = 0.05\nto = 10.0\ncount = 17\n" + keys;
}

TEST(Dissipation, MeasuresWhatTheCoefficientsSayForEveryFamily) {
  const StudyResult result = run_study(spec("\"explicit_euler\", \"rk4\", \"velocity_verlet\", \"verlet\", "
                                            "\"forest_ruth\", \"nystrom4\", \"implicit_euler\", "
                                            "\"implicit_euler_linearised[linear_solver=lu]\", "
                                            "\"trapezoidal\", \"sdirk2\", \"radau_iia2\", \"ros3p\", "
                                            "\"bdf2\", \"bdf4\", \"adams_bashforth3\", "
                                            "\"newmark[beta=0.3,gamma=0.6]\", \"hht_alpha[alpha=-0.2]\", "
                                            "\"generalised_alpha[rho_infinity=0.4]\", "
                                            "\"average_vector_field\", \"gautschi\", \"rkc2[stages=6]\""),
                                       SeededCatalog({}));
  for (const CaseResult& entry : result.cases) {
    EXPECT_EQ(entry.verdict, Verdict::holds) << entry.id << ": " << entry.reason;
    EXPECT_GE(figure<std::int64_t>(entry, "compared"), 4) << entry.id << ": " << entry.reason;
  }
}

TEST(Dissipation, KnowsTheDampingOfImplicitEulerInClosedForm) {
  const StudyResult result =
      run_study(spec("\"implicit_euler\"", "shown_steps_per_period = 20\n"), SeededCatalog({}));
  const double z = 2.0 * std::numbers::pi / 20.0;
  const CaseResult& entry = result.cases.front();
  EXPECT_NEAR(figure(entry, "damping_ratio"), 0.5 * std::log1p(z * z) / std::atan(z), 1e-12);
  EXPECT_NEAR(figure(entry, "period_error"), z / std::atan(z) - 1.0, 1e-12);
  EXPECT_EQ(figure(entry, "radius_at_infinity"), 0.0);
  EXPECT_LT(figure(entry, "measured_radius_at_infinity"), 1e-4);
  // Along the motion kept: 20 steps are a period of the exact solution.
  const auto& q = column(entry, "motion_position");
  const auto& exact = column(entry, "motion_exact");
  EXPECT_EQ(q.size(), 101u);
  EXPECT_NEAR(exact[20], exact[0], 1e-12);
  EXPECT_LT(std::abs(q[20]), 0.5 * std::abs(q[0]));
}

TEST(Dissipation, MeasuresForeignSolversWithoutAPrediction) {
  const StudyResult result = run_study(spec("\"petsc:ts_rk[type=2a]\""), SeededCatalog({}));
  const CaseResult& entry = result.cases.front();
  EXPECT_EQ(entry.verdict, Verdict::not_applicable) << entry.reason;
  EXPECT_THAT(entry.reason, HasSubstr("no coefficients to predict from"));
}

TEST(Dissipation, PredictsForeignSolversWhoseTableIsKnown) {
  const StudyResult result = run_study(spec("\"gsl:rk4\""), SeededCatalog({}));
  const CaseResult& entry = result.cases.front();
  EXPECT_EQ(entry.verdict, Verdict::holds) << entry.reason;
  // Two half steps of the classical scheme: 2 (z/2)⁶/144 per step.
  const double z = 2.0 * std::numbers::pi / 20.0;
  EXPECT_NEAR(figure(entry, "damping_ratio") / (std::pow(z, 5) / 144.0 / 32.0), 1.0, 0.1);
}

/// Verlet with a force that is a permille too weak: nothing else would be seen in a picture.
Seeds seeded_bugs() {
  Seeds seeds;
  const auto add = [&](const std::string& name, double weight, double damping) {
    seeds[name] = [=] {
      return seeded_scheme(name, 2, [=](auto& s, double t, double h, VectorRef q, VectorRef v, Vector&) {
        Vector f(q.size());
        s.force(t, q, v, f);
        v += 0.5 * h * weight * f.cwiseQuotient(s.mass());
        q += h * v;
        s.force(t + h, q, v, f);
        v += 0.5 * h * weight * f.cwiseQuotient(s.mass());
        v *= 1.0 - damping;
      });
    };
  };
  add("sound_verlet", 1.0, 0.0);
  add("weak_force", 0.999999, 0.0);
  add("lossy", 1.0, 1e-7);
  return seeds;
}

TEST(Dissipation, CatchesAForceThatIsAMillionthOffAndALossOfATenMillionth) {
  const SeededCatalog catalog(
      seeded_bugs(),
      {{"sound_verlet", "velocity_verlet"}, {"weak_force", "velocity_verlet"}, {"lossy", "velocity_verlet"}});
  const StudyResult result = run_study(spec("\"sound_verlet\", \"weak_force\", \"lossy\""), catalog);
  EXPECT_EQ(result.cases[0].verdict, Verdict::holds) << result.cases[0].reason;
  EXPECT_EQ(result.cases[1].verdict, Verdict::fails) << result.cases[1].reason;
  EXPECT_EQ(result.cases[2].verdict, Verdict::fails) << result.cases[2].reason;
}

TEST(Dissipation, CatchesTheTheoryOfAnotherScheme) {
  Seeds seeds = seeded_bugs();
  const SeededCatalog catalog(std::move(seeds), {{"sound_verlet", "symplectic_euler"}});
  EXPECT_EQ(run_study(spec("\"sound_verlet\""), catalog).cases.front().verdict, Verdict::holds)
      << "velocity Verlet and symplectic Euler are conjugate: the same factors";
  const SeededCatalog wrong(seeded_bugs(), {{"sound_verlet", "trapezoidal"}});
  EXPECT_EQ(run_study(spec("\"sound_verlet\""), wrong).cases.front().verdict, Verdict::fails);
}

TEST(Dissipation, RefusesBadInputBeforeAnythingRuns) {
  const SeededCatalog catalog({});
  EXPECT_THAT(refusal_of(spec("\"sundials:cvode_bdf\""), catalog),
              HasSubstr("expected a method with a fixed step"));
  EXPECT_THAT(refusal_of(spec("\"xpbd\""), catalog), HasSubstr("on a single spring"));
  EXPECT_THAT(refusal_of(spec("\"rk4\"", "shown_steps_per_period = 1e6\nshown_periods = 100\n"), catalog),
              HasSubstr("expected at most 100000 steps in all"));
  EXPECT_THAT(refusal_of(spec("\"rk4\"", "periods = 1e6\n"), catalog), HasSubstr("steps in a window"));
  EXPECT_THAT(refusal_of(spec("\"rk4\"", "shown_steps_per_period = 1e9\nshown_periods = 1e-5\n"), catalog),
              HasSubstr("steps in a window"));
  EXPECT_THAT(refusal_of(spec("\"rk4\"", "counts = 2\n"), catalog), HasSubstr("did you mean \"count\""));
  EXPECT_THAT(
      refusal_of(
          "kind = \"dissipation\"\ntitle = \"t\"\nmethods = [\"rk4\"]\n[dissipation]\nfrom = 3.0\nto = 2.0\n",
          catalog),
      HasSubstr("expected more than from"));
}

}  // namespace
}  // namespace fw::study
