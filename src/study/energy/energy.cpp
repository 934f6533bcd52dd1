#include "study/energy/energy.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <limits>
#include <memory>

#include "analysis/fit/power_law.hpp"
#include "core/error.hpp"
#include "core/special_values.hpp"
#include "settings/identity_text.hpp"
#include "study/energy/energy_run.hpp"

namespace fw::study {

namespace {

using settings::Archive;
using settings::setting;

/// The keys of [energy].
struct Settings {
  std::vector<double> steps;
  std::int64_t step_count = 0;
  std::int64_t bins = 200;
};

void declare(Archive& a, Settings& s) {
  a(setting("steps", s.steps)
        .unit("s")
        .required()
        .not_empty()
        .positive()
        .doc("h, falling; two or more for powers of h"));
  a(setting("step_count", s.step_count)
        .integers(0, 10'000'000'000)
        .quick_at_most(20'000)
        .doc("steps of every run; 0: as many as reach `t_end`, which has to be a whole number of each"));
  a(setting("bins", s.bins).integers(4, 100'000).doc("per run"));
}

struct Spec {
  std::vector<std::string> methods;
  Settings settings;
  std::vector<ProblemSpec> problems;
};

void declare(Archive& a, Spec& spec) {
  a(methods_setting(spec.methods));
  a.section({.name = "energy", .doc = "Steps and lengths of the runs.", .is_required = true}, spec.settings);
  a.sections(problem_sections, spec.problems);
  a.quick_section();
}

struct WatchedEntry {
  explicit WatchedEntry(StudyProblem given) : entry(std::move(given)), watched(entry) {}
  StudyProblem entry;
  WatchedProblem watched;
};

/// Rows of S runs with B bins each; runs that ended early or have fewer bins are filled up with NaN.
class BinTable {
 public:
  void add_row(std::vector<double> row) { rows_.push_back(std::move(row)); }
  Column column(std::string name, std::string unit) const {
    std::size_t width = 0;
    for (const auto& row : rows_) width = std::max(width, row.size());
    std::vector<double> values;
    for (const auto& row : rows_) {
      values.insert(values.end(), row.begin(), row.end());
      values.insert(values.end(), width - row.size(), no_value);
    }
    return {std::move(name), std::move(unit), std::move(values), {rows_.size(), width}, {}};
  }

 private:
  std::vector<std::vector<double>> rows_;
};

/// The row of the summary.
struct Row {
  std::string problem, method;
  double step = no_value;
  std::int64_t steps_taken = 0;
  double relative_drift = no_value;
  double drift_over_oscillation = no_value;
  double relative_oscillation = no_value;
  double growth = no_value;
  double predicted_growth = no_value;
  double drift_exponent = no_value;
  double drift_exponent_low = no_value;
  double drift_exponent_high = no_value;
  double oscillation_exponent = no_value;
  double modified_change = no_value;
  double momentum_change = no_value;
  double momentum_exponent = no_value;
  double angular_momentum_change = no_value;
  double balance = no_value;
  double balance_exponent = no_value;
  double balance_exponent_low = no_value;
  double balance_exponent_high = no_value;
};

void declare(SummaryRow& a, const Row& row) {
  a("problem", "", row.problem, "its label");
  a("method", "", row.method, "as in the study, with settings");
  a("step", "s", row.step, "the first, largest one: what follows is of this run unless it says otherwise");
  a("steps_taken", "1", row.steps_taken, "");
  a("relative_drift", "1", row.relative_drift, "drift·duration over the size of the energy");
  a("drift_over_oscillation", "1", row.drift_over_oscillation, "");
  a("relative_oscillation", "1", row.relative_oscillation, "over the size of the energy");
  a("growth", "1", row.growth, "as in the case");
  a("predicted_growth", "1", row.predicted_growth, "likewise");
  a("drift_exponent", "1", row.drift_exponent,
    "power of h over all runs whose drift is clear; NaN with fewer than two");
  a("drift_exponent_low", "1", row.drift_exponent_low,
    "lower end of the 95 % interval; NaN with fewer than three");
  a("drift_exponent_high", "1", row.drift_exponent_high, "upper end");
  a("oscillation_exponent", "1", row.oscillation_exponent, "likewise of the oscillation");
  a("modified_change", "1", row.modified_change,
    "largest of all runs, over the size of the energy; NaN where none is known");
  a("momentum_change", "1", row.momentum_change,
    "largest of all runs, over the largest Σ m‖v‖; NaN with outer forces");
  a("momentum_exponent", "1", row.momentum_exponent,
    "power of t with which it grows: about ½ for a random walk");
  a("angular_momentum_change", "1", row.angular_momentum_change,
    "largest of all runs, over the largest Σ ‖x‖ m‖v‖");
  a("balance", "1", row.balance, "at the end, over the size of the energy; NaN without dampers");
  a("balance_exponent", "1", row.balance_exponent, "power of h of the balance at the end");
  a("balance_exponent_low", "1", row.balance_exponent_low, "");
  a("balance_exponent_high", "1", row.balance_exponent_high, "");
}

class EnergyCase {
 public:
  EnergyCase(const WatchedEntry& problem, const std::string& call, const Integrator& integrator,
             const EnergyTheory& theory, const Settings& settings, const RunContext& context)
      : problem_(problem),
        call_(call),
        integrator_(integrator),
        theory_(theory),
        settings_(settings),
        context_(context) {}

  CaseResult run() {
    const Ivp& ivp = problem_.entry.problem.ivp;
    for (const double step : settings_.steps) {
      const std::uint64_t steps =
          settings_.step_count > 0 ? static_cast<std::uint64_t>(settings_.step_count)
                                   : count_whole_steps(integrator_.info().name, ivp.t0, ivp.t1, step).whole;
      runs_.push_back(follow_energy(problem_.watched, ivp, integrator_, theory_, step, steps,
                                    static_cast<std::uint64_t>(settings_.bins), context_));
    }
    exponents_ = measure_exponents(runs_);
    const EnergyVerdict judged =
        judge_energy(problem_.watched, integrator_.info(),
                     theory_.has_coefficients && integrator_.info().is_symplectic, runs_, exponents_);
    return case_result(judged.verdict, judged.reason, columns(), row());
  }

 private:
  template <class Value>
  std::vector<double> of_runs(Value value) const {
    std::vector<double> values;
    for (const EnergyRun& run : runs_) values.push_back(value(run));
    return values;
  }

  std::vector<Column> columns() const {
    std::vector<Column> columns;
    const std::string& unit = problem_.watched.unit;
    const std::string rate = unit == "1" ? "1/s" : unit + "/s";
    const auto add = [&](const char* name, const std::string& column_unit, auto value) {
      columns.push_back({name, column_unit, of_runs(value), {}, {}});
    };
    add("step", "s", [](const EnergyRun& run) { return run.step; });
    std::vector<std::int64_t> taken;
    std::vector<std::string> statuses;
    for (const EnergyRun& run : runs_) {
      taken.push_back(static_cast<std::int64_t>(run.seen->steps_taken()));
      statuses.emplace_back(to_string(run.status.code));
    }
    columns.push_back({"steps_taken", "1", taken, {}, {}});
    columns.push_back({"status", "", statuses, {}, {}});
    add("end_time", "s", [](const EnergyRun& run) { return run.end_time; });
    add("energy_start", unit, [](const EnergyRun& run) { return run.seen->start(); });
    columns.back().attributes = {{"quantity", problem_.watched.quantity}};
    add("energy_scale", unit, [](const EnergyRun& run) { return run.seen->scale(); });
    const auto drift = [](double analysis::Drift::*member) {
      return [member](const EnergyRun& run) { return run.drift.valid ? run.drift.*member : no_value; };
    };
    add("drift", rate, drift(&analysis::Drift::slope));
    add("drift_low", rate, drift(&analysis::Drift::slope_low));
    add("drift_high", rate, drift(&analysis::Drift::slope_high));
    add("oscillation", unit, drift(&analysis::Drift::oscillation));
    add("drift_over_oscillation", "1",
        [](const EnergyRun& run) { return run.drift.valid ? run.drift.significance() : no_value; });
    add("correlation", "1", [](const EnergyRun& run) { return run.seen->change().correlation(); });
    add("growth", "1", [](const EnergyRun& run) { return std::expm1(run.growth); });
    add("predicted_growth", "1", [](const EnergyRun& run) { return std::expm1(run.predicted_growth); });
    add_bins(columns);
    return columns;
  }

  void add_bins(std::vector<Column>& columns) const {
    const std::string& unit = problem_.watched.unit;
    const auto add = [&](const char* name, const std::string& column_unit, auto row) {
      BinTable table;
      for (const EnergyRun& run : runs_) table.add_row(row(*run.seen));
      columns.push_back(table.column(name, column_unit));
    };
    add("bin_time", "s", [](const EnergyObserver& seen) { return seen.change().times(); });
    add("change_least", unit, [](const EnergyObserver& seen) { return seen.change().least(); });
    add("change_mean", unit, [](const EnergyObserver& seen) { return seen.change().means(); });
    add("change_largest", unit, [](const EnergyObserver& seen) { return seen.change().largest(); });
    const EnergyObserver& first = *runs_.front().seen;
    if (first.modified_change()) {
      add("modified_least", unit, [](const EnergyObserver& seen) { return seen.modified_change()->least(); });
      add("modified_largest", unit,
          [](const EnergyObserver& seen) { return seen.modified_change()->largest(); });
    }
    if (first.momentum_change()) {
      add("momentum_change", "kg*m/s",
          [](const EnergyObserver& seen) { return seen.momentum_change()->largest(); });
      add("angular_momentum_change", "kg*m^2/s",
          [](const EnergyObserver& seen) { return seen.angular_change()->largest(); });
    }
    if (problem_.watched.is_damped || problem_.watched.is_driven) {
      // A run that stops early has fewer of them than bins.
      const auto padded = [](std::vector<double> values, const EnergyObserver& seen) {
        values.resize(seen.change().times().size(), no_value);
        return values;
      };
      add("work", unit, [&](const EnergyObserver& seen) { return padded(seen.work(), seen); });
      add("balance", unit, [&](const EnergyObserver& seen) { return padded(seen.balance(), seen); });
    }
  }

  /// The largest over the runs, relative to the scale of each.
  template <class Series, class Scale>
  double largest_relative(Series series, Scale scale) const {
    double largest = no_value;
    for (const EnergyRun& run : runs_) {
      if (series(*run.seen))
        largest = std::fmax(largest, series(*run.seen)->largest_magnitude() / scale(*run.seen));
    }
    return largest;
  }

  /// The law t^a by which rounding moves the linear momentum at the first step: ½ of a random walk.
  double momentum_exponent() const {
    const auto& change = runs_.front().seen->momentum_change();
    if (!change) return no_value;
    const analysis::PowerLaw law = analysis::fit_power_law(change->times(), change->largest());
    return law.valid ? law.exponent : no_value;
  }

  Row row() const {
    const EnergyRun& first = runs_.front();
    const auto scale = [](const EnergyObserver& seen) { return seen.scale(); };
    const double balance =
        first.seen->balance().empty() ? no_value : first.seen->balance().back() / first.seen->scale();
    return {
        .problem = problem_.entry.label,
        .method = call_,
        .step = first.step,
        .steps_taken = static_cast<std::int64_t>(first.seen->steps_taken()),
        .relative_drift = first.drift.valid ? first.relative_drift() : no_value,
        .drift_over_oscillation = first.drift.valid ? first.drift.significance() : no_value,
        .relative_oscillation = first.drift.valid ? first.drift.oscillation / first.seen->scale() : no_value,
        .growth = std::expm1(first.growth),
        .predicted_growth = std::expm1(first.predicted_growth),
        .drift_exponent = exponents_.drift.value,
        .drift_exponent_low = exponents_.drift.low,
        .drift_exponent_high = exponents_.drift.high,
        .oscillation_exponent = exponents_.oscillation.value,
        .modified_change =
            largest_relative([](const EnergyObserver& seen) { return seen.modified_change(); }, scale),
        .momentum_change = largest_relative([](const EnergyObserver& seen) { return seen.momentum_change(); },
                                            [](const EnergyObserver& seen) { return seen.momentum_scale(); }),
        .momentum_exponent = momentum_exponent(),
        .angular_momentum_change =
            largest_relative([](const EnergyObserver& seen) { return seen.angular_change(); },
                             [](const EnergyObserver& seen) { return seen.angular_scale(); }),
        .balance = balance,
        .balance_exponent = exponents_.balance.value,
        .balance_exponent_low = exponents_.balance.low,
        .balance_exponent_high = exponents_.balance.high};
  }

  const WatchedEntry& problem_;
  const std::string& call_;
  const Integrator& integrator_;
  const EnergyTheory& theory_;
  const Settings& settings_;
  const RunContext& context_;
  std::vector<EnergyRun> runs_;
  EnergyExponents exponents_;
};

EnergyTheory energy_theory(const analysis::Theory& theory) {
  return {.factors = analysis::oscillator_factors(theory),
          .modified_energy = theory.modified_energy,
          .has_coefficients = !std::holds_alternative<std::monostate>(theory.on_position_forces)};
}

void plan_energy(const Spec& study, const StudyInput& input, Plan& plan) {
  const CheckedTable& spec = input.file;
  const Catalog& catalog = input.catalog;
  const Settings& settings = study.settings;
  for (std::size_t k = 1; k < settings.steps.size(); ++k) {
    if (settings.steps[k] >= settings.steps[k - 1]) {
      spec.table("energy").fail(
          "steps", {k}, fmt::format("found {}, expected less than the step before", settings.steps[k]));
    }
  }
  const std::vector<std::string>& methods = checked_methods(study.methods, spec, catalog);
  for (StudyProblem& entry : make_problems(study.problems, input, plan.warnings)) {
    std::shared_ptr<const WatchedEntry> problem;
    try {
      problem = std::make_shared<const WatchedEntry>(std::move(entry));
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: {}", spec.source_name(), error.what()));
    }
    const Ivp& ivp = problem->entry.problem.ivp;
    for (std::size_t i = 0; i < methods.size(); ++i) {
      const std::string& call = methods[i];
      const std::shared_ptr<const Integrator> integrator = catalog.method(call);
      const MethodInfo& info = integrator->info();
      if (const std::string why = why_no_constant_steps(info, *ivp.system); !why.empty()) {
        spec.fail("methods", {i},
                  fmt::format("\"{}\" (problem \"{}\"): {}", call, problem->entry.label, why));
      }
      for (std::size_t k = 0; settings.step_count == 0 && k < settings.steps.size(); ++k) {
        try {
          count_whole_steps(call, ivp.t0, ivp.t1, settings.steps[k]);
        } catch (const InputError& error) {
          spec.table("energy").fail("steps", {k},
                                    fmt::format("{} (problem \"{}\")", error.what(), problem->entry.label));
        }
      }
      plan.cases.push_back(
          {.id = group_name(problem->entry.label + "-" + call),
           .identity = "energy\n" + problem->entry.identity + "method = " + call + "\n" +
                       settings::identity_text(settings),
           .run =
               [problem, call, integrator, theory = energy_theory(catalog.theory(call)),
                settings](const RunContext& context) {
                 return EnergyCase(*problem, call, *integrator, theory, settings, context).run();
               },
           .known = {{"problem", problem->entry.label}, {"method", call}}});
    }
  }
}

}  // namespace

StudyKind energy_kind() {
  return declared_kind<Spec>(
      {.name = "energy",
       .title = "Energy over long runs",
       .description =
           "drift, oscillation and growth of the energy, modified energies, momenta, work of dampers",
       .summary = columns_of<Row>(),
       .verdict_meaning = "`holds`: every statement of theory that applies",
       .reason_meaning = "these statements with their figures"},
      plan_energy);
}

}  // namespace fw::study
