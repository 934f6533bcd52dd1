#include "study/kinds/agreement.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "analysis/reference/converged_run.hpp"
#include "analysis/reference/reference_cache.hpp"
#include "core/error.hpp"
#include "settings/identity_text.hpp"
#include "study/measure/error_norms.hpp"
#include "study/problem_spec.hpp"

namespace fw::study {

namespace {

using settings::Archive;
using settings::setting;

/// The keys of [agreement].
struct Settings {
  double error = 1e-8;
  double largest_error = 1e-3;
  std::int64_t fewest_steps = 16;
  std::int64_t most_steps = 8192;
  bool has_reference = true;
};

void declare(Archive& a, Settings& s) {
  a(setting("error", s.error)
        .unit("1")
        .positive()
        .quick()
        .doc("relative: refined until the estimate is below"));
  a(setting("largest_error", s.largest_error)
        .unit("1")
        .positive()
        .doc("a method whose estimate stays above is named, but not compared"));
  a(setting("fewest_steps", s.fewest_steps)
        .integers(1, 1'000'000)
        .doc("of runs with constant steps; adaptive runs may take 16 times as many"));
  a(setting("most_steps", s.most_steps).integers(2, 1'000'000'000).quick_at_most(512).doc("likewise"));
  a(setting("reference", s.has_reference).doc("the closed form or certified reference is compared as well"));
}

struct Spec {
  MethodPatterns methods;
  Settings settings;
  std::vector<ProblemSpec> problems;
  std::int64_t quick_problems = 2;
};

void declare(Archive& a, Spec& spec) {
  declare(a, spec.methods);
  a.section({"agreement", "How far methods are refined."}, spec.settings);
  a.sections(problem_sections, spec.problems);
  a.quick_section([&] {
    if (!a.is_description()) {
      spec.quick_problems = static_cast<std::int64_t>(std::min<std::size_t>(spec.problems.size(), 2));
    }
    a(setting("problems", spec.quick_problems)
          .at_least(1)
          .default_text("at most 2")
          .doc("how many of the problems, from the first one"));
  });
}

/// Estimates are upper bounds in the limit of small steps; away from it they may be a little too small.
constexpr double safety = 2.0;
/// Relative: what rounding and the tolerances of Newton's iterations leave over a few thousand steps.
constexpr double rounding_level = 1e-11;

/// A method of the study.
struct Participant {
  std::string call;
  std::shared_ptr<const Integrator> integrator;
};

/// One row of the matrix.
struct Row {
  std::string name;
  std::string family;
  analysis::ConvergedRun run;
  bool compared = false;
};

/// The row of the summary.
struct SummaryFigures {
  std::string problem;
  std::int64_t methods = 0, not_accurate = 0, not_applicable = 0, pairs = 0, disagreeing = 0;
  double largest_difference = 0.0, largest_ratio = 0.0;
};

void declare(SummaryRow& a, const SummaryFigures& row) {
  a("problem", "", row.problem, "its label");
  a("methods", "1", row.methods, "solutions that are compared, with the reference");
  a("not_accurate", "1", row.not_accurate, "methods whose estimate stays too large");
  a("not_applicable", "1", row.not_applicable, "methods that cannot run on the problem");
  a("pairs", "1", row.pairs, "compared");
  a("disagreeing", "1", row.disagreeing, "pairs");
  a("largest_difference", "1", row.largest_difference, "of the pairs compared");
  a("largest_ratio", "1", row.largest_ratio, "of difference to expected difference");
}

class AgreementCase {
 public:
  AgreementCase(const StudyProblem& problem, const std::vector<Participant>& participants,
                const Settings& settings, const RunContext& context)
      : problem_(problem), participants_(participants), settings_(settings), context_(context) {}

  CaseResult run() {
    add_reference();
    for (const Participant& participant : participants_) add_method(participant);
    compare();
    CaseResult result;
    judge(result);
    add_columns(result);
    return result;
  }

 private:
  const Ivp& ivp() const { return problem_.problem.ivp; }

  /// Distance of two states in units of the problem's scale, as convergence studies measure it.
  double norm(ConstVectorRef difference) const {
    if (ivp().system->second_order() == nullptr) return root_mean_square(difference) / scale_.state;
    const Index n = difference.size() / 2;
    return std::sqrt(0.5 * (std::pow(root_mean_square(difference.head(n)) / scale_.position, 2) +
                            std::pow(root_mean_square(difference.tail(n)) / scale_.velocity, 2)));
  }

  static double root_mean_square(ConstVectorRef values) {
    return values.norm() / std::sqrt(static_cast<double>(values.size()));
  }

  void set_scale(ConstVectorRef state) {
    analysis::ReferenceState end;
    end.value.assign(state.data(), state.data() + state.size());
    scale_ = measure_scale(ivp(), end);
    has_scale_ = true;
  }

  void add_reference() {
    if (!settings_.has_reference) return;
    const double end[] = {ivp().t1};
    const analysis::ReferenceCache cache(context_.reference_cache);
    const analysis::ReferenceSolution reference = problem_.problem.exact
                                                      ? analysis::reference(problem_.problem, end)
                                                      : cache.certified(problem_.identity, ivp(), end);
    if (!reference.status.ok()) {
      not_compared_.push_back("the certified reference: " + reference.status.describe());
      return;
    }
    Row row;
    row.name = problem_.problem.exact ? "exact" : "certified";
    row.family = "reference";
    row.run.state = reference.states.front().rounded();
    set_scale(row.run.state);
    row.run.error_estimate = reference.states.front().largest_error() / smallest_scale();
    row.compared = true;
    rows_.push_back(std::move(row));
  }

  double smallest_scale() const {
    return ivp().system->second_order() == nullptr ? scale_.state
                                                   : std::min(scale_.position, scale_.velocity);
  }

  void add_method(const Participant& participant) {
    context_.check();
    const MethodInfo& info = participant.integrator->info();
    if (!why_not_applicable(info, *ivp().system).empty()) {
      ++not_applicable_;
      return;
    }
    analysis::RefinementGoal goal{.error = settings_.error,
                                  .fewest_steps = static_cast<std::uint64_t>(settings_.fewest_steps),
                                  .most_steps = static_cast<std::uint64_t>(settings_.most_steps),
                                  .stop = context_.stop};
    Row row;
    row.name = participant.call;
    row.family = info.family;
    try {
      if (!has_scale_) set_scale(first_solution(*participant.integrator, goal));
      row.run = refined(*participant.integrator, goal);
    } catch (const InputError& error) {
      refused_.push_back(fmt::format("{}: {}", row.name, error.what()));
      row.run.error_estimate = std::numeric_limits<double>::infinity();
    }
    context_.check();
    row.compared = row.run.error_estimate <= settings_.largest_error;
    if (!row.compared && (refused_.empty() || !refused_.back().starts_with(row.name + ": "))) {
      const std::string why = std::isfinite(row.run.error_estimate)
                                  ? fmt::format("estimate {:.1e} after {} steps", row.run.error_estimate,
                                                row.run.work.accepted_steps)
                              : row.run.status.ok() ? "too few runs"
                                                    : std::string(to_string(row.run.status.code));
      not_compared_.push_back(fmt::format("{} ({})", row.name, why));
    }
    rows_.push_back(std::move(row));
  }

  /// With steps of its own choice if it can; with constant steps where these do not lead to the goal, since
  /// an error estimate can be blind for a problem.
  analysis::ConvergedRun refined(const Integrator& integrator, const analysis::RefinementGoal& goal) const {
    const auto size = [this](ConstVectorRef difference) { return norm(difference); };
    analysis::ConvergedRun run = analysis::run_to_accuracy(integrator, ivp(), size, goal);
    const MethodInfo& info = integrator.info();
    if (run.error_estimate <= goal.error || !info.is_adaptive || !info.has_fixed_step) return run;
    analysis::ConvergedRun constant = analysis::run_to_accuracy(integrator, ivp(), size, goal, true);
    return constant.error_estimate < run.error_estimate ? constant : run;
  }

  /// Without a reference the first method's solution gives the scale.
  Vector first_solution(const Integrator& integrator, const analysis::RefinementGoal& goal) const {
    analysis::ConvergedRun run = analysis::run_to_accuracy(
        integrator, ivp(), [](ConstVectorRef d) { return root_mean_square(d); }, goal);
    if (run.state.size() == 0) {
      throw InputError("the first method has no solution to take the scale from: " + run.status.describe());
    }
    return std::move(run.state);
  }

  void compare() {
    const std::size_t n = rows_.size();
    difference_.assign(n * n, std::numeric_limits<double>::quiet_NaN());
    expected_ = difference_;
    agrees_.assign(n * n, -1);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        const analysis::ConvergedRun &a = rows_[i].run, &b = rows_[j].run;
        if (a.state.size() == 0 || b.state.size() == 0) continue;
        const std::size_t k = i * n + j;
        difference_[k] = norm(a.state - b.state);
        expected_[k] = safety * (a.error_estimate + b.error_estimate) + rounding_level;
        if (i == j || !rows_[i].compared || !rows_[j].compared) continue;
        agrees_[k] = difference_[k] <= expected_[k] ? 1 : 0;
      }
    }
  }

  void judge(CaseResult& result) const {
    const std::size_t n = rows_.size();
    std::int64_t pairs = 0, disagreeing = 0;
    double largest_ratio = 0.0, largest_difference = 0.0;
    std::string worst;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const std::size_t k = i * n + j;
        if (agrees_[k] < 0) continue;
        ++pairs;
        if (agrees_[k] == 0) ++disagreeing;
        largest_difference = std::max(largest_difference, difference_[k]);
        const double ratio = difference_[k] / expected_[k];
        if (ratio > largest_ratio) {
          largest_ratio = ratio;
          worst = fmt::format("{} and {}: {:.2e} where {:.2e} is expected", rows_[i].name, rows_[j].name,
                              difference_[k], expected_[k]);
        }
      }
    }
    const auto compared =
        std::count_if(rows_.begin(), rows_.end(), [](const Row& row) { return row.compared; });
    result.verdict = disagreeing > 0 || !refused_.empty() ? Verdict::fails
                     : pairs == 0                         ? Verdict::not_applicable
                                                          : Verdict::holds;
    result.reason = pairs == 0
                        ? "no two solutions are accurate enough to compare"
                        : fmt::format("{} of {} pairs agree; the largest share of what is expected: {}",
                                      pairs - disagreeing, pairs, worst);
    if (!refused_.empty()) result.reason += fmt::format("; cannot run: {}", fmt::join(refused_, ", "));
    if (!not_compared_.empty()) {
      result.reason += fmt::format("; not accurate enough to compare: {}", fmt::join(not_compared_, ", "));
    }
    if (!problem_.problem.is_smooth) {
      result.reason += "; the forces have kinks or jumps, where errors and their estimates are irregular";
    }
    result.summary = cells_of(SummaryFigures{.problem = problem_.label,
                                             .methods = compared,
                                             .not_accurate = static_cast<std::int64_t>(not_compared_.size()),
                                             .not_applicable = not_applicable_,
                                             .pairs = pairs,
                                             .disagreeing = disagreeing,
                                             .largest_difference = largest_difference,
                                             .largest_ratio = largest_ratio});
  }

  void add_columns(CaseResult& result) const {
    std::vector<std::string> names, families, status;
    std::vector<double> steps, tolerances, estimates, seconds, states;
    std::vector<std::int64_t> compared, evaluations;
    const Index size = ivp().system->size();
    for (const Row& row : rows_) {
      names.push_back(row.name);
      families.push_back(row.family);
      status.push_back(std::string(to_string(row.run.status.code)));
      steps.push_back(row.run.step);
      tolerances.push_back(row.run.tolerance);
      estimates.push_back(row.run.error_estimate);
      seconds.push_back(row.run.work.seconds);
      compared.push_back(row.compared ? 1 : 0);
      evaluations.push_back(static_cast<std::int64_t>(row.run.work.rhs_evaluations));
      const Vector state = row.run.state.size() > 0
                               ? row.run.state
                               : Vector::Constant(size, std::numeric_limits<double>::quiet_NaN());
      states.insert(states.end(), state.data(), state.data() + size);
    }
    const auto n = static_cast<std::uint64_t>(rows_.size());
    const std::string relative =
        ivp().system->second_order() == nullptr
            ? fmt::format("root mean square over the state / {:.6g}", scale_.state)
            : fmt::format(
                  "sqrt(((position / {:.6g} m)^2 + (velocity / {:.6g} m/s)^2) / 2), root mean squares",
                  scale_.position, scale_.velocity);
    result.columns = {
        {"method", "", names, {}, {}},
        {"family", "", families, {}, {}},
        {"step", "s", steps, {}, {}},
        {"tolerance", "1", tolerances, {}, {}},
        {"error_estimate", "1", estimates, {}, {{"norm", relative}}},
        {"compared", "1", compared, {}, {}},
        {"status", "", status, {}, {}},
        {"rhs_evaluations", "1", evaluations, {}, {}},
        {"seconds", "s", seconds, {}, {}},
        {"state", "SI", states, {n, static_cast<std::uint64_t>(size)}, {}},
        {"difference", "1", difference_, {n, n}, {{"norm", relative}}},
        {"expected_difference", "1", expected_, {n, n}, {{"norm", relative}}},
        {"agrees", "1", agrees_, {n, n}, {}},
    };
    if (!problem_.scene_toml.empty()) {
      result.columns.push_back({"scene", "", std::vector<std::string>{problem_.scene_toml}, {}, {}});
    }
  }

  const StudyProblem& problem_;
  const std::vector<Participant>& participants_;
  const Settings& settings_;
  const RunContext& context_;
  StateScale scale_;
  bool has_scale_ = false;
  std::vector<Row> rows_;
  std::vector<std::string> not_compared_;  ///< methods and why
  std::vector<std::string> refused_;       ///< methods that refuse the problem, and how
  std::int64_t not_applicable_ = 0;
  std::vector<double> difference_, expected_;
  std::vector<std::int64_t> agrees_;
};

void check(const Settings& settings, const StudyInput& input) {
  const CheckedTable table = input.section("agreement");
  if (settings.error > settings.largest_error) {
    table.fail("error", fmt::format("found {}, expected at most largest_error = {}", settings.error,
                                    settings.largest_error));
  }
  if (2 * settings.fewest_steps > settings.most_steps) {
    table.fail("fewest_steps", fmt::format("found {}, expected at most half of most_steps, which is {}{}",
                                           settings.fewest_steps, settings.most_steps,
                                           input.is_quick ? " with --quick" : ""));
  }
}

void plan_agreement(const Spec& spec, const StudyInput& input, Plan& plan) {
  const Settings& settings = spec.settings;
  check(settings, input);
  const auto given = static_cast<std::int64_t>(spec.problems.size());
  if (spec.quick_problems > given) {
    input.section("quick").fail(
        "problems", fmt::format("found {}, expected an integer from 1 to {}", spec.quick_problems, given));
  }
  std::vector<StudyProblem> problems = make_problems(spec.problems, input, plan.warnings);
  if (input.is_quick) problems.resize(static_cast<std::size_t>(spec.quick_problems));
  auto participants = std::make_shared<std::vector<Participant>>();
  std::string calls;
  for (const std::string& call : expanded(spec.methods, input)) {
    participants->push_back({call, input.catalog.method(call)});
    calls += "method = " + call + "\n";
  }
  for (StudyProblem& entry : problems) {
    const auto problem = std::make_shared<const StudyProblem>(std::move(entry));
    plan.cases.push_back(
        {.id = group_name(problem->label),
         .identity = "agreement\n" + problem->identity + calls + settings::identity_text(settings),
         .run = [problem, participants, settings](const RunContext& context) {
           return AgreementCase(*problem, *participants, settings, context).run();
         }});
  }
}

}  // namespace

StudyKind agreement_kind() {
  return declared_kind<Spec>(
      {.name = "agreement",
       .title = "Agreement of all methods",
       .description =
           "own schemes and foreign solvers on the same problems: difference of every pair against "
           "what their error estimates allow",
       .summary = columns_of<SummaryFigures>(),
       .verdict_meaning = "`holds`: no pair disagrees",
       .reason_meaning = "names the worst pair and the methods not compared"},
      plan_agreement);
}

}  // namespace fw::study
