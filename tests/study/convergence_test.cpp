#include "study/kinds/convergence.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "catalog/builtin_catalog.hpp"
#include "catalog/study_kinds.hpp"
#include "core/error.hpp"
#include "memory_archive.hpp"
#include "paths.hpp"
#include "seeded_catalog.hpp"
#include "seeded_schemes.hpp"
#include "study/runner.hpp"

namespace fw::study {
namespace {

using ::testing::HasSubstr;

Vector force(const SecondOrderSystem& system, double t, const Vector& q, const Vector& v) {
  Vector f(q.size());
  system.force(t, q, v, f);
  return f;
}

/// Schemes that are wrong in the ways that other projects shipped.
Seeds seeded_bugs() {
  Seeds seeds;
  const auto add = [&](const std::string& name, int claimed, SeededStepper::Step step) {
    seeds[name] = [name, claimed, step] { return seeded_scheme(name, claimed, step); };
  };
  add("missing_inverse_mass", 1, [](auto& s, double t, double h, VectorRef q, VectorRef v, Vector&) {
    v += h * force(s, t, q, v);
    q += h * v;
  });
  add("stale_force", 2, [](auto& s, double t, double h, VectorRef q, VectorRef v, Vector& old) {
    // Velocity Verlet that reuses the force of the step before the last one.
    if (old.size() == 0) old = force(s, t, q, v);
    const Vector a = old.cwiseQuotient(s.mass());
    q += h * v + 0.5 * h * h * a;
    old = force(s, t, q - h * v, v);
    v += 0.5 * h * (a + old.cwiseQuotient(s.mass()));
  });
  add("damper_at_the_half_step", 2, [](auto& s, double t, double h, VectorRef q, VectorRef v, Vector&) {
    const Vector half = v + 0.5 * h * force(s, t, q, v).cwiseQuotient(s.mass());
    q += h * half;
    v = half + 0.5 * h * force(s, t + h, q, half).cwiseQuotient(s.mass());
  });
  add("swapped_weights_rk4", 4, [](auto& s, double t, double h, VectorRef q, VectorRef v, Vector&) {
    const auto a = [&](double dt, const Vector& x, const Vector& w) -> Vector {
      return force(s, t + dt, x, w).cwiseQuotient(s.mass());
    };
    const Vector k1 = v, l1 = a(0.0, q, v);
    const Vector k2 = v + 0.5 * h * l1, l2 = a(0.5 * h, q + 0.5 * h * k1, k2);
    const Vector k3 = v + 0.5 * h * l2, l3 = a(0.5 * h, q + 0.5 * h * k2, k3);
    const Vector k4 = v + h * l3, l4 = a(h, q + h * k3, k4);
    q += h / 6.0 * (2.0 * k1 + k2 + k3 + 2.0 * k4);
    v += h / 6.0 * (2.0 * l1 + l2 + l3 + 2.0 * l4);
  });
  add("wrong_time_of_the_last_stage", 4, [](auto& s, double t, double h, VectorRef q, VectorRef v, Vector&) {
    const auto a = [&](double dt, const Vector& x, const Vector& w) -> Vector {
      return force(s, t + dt, x, w).cwiseQuotient(s.mass());
    };
    const Vector k1 = v, l1 = a(0.0, q, v);
    const Vector k2 = v + 0.5 * h * l1, l2 = a(0.5 * h, q + 0.5 * h * k1, k2);
    const Vector k3 = v + 0.5 * h * l2, l3 = a(0.5 * h, q + 0.5 * h * k2, k3);
    const Vector k4 = v + h * l3, l4 = a(0.5 * h, q + h * k3, k4);
    q += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    v += h / 6.0 * (l1 + 2.0 * l2 + 2.0 * l3 + l4);
  });
  add("order_claimed_too_low", 1, [](auto& s, double t, double h, VectorRef q, VectorRef v, Vector&) {
    const Vector qm = q + 0.5 * h * v, vm = v + 0.5 * h * force(s, t, q, v).cwiseQuotient(s.mass());
    q += h * vm;
    v += h * force(s, t + 0.5 * h, qm, vm).cwiseQuotient(s.mass());
  });
  add("verlet_first_step_without_half", 2,
      [](auto& s, double t, double h, VectorRef q, VectorRef v, Vector& d) {
        const Vector a = force(s, t, q, v).cwiseQuotient(s.mass());
        if (d.size() == 0) {
          d = h * v + h * h * a;  // ½ forgotten: x₁ = x₀ + h v₀ + h² f₀/m
        } else {
          d += h * h * a;
        }
        q += d;
        v = d / h;
      });
  add("frozen_velocity", 1, [](auto& s, double t, double h, VectorRef q, VectorRef v, Vector&) {
    q += h * v;
    v += h * (1.0 + 1e-3) * force(s, t, q, v).cwiseQuotient(s.mass());  // a weight that is off by a permille
  });
  return seeds;
}

std::string convergence_spec(const std::string& methods, const std::string& problem) {
  return "kind = \"convergence\"\ntitle = \"test\"\nmethods = [" + methods +
         "]\n[convergence]\nlevels = 8\nstart_error = 0.003\n[[problem]]\n" + problem;
}

StudyResult run_text(const std::string& text, const Catalog& catalog) {
  const Plan plan = read_plan(
      CheckedTable::parse_text(text, fw::test::source_directory() + "/studies/convergence/test.toml"),
      catalog::study_kinds(), catalog, false);
  MemoryArchive archive;
  return run_plan(plan, archive, {});
}

const std::string duffing = "name = \"driven_duffing\"\nt_end = 5.3\n";

// One or two schemes of each engine; tests/conformance measures all of them.
TEST(Convergence, HoldsForSchemesOfEveryFamilyOnADrivenDuffingOscillator) {
  std::string methods;
  for (const char* name : {"explicit_euler",
                           "midpoint",
                           "heun",
                           "rk4",
                           "bogacki_shampine_32",
                           "symplectic_euler",
                           "verlet",
                           "verlet_backward_velocity",
                           "velocity_verlet",
                           "forest_ruth",
                           "implicit_euler",
                           "implicit_euler_linearised",
                           "implicit_midpoint",
                           "trapezoidal",
                           "sdirk3",
                           "gauss2",
                           "ros3p",
                           "bdf2",
                           "adams_bashforth3",
                           "newmark",
                           "generalised_alpha",
                           "average_vector_field"}) {
    methods += (methods.empty() ? "\"" : ", \"") + std::string(name) + "\"";
  }
  const StudyResult result = run_text(convergence_spec(methods, duffing), SeededCatalog({}));
  EXPECT_GE(result.cases.size(), 10u);
  for (const CaseResult& entry : result.cases)
    EXPECT_EQ(entry.verdict, Verdict::holds) << entry.id << ": " << entry.reason;
}

TEST(Convergence, CatchesEverySeededBug) {
  const Seeds seeds = seeded_bugs();
  for (const auto& [name, make] : seeds) {
    const StudyResult result = run_text(convergence_spec("\"" + name + "\"", duffing), SeededCatalog(seeds));
    ASSERT_EQ(result.cases.size(), 1u);
    EXPECT_EQ(result.cases.front().verdict, Verdict::fails) << name << ": " << result.cases.front().reason;
  }
}

TEST(Convergence, HoldsForTheSameSchemesWithoutTheBug) {
  // Positive control: the test doubles are caught for their bugs, not for being test doubles.
  Seeds seeds;
  seeds["sound_midpoint"] = [] {
    return seeded_scheme(
        "sound_midpoint", 2, [](auto& s, double t, double h, VectorRef q, VectorRef v, Vector&) {
          const Vector qm = q + 0.5 * h * v, vm = v + 0.5 * h * force(s, t, q, v).cwiseQuotient(s.mass());
          q += h * vm;
          v += h * force(s, t + 0.5 * h, qm, vm).cwiseQuotient(s.mass());
        });
  };
  const StudyResult result = run_text(convergence_spec("\"sound_midpoint\"", duffing), SeededCatalog(seeds));
  EXPECT_EQ(result.cases.front().verdict, Verdict::holds) << result.cases.front().reason;
}

/// A scene in a file of its own, as a problem.
CaseResult order_on(const std::string& method, const std::string& scene, double end,
                    const std::string& keys = "") {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / fmt::format("federwerk_convergence_{}.toml", ::getpid());
  std::ofstream(path) << scene;
  const StudyResult result =
      run_text("kind = \"convergence\"\ntitle = \"test\"\nmethods = [\"" + method +
                   "\"]\n[convergence]\nlevels = 7\n" + keys + "[[problem]]\nscene = \"" + path.string() +
                   fmt::format("\"\nt_end = {}\n", end),
               SeededCatalog({}));
  std::filesystem::remove(path);
  return result.cases.front();
}

TEST(Convergence, IsNotApplicableWhereNothingCanBeMeasured) {
  const std::string fall =
      "[world]\ngravity = [0, 0, -9.81]\n[particles]\nposition = [[0, 0, 1]]\nmass = 1.0\n";
  const CaseResult exact = order_on("velocity_verlet", fall, 1.0);
  EXPECT_EQ(exact.verdict, Verdict::not_applicable) << exact.reason;
  EXPECT_THAT(exact.reason, HasSubstr("exact on this problem"));
  // Of symplectic Euler the velocities are exact in free fall, and the positions show its order.
  const CaseResult half = order_on("symplectic_euler", fall, 1.0);
  EXPECT_EQ(half.verdict, Verdict::holds) << half.reason;
  EXPECT_THAT(half.reason, HasSubstr("velocity: exact on this problem"));
  const std::string spring =
      "[particles]\nposition = [[0, 0, 0], [1.3, 0, 0]]\nmass = 1.0\nfixed = [0]\n"
      "[springs]\nbetween = [[0, 1]]\nrest_length = 1.0\nstiffness = 1.0\n";
  const CaseResult overdamped = order_on("rk4", spring + "damping = 1e4\n", 1.0, "max_steps = 4096\n");
  EXPECT_EQ(overdamped.verdict, Verdict::not_applicable) << overdamped.reason;
  EXPECT_EQ(order_on("explicit_euler", spring, 4.0, "max_steps = 100\nstart_error = 1e-6\n").verdict,
            Verdict::not_applicable);
  const CaseResult kinks = order_on(
      "rk4",
      spring +
          "[[obstacle]]\nshape = \"plane\"\npoint = [1.1, 0, 0]\nnormal = [1, 0, 0]\nstiffness = 500.0\n",
      4.0);
  EXPECT_EQ(kinks.verdict, Verdict::not_applicable) << kinks.reason;
}

TEST(Convergence, OfOneHalfAboveTheClaimLeavesTheVerdictToTheOther) {
  // From rest, symplectic Euler's velocities have order 2: J (0, a(x0)) = (v, a)(T) along the flow.
  const std::string pendulum =
      "[world]\ngravity = [0, 0, -9.81]\n[particles]\nposition = [[0, 0, 0], [1.1, 0, 0.2]]\nmass = "
      "0.7\nfixed = "
      "[0]\n[springs]\nbetween = [[0, 1]]\nrest_length = 1.0\nstiffness = 90.0\n";
  const CaseResult result = order_on("symplectic_euler", pendulum, 0.7);
  EXPECT_EQ(result.verdict, Verdict::holds) << result.reason;
  EXPECT_THAT(result.reason, HasSubstr("terms of the error of the velocity vanish"));
}

TEST(Convergence, SaysNotApplicableForAMechanicalSchemeOnAFirstOrderEquation) {
  const StudyResult result = run_text(
      convergence_spec("\"velocity_verlet\"", "name = \"rotation\"\nt_end = 2.3\n"), SeededCatalog({}));
  EXPECT_EQ(result.cases.front().verdict, Verdict::not_applicable);
  EXPECT_NE(result.cases.front().reason.find("M q''"), std::string::npos);
}

}  // namespace
}  // namespace fw::study
