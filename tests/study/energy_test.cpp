#include "study/energy/energy.hpp"

#include <fmt/format.h>
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

std::string spec(const std::string& methods, const std::string& keys, const std::string& problem) {
  return "kind = \"energy\"\ntitle = \"test\"\nmethods = [" + methods + "]\n[energy]\nbins = 40\n" + keys +
         "[[problem]]\n" + problem;
}

const std::string oscillator = "name = \"harmonic_oscillator\"\n";
const std::string chain = "name = \"linear_chain\"\n";
const std::string henon_heiles = "name = \"henon_heiles\"\n";
const std::string damped = "scene = \"../scenes/damped_network.toml\"\nt_end = 0.8\n";
const std::string free_network = "scene = \"../scenes/free_network.toml\"\nt_end = 10.0\n";

TEST(Energy, OfASingleSpringGrowsAsTheStabilityFunctionSays) {
  const StudyResult result = run_study(
      spec("\"explicit_euler\", \"midpoint\", \"rk4\", \"implicit_euler\", \"bdf2\", \"trapezoidal\", "
           "\"newmark[beta=0.3,gamma=0.6]\", \"symplectic_euler\"",
           "steps = [0.1, 0.03]\nstep_count = 4000\n", oscillator),
      SeededCatalog({}));
  for (const CaseResult& entry : result.cases)
    EXPECT_EQ(entry.verdict, Verdict::holds) << entry.id << ": " << entry.reason;
  const double z = 0.1 * std::sqrt(3.5);
  EXPECT_NEAR(figure(result.cases[0], "growth"), std::sqrt(1.0 + z * z) - 1.0, 1e-10);
  EXPECT_NEAR(figure(result.cases[2], "growth"),
              std::sqrt(1.0 - std::pow(z, 6) / 72.0 + std::pow(z, 8) / 576.0) - 1.0, 1e-13);
}

TEST(Energy, OfALinearChainIsModifiedAndKeptToRounding) {
  const StudyResult result = run_study(spec("\"velocity_verlet\", \"verlet\", \"symplectic_euler\"",
                                            "steps = [0.02, 0.01]\nstep_count = 20000\n", chain),
                                       SeededCatalog({}));
  for (const CaseResult& entry : result.cases) {
    EXPECT_EQ(entry.verdict, Verdict::holds) << entry.id << ": " << entry.reason;
    EXPECT_LT(figure(entry, "modified_change"), 1e-12);
    EXPECT_GT(figure(entry, "relative_oscillation"), 1e-4) << "the energy itself is not kept";
  }
  EXPECT_NEAR(figure(result.cases[0], "oscillation_exponent"), 2.0, 0.2);
  EXPECT_NEAR(figure(result.cases[2], "oscillation_exponent"), 1.0, 0.2);
}

TEST(Energy, DriftsForOtherSchemesOnly) {
  const StudyResult result =
      run_study(spec("\"velocity_verlet\", \"forest_ruth\", \"rk4\"",
                     "steps = [0.3, 0.2, 0.15, 0.1]\nstep_count = 20000\n", henon_heiles),
                SeededCatalog({}));
  for (const CaseResult& entry : result.cases)
    EXPECT_EQ(entry.verdict, Verdict::holds) << entry.id << ": " << entry.reason;
  EXPECT_LT(figure(result.cases[0], "drift_over_oscillation"), 0.1);
  EXPECT_GT(figure(result.cases[2], "drift_over_oscillation"), 1.0);
  EXPECT_NEAR(figure(result.cases[2], "drift_exponent"), 5.0, 0.3);
}

TEST(Energy, ThatIsLostIsTheWorkOfTheDampers) {
  const StudyResult result =
      run_study(spec("\"explicit_euler\", \"heun\", \"rk4\", \"velocity_verlet\", \"implicit_midpoint\"",
                     "steps = [0.004, 0.002, 0.001, 0.0005]\n", damped),
                SeededCatalog({}));
  const double expected[] = {1.0, 2.0, 4.0, 2.0, 2.0};
  for (std::size_t k = 0; k < result.cases.size(); ++k) {
    const CaseResult& entry = result.cases[k];
    EXPECT_EQ(entry.verdict, Verdict::holds) << entry.id << ": " << entry.reason;
    EXPECT_GE(figure(entry, "balance_exponent"), expected[k] - 0.2) << entry.id;
    EXPECT_LT(std::abs(figure(entry, "balance")), k == 0 ? 0.3 : 0.02) << entry.id;
    EXPECT_GT(std::abs(figure(entry, "balance")), 1e-12) << entry.id;
  }
}

TEST(Energy, MomentaOfAFreeNetworkChangeByRoundingOnly) {
  const StudyResult result = run_study(spec("\"velocity_verlet\", \"rk4\", \"implicit_midpoint\"",
                                            "steps = [0.01]\nstep_count = 30000\n", free_network),
                                       SeededCatalog({}));
  for (const CaseResult& entry : result.cases) {
    EXPECT_EQ(entry.verdict, Verdict::holds) << entry.id << ": " << entry.reason;
    EXPECT_LT(figure(entry, "momentum_change"), 1e-12) << entry.id;
  }
  EXPECT_LT(figure(result.cases[0], "angular_momentum_change"), 1e-12);
  EXPECT_GT(figure(result.cases[1], "angular_momentum_change"), 1e-10) << "Runge-Kutta 4 does not keep it";
}

Vector acceleration(const SecondOrderSystem& system, double t, const Vector& q, const Vector& v) {
  Vector f(q.size());
  system.force(t, q, v, f);
  return f.cwiseQuotient(system.mass());
}

/// Schemes that claim to be what they are not.
Seeds seeded_bugs() {
  Seeds seeds;
  seeds["lossy_verlet"] = [] {
    auto scheme = seeded_scheme("velocity_verlet", 2,
                                [](auto& s, double t, double h, VectorRef q, VectorRef v, Vector&) {
                                  v += 0.5 * h * acceleration(s, t, q, v);
                                  q += h * v;
                                  v += 0.5 * h * acceleration(s, t + h, q, v);
                                  v *= 1.0 - 1e-9;  // friction in the last digits
                                });
    return scheme;
  };
  seeds["one_sided_spring"] = [] {
    return seeded_scheme("one_sided_spring", 1,
                         [](auto& s, double t, double h, VectorRef q, VectorRef v, Vector&) {
                           Vector a = acceleration(s, t, q, v);
                           a[0] *= 1.0 + 1e-9;  // action is not reaction
                           v += h * a;
                           q += h * v;
                         });
  };
  seeds["damper_at_the_old_velocity"] = [] {
    return seeded_scheme("damper_at_the_old_velocity", 2,
                         [](auto& s, double t, double h, VectorRef q, VectorRef v, Vector&) {
                           const Vector old = v;
                           v += 0.5 * h * acceleration(s, t, q, old);
                           q += h * v;
                           v += 0.5 * h * acceleration(s, t + h, q, old);
                         });
  };
  return seeds;
}

TEST(Energy, CatchesFrictionInTheLastDigits) {
  const SeededCatalog catalog(seeded_bugs(), {{"lossy_verlet", "velocity_verlet"}});
  for (const std::string& problem : {oscillator, chain}) {
    const StudyResult result =
        run_study(spec("\"lossy_verlet\"", "steps = [0.1]\nstep_count = 20000\n", problem), catalog);
    EXPECT_EQ(result.cases.front().verdict, Verdict::fails) << result.cases.front().reason;
    EXPECT_THAT(result.cases.front().reason, HasSubstr("FAILS: modified energy"));
  }
}

TEST(Energy, CatchesTheGrowthOfAnotherScheme) {
  const SeededCatalog catalog(seeded_bugs(), {{"one_sided_spring", "explicit_euler"}});
  const StudyResult result =
      run_study(spec("\"one_sided_spring\"", "steps = [0.1]\nstep_count = 2000\n", oscillator), catalog);
  EXPECT_EQ(result.cases.front().verdict, Verdict::fails) << result.cases.front().reason;
  EXPECT_THAT(result.cases.front().reason, HasSubstr("FAILS: amplitude grows"));
}

TEST(Energy, CatchesASpringThatPullsOneEndHarder) {
  const StudyResult result =
      run_study(spec("\"one_sided_spring\"", "steps = [0.01]\n", free_network), SeededCatalog(seeded_bugs()));
  EXPECT_EQ(result.cases.front().verdict, Verdict::fails) << result.cases.front().reason;
  EXPECT_THAT(result.cases.front().reason, HasSubstr("FAILS: linear momentum"));
}

TEST(Energy, CatchesADamperThatLagsBehind) {
  const StudyResult result =
      run_study(spec("\"damper_at_the_old_velocity\"", "steps = [0.002, 0.001, 0.0005]\n", damped),
                SeededCatalog(seeded_bugs()));
  EXPECT_EQ(result.cases.front().verdict, Verdict::fails) << result.cases.front().reason;
  EXPECT_THAT(result.cases.front().reason, HasSubstr("at least h^2 is predicted"));
}

TEST(Energy, RefusesBadInputBeforeAnythingRuns) {
  const SeededCatalog catalog({});
  EXPECT_THAT(refusal_of(spec("\"rk4\"", "steps = [0.1, 0.2]\n", oscillator), catalog),
              HasSubstr("expected less than the step before"));
  EXPECT_THAT(refusal_of(spec("\"rk4\"", "steps = [0.1]\n", "name = \"dahlquist\"\n"), catalog),
              HasSubstr("has neither an energy nor another invariant"));
  EXPECT_THAT(refusal_of(spec("\"gsl:msbdf\"", "steps = [0.1]\n", oscillator), catalog),
              HasSubstr("fixed step"));
  EXPECT_THAT(refusal_of(spec("\"rk4\"", "steps = [0.7]\n", oscillator), catalog), HasSubstr("steps[0]"));
}

TEST(Energy, IsNotHeldAgainstBoundsThatAnExplodingRunSets) {
  const StudyResult result = run_study(
      spec("\"velocity_verlet\"", "steps = [1.1]\nstep_count = 500\n", oscillator), SeededCatalog({}));
  EXPECT_EQ(result.cases.front().verdict, Verdict::not_applicable) << result.cases.front().reason;
  EXPECT_THAT(result.cases.front().reason, HasSubstr("blows up"));
  EXPECT_TRUE(std::isnan(figure(result.cases.front(), "relative_drift")));
}

/// A scene written for one test.
class WrittenScene {
 public:
  explicit WrittenScene(const std::string& text)
      : path_(std::filesystem::temp_directory_path() /
              ("federwerk_energy_" + std::to_string(::getpid()) + "_" + std::to_string(++count_) + ".toml")) {
    std::ofstream(path_) << text;
  }
  ~WrittenScene() { std::filesystem::remove(path_); }
  std::string problem(double end) const {
    return fmt::format("scene = \"{}\"\nt_end = {}\n", path_.string(), end);
  }

 private:
  static inline int count_ = 0;
  std::filesystem::path path_;
};

/// A pendulum on a spring, let go from the horizontal with a total energy of zero where `shift` is.
std::string pendulum(double shift, double k = 1e4, double m = 1.0) {
  return fmt::format(
      "[world]\ngravity = [0, 0, -9.81]\n[particles]\nposition = [[{0}, {0}, {0}], [{1}, {0}, {0}]]\nmass = "
      "{2}\n"
      "fixed = [0]\n[springs]\nbetween = [[0, 1]]\nstiffness = {3}\nrest_length = 1.0\n",
      shift, shift + 1.0, m, k);
}

CaseResult energy_of(const std::string& method, const std::string& scene, const std::string& keys,
                     double end) {
  const WrittenScene written(scene);
  return run_study(spec("\"" + method + "\"", keys, written.problem(end)), SeededCatalog({})).cases.front();
}

TEST(Energy, ThatExplodesFromATotalOfZeroIsNoSuccess) {
  for (const double shift : {0.0, 1e-3, 1.0, 1e3}) {
    for (const char* step : {"0.0205", "0.025", "0.05"}) {
      const CaseResult result = energy_of("velocity_verlet", pendulum(shift),
                                          fmt::format("steps = [{}]\nstep_count = 2000\n", step), 10.0);
      EXPECT_EQ(result.verdict, Verdict::not_applicable) << shift << " " << step << ": " << result.reason;
      EXPECT_THAT(result.reason,
                  testing::AnyOf(HasSubstr("blows up"), HasSubstr("blow_up"), HasSubstr("exceeds")));
    }
  }
}

TEST(Energy, VerdictsDoNotDependOnTheOriginOrOnUnits) {
  for (const std::string method :
       {"velocity_verlet", "symplectic_euler", "rk4", "explicit_euler", "implicit_euler"}) {
    const std::string keys = "steps = [0.004, 0.003, 0.002, 0.0015]\nstep_count = 4000\n";
    const CaseResult plain = energy_of(method, pendulum(0.0), keys, 10.0);
    for (const double shift : {1e-3, -1.0, 1e3}) {
      const CaseResult moved = energy_of(method, pendulum(shift), keys, 10.0);
      EXPECT_EQ(moved.verdict, plain.verdict) << method << " " << shift << ": " << moved.reason << "\n"
                                              << plain.reason;
      EXPECT_NEAR(figure(moved, "relative_oscillation"), figure(plain, "relative_oscillation"),
                  1e-3 * figure(plain, "relative_oscillation") + 1e-9);
    }
    for (const double unit : {1e-6, 1e9}) {
      const CaseResult scaled = energy_of(method, pendulum(0.0, 1e4 * unit, unit), keys, 10.0);
      EXPECT_EQ(scaled.verdict, plain.verdict) << method << " " << unit << ": " << scaled.reason;
    }
  }
}

TEST(Energy, OfFreeFallIsExactOfSchemesOfOrderTwo) {
  for (const double height : {0.0, 7.0, 1e3}) {
    const CaseResult result = energy_of(
        "velocity_verlet",
        fmt::format("[world]\ngravity = [0, 0, -9.81]\n[particles]\nposition = [[0, 0, {}]]\nmass = 1.0\n",
                    height),
        "steps = [0.02, 0.01, 0.005]\nstep_count = 1000\n", 10.0);
    EXPECT_NE(result.verdict, Verdict::fails) << height << ": " << result.reason;
    EXPECT_LT(std::abs(figure(result, "relative_drift")), 1e-12) << height;
    EXPECT_LT(figure(result, "relative_oscillation"), 1e-12) << height;
  }
}

TEST(Energy, ThatIsGoneDoesNotDrift) {
  const CaseResult result =
      energy_of("implicit_euler", pendulum(0.0), "steps = [0.4]\nstep_count = 1000\n", 10.0);
  EXPECT_TRUE(std::isnan(figure(result, "relative_drift"))) << figure(result, "relative_drift");
}

TEST(Energy, OfASymplecticSchemeMayMoveWithASlowMotion) {
  // Free fall under symplectic Euler: the error of the energy is -h/2 m g.v, as one-sided as the fall itself.
  const std::string fall =
      "[world]\ngravity = [0, 0, -9.81]\n[particles]\nposition = [[0, 0, 0]]\nmass = 1.0\n";
  const std::string keys = "steps = [0.02, 0.01, 0.005]\nstep_count = 1000\n";
  const CaseResult falling = energy_of("symplectic_euler", fall, keys, 10.0);
  EXPECT_EQ(falling.verdict, Verdict::not_applicable) << falling.reason;
  EXPECT_THAT(falling.reason, HasSubstr("more steps tell"));
  // A pendulum seen for a quarter of its swing, its spring for thousands of periods.
  const CaseResult quarter =
      energy_of("velocity_verlet", pendulum(0.0), "steps = [0.0004]\nstep_count = 1000\n", 10.0);
  EXPECT_NE(quarter.verdict, Verdict::fails) << quarter.reason;
}

TEST(Energy, CatchesASecularDriftThatLasts) {
  Seeds seeds;
  seeds["lossy"] = [] {
    return seeded_scheme(
        {.name = "lossy", .order = 2, .is_symplectic = true, .needs = {Capability::second_order}},
        [](auto& s, double t, double h, VectorRef q, VectorRef v, Vector&) {
          v += 0.5 * h * acceleration(s, t, q, v);
          q += h * v;
          v += 0.5 * h * acceleration(s, t + h, q, v);
          v *= 1.0 - 1e-6;
        });
  };
  const CaseResult result =
      run_study(spec("\"lossy\"", "steps = [0.2, 0.1]\nstep_count = 20000\n", henon_heiles),
                SeededCatalog(seeds, {{"lossy", "velocity_verlet"}}))
          .cases.front();
  EXPECT_EQ(result.verdict, Verdict::fails) << result.reason;
  EXPECT_THAT(result.reason, HasSubstr("FAILS: no secular drift"));
}

/// A mass that hits a soft plane with a damper.
const std::string impact =
    "[particles]\nposition = [[0, 0, 1]]\nvelocity = [[0, 0, -2]]\nmass = 0.5\n[[obstacle]]\nshape = "
    "\"plane\"\n"
    "point = [0, 0, 0.5]\nnormal = [0, 0, 1]\nstiffness = 200.0\ndamping = 4.0\n";

TEST(Energy, LawsAreJudgedByTheirInterval) {
  // The kink at contact leaves an exponent whose interval decides nothing; two steps make no law.
  for (const char* steps :
       {"[0.0008, 0.0004, 0.0002, 0.0001]", "[0.0008, 0.0004]", "[0.0016, 0.0008, 0.0004]"}) {
    const CaseResult result = energy_of("trapezoidal", impact, fmt::format("steps = {}\n", steps), 0.4);
    EXPECT_EQ(result.verdict, Verdict::not_applicable) << steps << ": " << result.reason;
  }
  const auto of_network = [](const char* steps) {
    return run_study(spec("\"heun\"", fmt::format("steps = {}\n", steps), damped), SeededCatalog({}))
        .cases.front();
  };
  const CaseResult smooth = of_network("[0.004, 0.002, 0.001, 0.0005]");
  EXPECT_EQ(smooth.verdict, Verdict::holds) << smooth.reason;
  EXPECT_GE(figure(smooth, "balance_exponent_low"), 1.7);
  const CaseResult two = of_network("[0.002, 0.001]");
  EXPECT_EQ(two.verdict, Verdict::not_applicable) << two.reason;
  EXPECT_THAT(two.reason, HasSubstr("it takes three steps"));
}

TEST(Energy, HasNoSecularDriftToJudgeInAFewSteps) {
  const StudyResult result = run_study(
      spec("\"velocity_verlet\"", "steps = [0.1]\nstep_count = 3\n", henon_heiles), SeededCatalog({}));
  EXPECT_EQ(result.cases.front().verdict, Verdict::not_applicable) << result.cases.front().reason;
}

}  // namespace
}  // namespace fw::study
