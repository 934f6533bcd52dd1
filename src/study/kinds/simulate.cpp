#include "study/kinds/simulate.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <memory>

#include "core/error.hpp"
#include "record/frame_selector.hpp"
#include "study/kinds/step_construction.hpp"
#include "study/problem_spec.hpp"

namespace fw::study {

namespace {

/// Collects the frames of one trajectory.
class FrameColumns final : public record::FrameSink {
 public:
  void frame(double time, ConstVectorRef state) override {
    times_.push_back(time);
    states_.insert(states_.end(), state.data(), state.data() + state.size());
  }
  const std::vector<double>& times() const { return times_; }
  const std::vector<double>& states() const { return states_; }

 private:
  std::vector<double> times_, states_;
};

constexpr std::int64_t exact_frames = 401;

void add_exact(const StudyProblem& entry, CaseResult& result) {
  if (!entry.problem.exact) return;
  const Ivp& ivp = entry.problem.ivp;
  std::vector<double> times, states;
  for (std::int64_t k = 0; k < exact_frames; ++k) {
    const double t =
        ivp.t0 + (ivp.t1 - ivp.t0) * static_cast<double>(k) / static_cast<double>(exact_frames - 1);
    times.push_back(t);
    for (const Float128& value : entry.problem.exact(t)) states.push_back(static_cast<double>(value));
  }
  const auto size = static_cast<std::uint64_t>(ivp.system->size());
  result.columns.push_back({"exact_time", "s", times, {}, {}});
  result.columns.push_back({"exact_state", "SI", states, {times.size(), size}, {}});
}

std::vector<SummaryCell> summary_row(const std::string& problem, const std::string& method, double step,
                                     double end_time, double end_error, const Status& status,
                                     const CaseResult& result) {
  return {{"problem", "", problem},
          {"method", "", method},
          {"step", "s", step},
          {"end_time", "s", end_time},
          {"end_error", "SI", end_error},
          {"status", "", std::string(to_string(status.code))},
          {"verdict", "", std::string(to_string(result.verdict))},
          {"reason", "", result.reason}};
}

CaseResult run_trajectory(const StudyProblem& entry, const std::string& call, const Integrator& integrator,
                          const StepControl& control, std::uint64_t frames, std::int64_t construction,
                          const RunContext& context) {
  const Ivp& ivp = entry.problem.ivp;
  FrameColumns columns;
  record::FrameSelector selector(ivp.t0, ivp.t1, control, frames, columns);
  const Solution solution = context.solve(integrator, ivp, control, selector);

  CaseResult result;
  result.verdict = solution.status.ok() ? Verdict::holds : Verdict::fails;
  result.reason = solution.status.ok() ? "reached the end" : solution.status.describe();
  const auto* fixed = std::get_if<FixedStep>(&control);
  const double step = fixed != nullptr ? fixed->step : std::numeric_limits<double>::quiet_NaN();
  const auto size = static_cast<std::uint64_t>(ivp.system->size());
  result.columns = {
      {"problem", "", std::vector<std::string>{entry.label}, {}, {}},
      {"method", "", std::vector<std::string>{call}, {}, {}},
      {"step", "s", std::vector<double>{step}, {}, {}},
      {"second_order", "1", std::vector<std::int64_t>{ivp.system->second_order() != nullptr ? 1 : 0}, {}, {}},
      {"time", "s", columns.times(), {}, {}},
      {"state", "SI", columns.states(), {columns.times().size(), size}, {}}};
  add_exact(entry, result);
  for (const Invariant& invariant : entry.problem.invariants) {
    std::vector<double> values;
    for (std::size_t k = 0; k < columns.times().size(); ++k) {
      values.push_back(invariant.value(
          columns.times()[k], ConstVectorMap(columns.states().data() + k * size, static_cast<Index>(size))));
    }
    result.columns.push_back({"invariant_" + group_name(invariant.name), invariant.unit, values, {}, {}});
  }
  add_step_construction(ivp, integrator, control, construction, result);
  double end_error = std::numeric_limits<double>::quiet_NaN();
  if (entry.problem.exact && solution.status.ok()) {
    const std::vector<Float128> exact = entry.problem.exact(ivp.t1);
    double sum = 0.0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
      sum += std::pow(static_cast<double>(Float128(solution.state[static_cast<Index>(i)]) - exact[i]), 2);
    }
    end_error = std::sqrt(sum);
  }
  result.summary = summary_row(entry.label, call, step, solution.time, end_error, solution.status, result);
  return result;
}

/// ẏ = f(t, y) on a grid: (t, y) for one unknown, (y₁, y₂) at each of `times` for two.
struct FieldGrid {
  std::vector<double> lower, upper;
  std::vector<std::int64_t> counts;
  std::vector<double> times;  ///< [s]
};

CaseResult sample_field(const StudyProblem& entry, const FieldGrid& grid) {
  const Ivp& ivp = entry.problem.ivp;
  const bool scalar = ivp.system->size() == 1;
  const std::vector<double> field_times = scalar ? std::vector<double>{ivp.t0} : grid.times;
  std::vector<double> times, states, slopes;
  Vector y(ivp.system->size()), slope(ivp.system->size());
  const auto coordinate = [&](std::size_t axis, std::int64_t k) {
    return grid.lower[axis] + (grid.upper[axis] - grid.lower[axis]) * static_cast<double>(k) /
                                  static_cast<double>(grid.counts[axis] - 1);
  };
  for (const double field_time : field_times) {
    for (std::int64_t j = 0; j < grid.counts[1]; ++j) {
      for (std::int64_t i = 0; i < grid.counts[0]; ++i) {
        const double t = scalar ? coordinate(0, i) : field_time;
        if (scalar) {
          y[0] = coordinate(1, j);
        } else {
          y << coordinate(0, i), coordinate(1, j);
        }
        ivp.system->rhs(t, y, slope);
        times.push_back(t);
        states.insert(states.end(), y.data(), y.data() + y.size());
        slopes.insert(slopes.end(), slope.data(), slope.data() + slope.size());
      }
    }
  }
  const auto size = static_cast<std::uint64_t>(ivp.system->size());
  CaseResult result;
  result.verdict = Verdict::not_applicable;
  result.reason = "sampled right-hand side";
  result.columns = {{"field_t", "s", times, {}, {}},
                    {"field_y", "SI", states, {times.size(), size}, {}},
                    {"field_dydt", "SI/s", slopes, {times.size(), size}, {}}};
  const double none = std::numeric_limits<double>::quiet_NaN();
  result.summary = summary_row(entry.label, "vector field", none, none, none, {}, result);
  return result;
}

FieldGrid read_field(const CheckedTable& table, const Ivp& ivp) {
  FieldGrid grid{table.numbers("lower"), table.numbers("upper"), table.integers("counts", 2, 1000), {ivp.t0}};
  if (table.has("times")) {
    grid.times = table.numbers("times");
    if (grid.times.empty()) table.fail("times", "found an empty list, expected at least one time");
    if (ivp.system->size() == 1)
      table.fail("times", "found with one unknown, whose grid has the time as an axis");
  }
  const auto check = [&](const char* key, std::size_t found) {
    if (found != 2) table.fail(key, fmt::format("found {} entries, expected 2", found));
  };
  check("lower", grid.lower.size());
  check("upper", grid.upper.size());
  check("counts", grid.counts.size());
  return grid;
}

/// Throws InputError where the method cannot go through the interval with this step.
void check_step(const MethodInfo& info, const Ivp& ivp, double step) {
  if (info.is_multistep) {
    count_whole_steps(info.name, ivp.t0, ivp.t1, step);
  } else {
    count_steps(ivp.t0, ivp.t1, step);
  }
}

void read_simulate(const CheckedTable& spec, const Catalog& catalog, bool quick, Plan& plan) {
  const std::vector<std::string> methods = read_methods(spec, catalog);
  const std::vector<double> steps =
      spec.has("steps") ? spec.numbers("steps", NumberRule::positive) : std::vector<double>{};
  const CheckedTable tolerances = spec.table_or_empty("tolerances");
  const AdaptiveStep adaptive{
      .relative_tolerance = tolerances.number_or("relative", 1e-8, NumberRule::positive),
      .absolute_tolerance = tolerances.number_or("absolute", 1e-10, NumberRule::positive)};
  const auto all_frames = spec.integer_or("frames", 101, 2, 10'000'000);
  const auto quick_frames = spec.table_or_empty("quick").integer_or(
      "frames", std::min<std::int64_t>(all_frames, 101), 2, 10'000'000);
  const auto frames = static_cast<std::uint64_t>(quick ? quick_frames : all_frames);

  const std::int64_t construction = spec.integer_or("construction_steps", 0, 0, 1000);

  std::shared_ptr<const StudyProblem> first;
  for (StudyProblem& entry : read_problems(spec, catalog, plan.warnings)) {
    const auto problem = std::make_shared<const StudyProblem>(std::move(entry));
    if (!first) first = problem;
    if (construction > 0 && problem->problem.ivp.system->size() != 1) {
      spec.fail("construction_steps", fmt::format("problem \"{}\" has {} unknowns, expected 1",
                                                  problem->label, problem->problem.ivp.system->size()));
    }
    for (std::size_t i = 0; i < methods.size(); ++i) {
      const std::string& call = methods[i];
      const std::shared_ptr<const Integrator> integrator = catalog.method(call);
      if (const std::string why = why_not_applicable(integrator->info(), *problem->problem.ivp.system);
          !why.empty()) {
        spec.fail("methods", {i}, fmt::format("\"{}\" (problem \"{}\"): {}", call, problem->label, why));
      }
      const auto add = [&](const StepControl& control, const std::string& suffix,
                           const std::string& identity) {
        plan.cases.push_back(
            {.id = group_name(fmt::format("{}-{}{}", problem->label, call, suffix)),
             .identity = fmt::format("simulate\n{}method = {}\nframes = {}\nconstruction = {}\n{}",
                                     problem->identity, call, frames, construction, identity),
             .run = [problem, call, integrator, control, frames, construction](const RunContext& context) {
               return run_trajectory(*problem, call, *integrator, control, frames, construction, context);
             }});
      };
      const bool by_tolerances =
          integrator->info().is_adaptive && (steps.empty() || !integrator->info().has_fixed_step);
      if (by_tolerances) {
        add(adaptive, "",
            fmt::format("relative = {}\nabsolute = {}\n", adaptive.relative_tolerance,
                        adaptive.absolute_tolerance));
        continue;
      }
      if (steps.empty())
        spec.fail("steps", fmt::format("missing or empty, but method \"{}\" has a fixed step", call));
      for (std::size_t k = 0; k < steps.size(); ++k) {
        const double step = steps[k];
        try {
          check_step(integrator->info(), problem->problem.ivp, step);
        } catch (const InputError& error) {
          spec.fail("steps", {k}, fmt::format("{} (problem \"{}\")", error.what(), problem->label));
        }
        add(FixedStep{.step = step}, fmt::format("-h{}", step), fmt::format("step = {}\n", step));
      }
    }
  }
  if (spec.has("vector_field")) {
    const CheckedTable table = spec.table("vector_field");
    const FieldGrid grid = read_field(table, first->problem.ivp);
    if (first->problem.ivp.system->size() > 2) {
      throw InputError(fmt::format("{}: the vector field of \"{}\" has {} components, expected 1 or 2",
                                   table.where(), first->label, first->problem.ivp.system->size()));
    }
    plan.cases.push_back({.id = "vector_field",
                          .identity = "vector field\n" + first->identity + table.to_toml_text(),
                          .run = [first, grid](const RunContext&) { return sample_field(*first, grid); }});
  }
}

}  // namespace

StudyKind simulate_kind() {
  return {.name = "simulate",
          .title = "Trajectories",
          .description = "states over time for every method, step and problem, with the exact solution",
          .read = read_simulate};
}

}  // namespace fw::study
