#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "catalog/builtin_catalog.hpp"
#include "catalog/study_kinds.hpp"
#include "conformance/altered_system.hpp"
#include "core/error.hpp"
#include "mechanics/mass_spring_system.hpp"
#include "memory_archive.hpp"
#include "study/jacobian/jacobian.hpp"
#include "study/jacobian/printed_stiffness.hpp"
#include "study/runner.hpp"

namespace fw::study {
namespace {

using conformance::Alteration;
using conformance::AlteredSystem;
using testing::HasSubstr;

/// The built-in catalogue, whose problems answer wrongly.
class WrongProblems final : public Catalog {
 public:
  explicit WrongProblems(Alteration alteration) : alteration_(std::move(alteration)) {}
  std::unique_ptr<Integrator> method(const std::string& call) const override { return builtin_.method(call); }
  analysis::Theory theory(const std::string& call) const override { return builtin_.theory(call); }
  std::vector<std::string> method_names() const override { return builtin_.method_names(); }
  Problem problem(const std::string& name, const ProblemParameters& parameters) const override {
    Problem problem = builtin_.problem(name, parameters);
    problem.ivp.system = std::make_shared<AlteredSystem>(problem.ivp.system, alteration_);
    return problem;
  }

 private:
  catalog::BuiltinCatalog builtin_;
  Alteration alteration_;
};

std::map<std::string, CaseResult> run(const std::string& sections, const Catalog& catalog,
                                      bool quick = false) {
  const std::string text = "kind = \"jacobian\"\ntitle = \"test\"\nseed = 7\n" + sections;
  const Plan plan =
      read_plan(CheckedTable::parse_text(text, "jacobian.toml"), catalog::study_kinds(), catalog, quick);
  MemoryArchive archive;
  std::map<std::string, CaseResult> cases;
  for (CaseResult& result : run_plan(plan, archive, {}).cases) cases[result.id] = std::move(result);
  return cases;
}

std::map<std::string, CaseResult> run(const std::string& sections) {
  return run(sections, catalog::BuiltinCatalog());
}

double figure(const CaseResult& result, const std::string& name) {
  for (const SummaryCell& cell : result.summary) {
    if (cell.name == name) return std::get<double>(cell.value);
  }
  throw std::logic_error("no figure " + name);
}

const std::string cloth = "[[problem]]\nname = \"small_cloth\"\nparameters = { count = 3, gravity = 0 }\n";
const std::string undamped_cloth =
    "[[problem]]\nname = \"small_cloth\"\nparameters = { count = 3, gravity = 0, damping = 0 }\n";
const std::string grid = "compressions = [0.5, 0.8, 1.3]\nsteps = { from = 1e-3, to = 0.5, count = 6 }\n";

TEST(JacobianStudy, FindsTheAnalyticTangentsExactAndThePrintedOnesAsWrongAsTheirMistakes) {
  const auto cases = run("[springs]\nsamples = 50\n");
  ASSERT_EQ(cases.size(), 6u * 3u + 2u);
  for (const auto& [id, result] : cases) EXPECT_EQ(result.verdict, Verdict::holds) << id << result.reason;
  EXPECT_LE(figure(cases.at("hooke-analytic"), "deviation"), 1e-14);
  EXPECT_GE(figure(cases.at("hooke-printed_e1"), "least_deviation"), 0.1);
  EXPECT_NEAR(figure(cases.at("hooke-printed_e2"), "least_deviation"), 2.0, 1e-12);
}

TEST(JacobianStudy, FindsTheSlopesOfTheVCurve) {
  const auto cases = run("[derivatives]\nformulas = [\"forward\", \"central\"]\nsamples = 3\n" + cloth);
  for (const auto& [formula, order] : {std::pair{"forward", 1.0}, {"central", 2.0}}) {
    const CaseResult& result = cases.at(std::string("small_cloth-") + formula);
    EXPECT_EQ(result.verdict, Verdict::holds) << result.reason;
    EXPECT_NEAR(figure(result, "truncation_slope"), order, 0.05);
    EXPECT_NEAR(figure(result, "rounding_slope"), -1.0, 0.1);
  }
}

TEST(JacobianStudy, SeesAWrongTangent) {
  const WrongProblems catalog({.stiffness = [](const SecondOrderSystem&, ConstVectorRef, SparseMatrix& K) {
    K.coeffs() *= 1.0 + 1e-10;
  }});
  const auto cases = run("[derivatives]\nformulas = [\"analytic\", \"forward\"]\n" + cloth, catalog);
  EXPECT_EQ(cases.at("small_cloth-analytic").verdict, Verdict::fails);
  EXPECT_EQ(cases.at("small_cloth-forward").verdict, Verdict::holds) << "it does not look at the matrix";
}

TEST(JacobianStudy, SeesAForceWhoseErrorIsNoLongerSmooth) {
  const WrongProblems catalog(
      {.force = [](const SecondOrderSystem&, ConstVectorRef q, ConstVectorRef, VectorRef f) {
        for (Index c = 0; c < f.size(); ++c) f[c] *= 1.0 + 1e-6 * std::sin(1e6 * q[c]);
      }});
  const auto cases = run("[derivatives]\nformulas = [\"forward\", \"central\"]\n" + cloth, catalog);
  EXPECT_EQ(cases.at("small_cloth-forward").verdict, Verdict::fails);
  EXPECT_EQ(cases.at("small_cloth-central").verdict, Verdict::fails);
}

TEST(JacobianStudy, SaysWhereALinearForceHasNoTruncationError) {
  const auto cases =
      run("[derivatives]\nformulas = [\"forward\"]\n[[problem]]\nname = \"harmonic_oscillator\"\n");
  EXPECT_EQ(cases.at("harmonic_oscillator-forward").verdict, Verdict::not_applicable);
  EXPECT_THAT(cases.at("harmonic_oscillator-forward").reason, HasSubstr("linear"));
}

TEST(JacobianStudy, CountsNoErrorThatIsNotFinite) {
  const double rest =
      catalog::BuiltinCatalog().problem("small_cloth", {{"count", 3.0}, {"gravity", 0.0}}).ivp.y0[0];
  /// A force that is not a number where a difference has moved the first mass by more than `reach`.
  const auto beyond = [rest](double reach) {
    return WrongProblems(
        {.force = [=](const SecondOrderSystem&, ConstVectorRef q, ConstVectorRef, VectorRef f) {
          if (std::abs(q[0] - rest) > reach) f[0] = std::nan("");
        }});
  };
  const std::string one =
      "[derivatives]\nformulas = [\"central\"]\nsamples = 1\ndisplacement = 0.0\npattern = false\n" + cloth;
  const CaseResult all = run(one, beyond(-1.0)).at("small_cloth-central");
  EXPECT_EQ(all.verdict, Verdict::not_applicable);
  EXPECT_THAT(all.reason, HasSubstr("no error is finite"));
  EXPECT_TRUE(std::isnan(figure(all, "best_deviation")));
  const CaseResult some = run(one, beyond(1e-2)).at("small_cloth-central");
  EXPECT_EQ(some.verdict, Verdict::holds) << some.reason;
}

TEST(JacobianStudy, SeesABlockThatThePatternLacks) {
  /// A pattern without one of the blocks that the force fills.
  class Sparser final : public Catalog {
   public:
    std::unique_ptr<Integrator> method(const std::string& call) const override {
      return builtin_.method(call);
    }
    analysis::Theory theory(const std::string& call) const override { return builtin_.theory(call); }
    std::vector<std::string> method_names() const override { return builtin_.method_names(); }
    Problem problem(const std::string& name, const ProblemParameters& parameters) const override {
      Problem problem = builtin_.problem(name, parameters);
      // The pattern of another network: the force of the cloth, the pattern of a chain.
      mechanics::MassSpringModel chain;
      const auto& springs = dynamic_cast<const mechanics::MassSpringSystem&>(*problem.ivp.system).model();
      chain.mass = springs.mass;
      chain.springs = {{0}, {1}, {1.0}, {0.0}, {1.0}, mechanics::SpringLaw::hooke};
      class Mixed final : public OdeSystem {
       public:
        Mixed(std::shared_ptr<const OdeSystem> system, mechanics::MassSpringModel model)
            : system_(std::move(system)), other_(std::move(model)) {}
        Index size() const override { return system_->size(); }
        void rhs(double t, ConstVectorRef y, VectorRef out) const override { system_->rhs(t, y, out); }
        void rhs(const Float128& t, std::span<const Float128> y, std::span<Float128> out) const override {
          system_->rhs(t, y, out);
        }
        void rhs(double t, std::span<const Complex> y, std::span<Complex> out) const override {
          system_->rhs(t, y, out);
        }
        SparseMatrix jacobian_pattern() const override { return other_.jacobian_pattern(); }
        void jacobian(double t, ConstVectorRef y, SparseMatrix& J) const override {
          other_.jacobian(t, y, J);
        }
        void jacobian_product(double t, ConstVectorRef y, ConstVectorRef w, VectorRef out) const override {
          system_->jacobian_product(t, y, w, out);
        }

       private:
        std::shared_ptr<const OdeSystem> system_;
        mechanics::MassSpringSystem other_;
      };
      problem.ivp.system = std::make_shared<Mixed>(problem.ivp.system, chain);
      return problem;
    }

   private:
    catalog::BuiltinCatalog builtin_;
  };
  const auto right = run("[derivatives]\nformulas = [\"forward\"]\n" + cloth);
  EXPECT_EQ(right.at("small_cloth-pattern").verdict, Verdict::holds);
  const auto wrong = run("[derivatives]\nformulas = [\"forward\"]\n" + cloth, Sparser());
  EXPECT_EQ(wrong.at("small_cloth-pattern").verdict, Verdict::fails);
}

TEST(JacobianStudy, FindsTheStepFromWhichACompressedSystemIsIndefinite) {
  for (const std::string& problem : {undamped_cloth, cloth}) {
    const auto cases = run("[definiteness]\nclosing_rate = 1.0\n" + grid + problem);
    const CaseResult& exact = cases.at("small_cloth-exact");
    EXPECT_EQ(exact.verdict, Verdict::holds) << exact.reason;
    EXPECT_GT(figure(exact, "limit_step"), 1e-3);
    EXPECT_LT(figure(exact, "limit_step"), 0.5);
    EXPECT_GT(figure(exact, "cg_failures"), 0.0);
    const CaseResult& projected = cases.at("small_cloth-psd_projection");
    EXPECT_EQ(projected.verdict, Verdict::holds) << projected.reason;
    EXPECT_TRUE(std::isnan(figure(projected, "limit_step")));
    EXPECT_EQ(figure(projected, "cg_failures"), 0.0);
    EXPECT_EQ(figure(projected, "newton_cg_failures"), figure(projected, "newton_failures"));
  }
}

TEST(JacobianStudy, SeesATangentModelThatDoesNotProject) {
  // The compressed exact K in place of each model: its negative directions are added again.
  const WrongProblems catalog(
      {.stiffness = [](const SecondOrderSystem& system, ConstVectorRef q, SparseMatrix& K) {
        system.stiffness(0.0, q, Vector::Zero(q.size()), TangentModel::exact, K);
      }});
  const auto cases =
      run("[definiteness]\ntangents = [\"exact\", \"psd_projection\"]\n" + grid + undamped_cloth, catalog);
  EXPECT_EQ(cases.at("small_cloth-exact").verdict, Verdict::holds);
  EXPECT_EQ(cases.at("small_cloth-psd_projection").verdict, Verdict::fails);
}

TEST(JacobianStudy, MeasuresTheEnergyThatCompressedRunsGain) {
  const auto cases = run(
      "[runs]\nmethods = [\"implicit_euler_linearised\", \"implicit_euler_linearised[linear_solver=lu]\"]\n"
      "compressions = [0.6]\nsteps = [1e-3, 0.08]\n[[problem]]\nname = \"small_cloth\"\n"
      "parameters = { count = 3, gravity = 0, damping = 0 }\nt_end = 0.8\n");
  const CaseResult& by_cg = cases.at("small_cloth-implicit_euler_linearised-L0.6");
  EXPECT_EQ(figure(by_cg, "failed_runs"), 1.0) << by_cg.reason;
  EXPECT_THAT(by_cg.reason, HasSubstr("matrix_indefinite"));
  const CaseResult& by_lu = cases.at("small_cloth-implicit_euler_linearised[linear_solver=lu]-L0.6");
  EXPECT_EQ(figure(by_lu, "failed_runs"), 0.0) << by_lu.reason;
  EXPECT_EQ(by_lu.verdict, Verdict::not_applicable);
}

TEST(JacobianStudy, RefusesWhatItCannotDo) {
  const catalog::BuiltinCatalog catalog;
  const auto message = [&](const std::string& sections) -> std::string {
    try {
      run(sections, catalog);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_THAT(message(cloth), HasSubstr("found none of [derivatives]"));
  EXPECT_THAT(message("[springs]\nlaws = [\"rubber\"]\n"), HasSubstr("found the string \"rubber\""));
  EXPECT_THAT(message("[definiteness]\n" + grid + "[[problem]]\nname = \"van_der_pol\"\n"),
              HasSubstr("has no springs"));
  EXPECT_THAT(message("[definiteness]\ncompressions = []\nsteps = [0.1]\n" + cloth), HasSubstr("empty list"));
  EXPECT_THAT(message("[runs]\nmethods = [\"verlet\"]\ncompressions = [0.5]\nsteps = [0.1]\n" + cloth),
              HasSubstr("no one-step method"));
  EXPECT_THAT(message("[runs]\nmethods = [\"rk4\"]\ncompressions = [0.5]\nsteps = [0.1, 1e-12]\n" + cloth),
              HasSubstr("expected at most 1 000 000 steps"));
  EXPECT_THAT(message("[springs]\n[derivatives]\nlargest_increment = 1e300\nsmallest_increment = 1e-300\n"),
              HasSubstr("largest_increment: found 1e+300, expected a finite number from 1e-20 to 1000"));
  EXPECT_THAT(message("[springs]\n[derivatives]\nsmallest_increment = 1e-300\n"),
              HasSubstr("smallest_increment: found 1e-300"));
  const std::string large_cloth = "[[problem]]\nname = \"small_cloth\"\nparameters = { count = 15 }\n";
  EXPECT_THAT(message("[definiteness]\n" + grid + large_cloth),
              HasSubstr("has 675 unknowns, expected at most 600"));
}

TEST(JacobianStudy, ThinsListsAndSamplesByItsRule) {
  const auto cases =
      run("[springs]\nlaws = [\"hooke\"]\n[derivatives]\nformulas = [\"analytic\"]\n[definiteness]\n" + grid +
              "[quick]\npoints = 2\nsamples = 3\n" + undamped_cloth,
          catalog::BuiltinCatalog(), true);
  const auto samples = [](const CaseResult& result) {
    for (const SummaryCell& cell : result.summary) {
      if (cell.name == "samples") return std::get<std::int64_t>(cell.value);
    }
    return std::int64_t{-1};
  };
  EXPECT_EQ(samples(cases.at("hooke-analytic")), 3);
  EXPECT_EQ(samples(cases.at("small_cloth-exact")), 4);
}

TEST(PrintedStiffness, OfErratumE1IsOffByThreeTimesTheGeometricTerm) {
  mechanics::MassSpringModel model;
  model.mass = {1.0, 1.0};
  model.springs = {{0}, {1}, {10.0}, {0.0}, {2.0}, mechanics::SpringLaw::hooke};
  const mechanics::MassSpringSystem system(model);
  Vector q = Vector::Zero(6);
  q[3] = 1.0;
  SparseMatrix K = system.tangent_pattern();
  system.stiffness(0.0, q, Vector::Zero(6), TangentModel::exact, K);
  const Matrix wrong = printed_stiffness(model, q, Erratum::e1) - Matrix(K);
  EXPECT_NEAR(wrong(0, 0), 60.0, 1e-12);
  EXPECT_NEAR(wrong(1, 1), 0.0, 1e-12);
  EXPECT_EQ(printed_error(10.0, 2.0, 1.0, Erratum::e1), 60.0);
}

}  // namespace
}  // namespace fw::study
