#include "study/energy/energy.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <limits>
#include <memory>

#include "analysis/fit/power_law.hpp"
#include "core/error.hpp"
#include "study/energy/energy_run.hpp"

namespace fw::study {

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// The keys of [energy].
struct Settings {
  std::vector<double> steps;    ///< h [s], falling
  std::int64_t step_count = 0;  ///< of every run; 0: as many as reach the problem's end
  std::int64_t bins = 200;

  std::string text() const {
    return fmt::format("steps = {}\nstep_count = {}\nbins = {}\n", fmt::join(steps, ", "), step_count, bins);
  }
};

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
      values.insert(values.end(), width - row.size(), none);
    }
    return {std::move(name), std::move(unit), std::move(values), {rows_.size(), width}, {}};
  }

 private:
  std::vector<std::vector<double>> rows_;
};

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
    CaseResult result;
    result.verdict = judged.verdict;
    result.reason = judged.reason;
    add_columns(result);
    add_summary(result);
    return result;
  }

 private:
  template <class Value>
  std::vector<double> of_runs(Value value) const {
    std::vector<double> values;
    for (const EnergyRun& run : runs_) values.push_back(value(run));
    return values;
  }

  void add_columns(CaseResult& result) const {
    const std::string& unit = problem_.watched.unit;
    const std::string rate = unit == "1" ? "1/s" : unit + "/s";
    const auto add = [&](const char* name, const std::string& column_unit, auto value) {
      result.columns.push_back({name, column_unit, of_runs(value), {}, {}});
    };
    add("step", "s", [](const EnergyRun& run) { return run.step; });
    std::vector<std::int64_t> taken;
    std::vector<std::string> statuses;
    for (const EnergyRun& run : runs_) {
      taken.push_back(static_cast<std::int64_t>(run.seen->steps_taken()));
      statuses.emplace_back(to_string(run.status.code));
    }
    result.columns.push_back({"steps_taken", "1", taken, {}, {}});
    result.columns.push_back({"status", "", statuses, {}, {}});
    add("end_time", "s", [](const EnergyRun& run) { return run.end_time; });
    add("energy_start", unit, [](const EnergyRun& run) { return run.seen->start(); });
    result.columns.back().attributes = {{"quantity", problem_.watched.quantity}};
    add("energy_scale", unit, [](const EnergyRun& run) { return run.seen->scale(); });
    const auto drift = [](double analysis::Drift::*member) {
      return [member](const EnergyRun& run) { return run.drift.valid ? run.drift.*member : none; };
    };
    add("drift", rate, drift(&analysis::Drift::slope));
    add("drift_low", rate, drift(&analysis::Drift::slope_low));
    add("drift_high", rate, drift(&analysis::Drift::slope_high));
    add("oscillation", unit, drift(&analysis::Drift::oscillation));
    add("drift_over_oscillation", "1",
        [](const EnergyRun& run) { return run.drift.valid ? run.drift.significance() : none; });
    add("correlation", "1", [](const EnergyRun& run) { return run.seen->change().correlation(); });
    add("growth", "1", [](const EnergyRun& run) { return std::expm1(run.growth); });
    add("predicted_growth", "1", [](const EnergyRun& run) { return std::expm1(run.predicted_growth); });
    add_bins(result);
  }

  void add_bins(CaseResult& result) const {
    const std::string& unit = problem_.watched.unit;
    const auto add = [&](const char* name, const std::string& column_unit, auto row) {
      BinTable table;
      for (const EnergyRun& run : runs_) table.add_row(row(*run.seen));
      result.columns.push_back(table.column(name, column_unit));
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
    if (problem_.watched.is_damped) {
      // A run that stops early has fewer of them than bins.
      const auto padded = [](std::vector<double> values, const EnergyObserver& seen) {
        values.resize(seen.change().times().size(), none);
        return values;
      };
      add("work", unit, [&](const EnergyObserver& seen) { return padded(seen.work(), seen); });
      add("balance", unit, [&](const EnergyObserver& seen) { return padded(seen.balance(), seen); });
    }
  }

  /// The largest over the runs, relative to the scale of each.
  template <class Series, class Scale>
  double largest_relative(Series series, Scale scale) const {
    double largest = none;
    for (const EnergyRun& run : runs_) {
      if (series(*run.seen))
        largest = std::fmax(largest, series(*run.seen)->largest_magnitude() / scale(*run.seen));
    }
    return largest;
  }

  /// The law t^a by which rounding moves the linear momentum at the first step: ½ of a random walk.
  double momentum_exponent() const {
    const auto& change = runs_.front().seen->momentum_change();
    if (!change) return none;
    const analysis::PowerLaw law = analysis::fit_power_law(change->times(), change->largest());
    return law.valid ? law.exponent : none;
  }

  void add_summary(CaseResult& result) const {
    const EnergyRun& first = runs_.front();
    const auto scale = [](const EnergyObserver& seen) { return seen.scale(); };
    const double balance =
        first.seen->balance().empty() ? none : first.seen->balance().back() / first.seen->scale();
    result.summary = {
        {"problem", "", problem_.entry.label},
        {"method", "", call_},
        {"step", "s", first.step},
        {"steps_taken", "1", static_cast<std::int64_t>(first.seen->steps_taken())},
        {"relative_drift", "1", first.drift.valid ? first.relative_drift() : none},
        {"drift_over_oscillation", "1", first.drift.valid ? first.drift.significance() : none},
        {"relative_oscillation", "1",
         first.drift.valid ? first.drift.oscillation / first.seen->scale() : none},
        {"growth", "1", std::expm1(first.growth)},
        {"predicted_growth", "1", std::expm1(first.predicted_growth)},
        {"drift_exponent", "1", exponents_.drift.value},
        {"drift_exponent_low", "1", exponents_.drift.low},
        {"drift_exponent_high", "1", exponents_.drift.high},
        {"oscillation_exponent", "1", exponents_.oscillation.value},
        {"modified_change", "1",
         largest_relative([](const EnergyObserver& seen) { return seen.modified_change(); }, scale)},
        {"momentum_change", "1",
         largest_relative([](const EnergyObserver& seen) { return seen.momentum_change(); },
                          [](const EnergyObserver& seen) { return seen.momentum_scale(); })},
        {"momentum_exponent", "1", momentum_exponent()},
        {"angular_momentum_change", "1",
         largest_relative([](const EnergyObserver& seen) { return seen.angular_change(); },
                          [](const EnergyObserver& seen) { return seen.angular_scale(); })},
        {"balance", "1", balance},
        {"balance_exponent", "1", exponents_.balance.value},
        {"balance_exponent_low", "1", exponents_.balance.low},
        {"balance_exponent_high", "1", exponents_.balance.high},
        {"verdict", "", std::string(to_string(result.verdict))},
        {"reason", "", result.reason}};
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

Settings read_settings(const CheckedTable& spec, bool quick) {
  Settings settings;
  const CheckedTable table = spec.table("energy");
  settings.steps = table.numbers("steps", NumberRule::positive);
  if (settings.steps.empty()) table.fail("steps", "found an empty list, expected at least one step");
  for (std::size_t k = 1; k < settings.steps.size(); ++k) {
    if (settings.steps[k] >= settings.steps[k - 1]) {
      table.fail("steps", {k},
                 fmt::format("found {}, expected less than the step before", settings.steps[k]));
    }
  }
  settings.step_count = table.integer_or("step_count", settings.step_count, 0, 10'000'000'000);
  settings.bins = table.integer_or("bins", settings.bins, 4, 100'000);
  const std::int64_t quick_count = spec.table_or_empty("quick").integer_or(
      "step_count", std::min<std::int64_t>(settings.step_count, 20'000), 0, 10'000'000'000);
  if (quick) settings.step_count = quick_count;
  return settings;
}

EnergyTheory energy_theory(const analysis::Theory& theory) {
  return {.factors = analysis::oscillator_factors(theory),
          .modified_energy = theory.modified_energy,
          .has_coefficients = !std::holds_alternative<std::monostate>(theory.on_position_forces)};
}

void read_energy(const CheckedTable& spec, const Catalog& catalog, bool quick, Plan& plan) {
  const Settings settings = read_settings(spec, quick);
  const std::vector<std::string> methods = read_methods(spec, catalog);
  for (StudyProblem& entry : read_problems(spec, catalog, plan.warnings)) {
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
      std::string why = why_not_applicable(info, *ivp.system);
      if (!info.has_fixed_step) why = "it chooses its own steps, expected a method with a fixed step";
      if (!why.empty()) {
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
           .identity = "energy\n" + problem->entry.identity + "method = " + call + "\n" + settings.text(),
           .run = [problem, call, integrator, theory = energy_theory(catalog.theory(call)),
                   settings](const RunContext& context) {
             return EnergyCase(*problem, call, *integrator, theory, settings, context).run();
           }});
    }
  }
}

}  // namespace

StudyKind energy_kind() {
  return {.name = "energy",
          .title = "Energy over long runs",
          .description =
              "drift, oscillation and growth of the energy, modified energies, momenta, work of dampers",
          .read = read_energy};
}

}  // namespace fw::study
