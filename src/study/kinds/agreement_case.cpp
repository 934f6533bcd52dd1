#include "study/kinds/agreement_case.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/reference/converged_run.hpp"
#include "core/error.hpp"
#include "study/measure/error_norms.hpp"

namespace fw::study {

namespace {

/// Estimates are upper bounds in the limit of small steps; away from it they may be a little too small.
constexpr double safety = 2.0;
/// By so much an estimate may be too small where forces have kinks or jumps.
constexpr double irregular_estimate = 100.0;
/// Relative: what rounding and the tolerances of Newton's iterations leave over a few thousand steps.
constexpr double rounding_level = 1e-11;

/// One row of the matrix.
struct MatrixRow {
  std::string name;
  std::string family;
  analysis::ConvergedRun run;
  bool compared = false;
};

class AgreementCase {
 public:
  AgreementCase(const SharedProblem& problem, const std::vector<Participant>& participants,
                const AgreementSettings& settings, const RunContext& context)
      : problem_(problem), participants_(participants), settings_(settings), context_(context) {}

  CaseResult run() {
    add_reference();
    for (const Participant& participant : participants_) add_method(participant);
    compare();
    return judge();
  }

 private:
  const StudyProblem& entry() const { return problem_.entry(); }
  const Ivp& ivp() const { return problem_.ivp(); }

  /// Distance of two states in units of the problem's scale, as convergence studies measure it.
  double norm(ConstVectorRef difference) const { return relative_norm(ivp(), difference, scale_); }

  void set_scale(ConstVectorRef state) {
    analysis::ReferenceState end;
    end.value.assign(state.data(), state.data() + state.size());
    scale_ = measure_scale(ivp(), end);
    has_scale_ = true;
  }

  void add_reference() {
    if (!settings_.has_reference) return;
    const analysis::ReferenceSolution& reference = problem_.reference(context_);
    if (!reference.status.ok()) {
      not_compared_.push_back("the certified reference: " + reference.status.describe());
      return;
    }
    MatrixRow row;
    row.name = entry().problem.exact ? "exact" : "certified";
    row.family = "reference";
    row.run.state = reference.states.front().rounded();
    set_scale(row.run.state);
    row.run.error_estimate = reference.states.front().largest_error() / smallest_scale(ivp(), scale_);
    row.compared = true;
    rows_.push_back(std::move(row));
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
    MatrixRow row;
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
                              : !row.run.warning.empty() ? row.run.warning
                              : row.run.status.ok()      ? "too few runs"
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

  CaseResult judge() const {
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
        std::count_if(rows_.begin(), rows_.end(), [](const MatrixRow& row) { return row.compared; });
    // At kinks and jumps errors fall irregularly: an estimate from the last runs may be off by much, if not by
    // everything.
    const bool refutes = largest_ratio > (entry().problem.is_smooth ? 1.0 : irregular_estimate);
    const Verdict verdict = refutes || !refused_.empty()    ? Verdict::fails
                            : pairs == 0 || disagreeing > 0 ? Verdict::not_applicable
                                                            : Verdict::holds;
    std::string reason = pairs == 0
                             ? "no two solutions are accurate enough to compare"
                             : fmt::format("{} of {} pairs agree; the largest share of what is expected: {}",
                                           pairs - disagreeing, pairs, worst);
    if (!refused_.empty()) reason += fmt::format("; cannot run: {}", fmt::join(refused_, ", "));
    if (!not_compared_.empty()) {
      reason += fmt::format("; not accurate enough to compare: {}", fmt::join(not_compared_, ", "));
    }
    if (!entry().problem.is_smooth) {
      reason += "; the forces have kinks or jumps, where errors and their estimates are irregular";
    }
    return case_result(verdict, std::move(reason), columns(),
                       AgreementRow{.problem = entry().label,
                                    .methods = compared,
                                    .not_accurate = static_cast<std::int64_t>(not_compared_.size()),
                                    .not_applicable = not_applicable_,
                                    .pairs = pairs,
                                    .disagreeing = disagreeing,
                                    .largest_difference = largest_difference,
                                    .largest_ratio = largest_ratio});
  }

  std::vector<Column> columns() const {
    std::vector<std::string> names, families, status;
    std::vector<double> steps, tolerances, estimates, seconds, states;
    std::vector<std::int64_t> compared, evaluations;
    const Index size = ivp().system->size();
    for (const MatrixRow& row : rows_) {
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
    std::vector<Column> columns = {
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
    if (!entry().scene_toml.empty()) {
      columns.push_back({"scene", "", std::vector<std::string>{entry().scene_toml}, {}, {}});
    }
    return columns;
  }

  const SharedProblem& problem_;
  const std::vector<Participant>& participants_;
  const AgreementSettings& settings_;
  const RunContext& context_;
  StateScale scale_;
  bool has_scale_ = false;
  std::vector<MatrixRow> rows_;
  std::vector<std::string> not_compared_;  ///< methods and why
  std::vector<std::string> refused_;       ///< methods that refuse the problem, and how
  std::int64_t not_applicable_ = 0;
  std::vector<double> difference_, expected_;
  std::vector<std::int64_t> agrees_;
};

}  // namespace

void declare(settings::Archive& a, AgreementSettings& s) {
  using settings::setting;
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

void declare(SummaryRow& a, const AgreementRow& row) {
  a("problem", "", row.problem, "its label");
  a("methods", "1", row.methods, "solutions that are compared, with the reference");
  a("not_accurate", "1", row.not_accurate, "methods whose estimate stays too large");
  a("not_applicable", "1", row.not_applicable, "methods that cannot run on the problem");
  a("pairs", "1", row.pairs, "compared");
  a("disagreeing", "1", row.disagreeing, "pairs");
  a("largest_difference", "1", row.largest_difference, "of the pairs compared");
  a("largest_ratio", "1", row.largest_ratio, "of difference to expected difference");
}

CaseResult run_agreement(const SharedProblem& problem, const std::vector<Participant>& participants,
                         const AgreementSettings& settings, const RunContext& context) {
  return AgreementCase(problem, participants, settings, context).run();
}

}  // namespace fw::study
