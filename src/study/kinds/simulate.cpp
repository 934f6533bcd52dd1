#include "study/kinds/simulate.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <memory>

#include "core/error.hpp"
#include "record/frame_selector.hpp"
#include "settings/identity_text.hpp"
#include "study/kinds/sampled_field.hpp"
#include "study/kinds/step_construction.hpp"
#include "study/measure/energy_gauge.hpp"
#include "study/problem_spec.hpp"

namespace fw::study {

namespace {

using settings::Archive;
using settings::setting;

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

/// The row of the summary.
struct SimulateRow {
  std::string problem, method;
  double step = std::numeric_limits<double>::quiet_NaN();
  double end_time = std::numeric_limits<double>::quiet_NaN();
  double end_error = std::numeric_limits<double>::quiet_NaN();
  std::int64_t rhs_evaluations = 0;
  double seconds = std::numeric_limits<double>::quiet_NaN();
  Status status{};
  std::string frame_origin{}, frame_spacing{};
};

void declare(SummaryRow& a, const SimulateRow& row) {
  a("problem", "", row.problem, "its label");
  a("method", "", row.method, "as in the study; `vector field` in that case");
  a("step", "s", row.step, "NaN if the method chooses its steps, and of the vector field");
  a("end_time", "s", row.end_time, "where the run ended; NaN of the vector field");
  a("end_error", "SI", row.end_error, "‖y − exact‖₂ at the end; NaN without closed form or end");
  a("rhs_evaluations", "1", row.rhs_evaluations, "right-hand sides of the run");
  a("seconds", "s", row.seconds, "wall time of the run, writing of frames included; NaN of the vector field");
  a("status", "", to_string(row.status.code), "`success`, or code of why the solver stopped");
  a("frame_origin", "", row.frame_origin,
    "how the states of frames came about: `ends of steps`, or `dense output of order p: …`");
  a("frame_spacing", "", row.frame_spacing,
    "of frames in time: `even`, `even but for the last`, or `uneven`");
}

/// The energies of the frames, of states with `size` numbers.
void add_energies(const EnergyGauge& gauge, const FrameColumns& frames, std::uint64_t size,
                  CaseResult& result) {
  if (!gauge.is_known()) return;
  std::vector<double> kinetic, potential, total;
  for (std::size_t k = 0; k < frames.times().size(); ++k) {
    const ConstVectorMap state(frames.states().data() + k * size, static_cast<Index>(size));
    const auto [moving, stored] = gauge.energies(frames.times()[k], state);
    kinetic.push_back(moving);
    potential.push_back(stored);
    total.push_back(moving + stored);
  }
  result.columns.push_back({"kinetic_energy", "J", kinetic, {}, {}});
  result.columns.push_back({"potential_energy", "J", potential, {}, {}});
  result.columns.push_back({"total_energy", "J", total, {}, {}});
}

CaseResult run_trajectory(const StudyProblem& entry, const std::string& call, const Integrator& integrator,
                          const StepControl& control, std::optional<std::uint64_t> frames,
                          std::int64_t construction, const RunContext& context) {
  const Ivp& ivp = entry.problem.ivp;
  FrameColumns columns;
  const record::FramePlan plan(ivp.t0, ivp.t1, control, frames);
  record::FrameSelector selector(plan, columns);
  const EnergyGauge gauge(entry.problem);
  EnergyWatch watch(gauge, selector);
  Solution solution = context.solve(integrator, ivp, control, watch);
  const bool reached_end = solution.status.ok();
  solution.status = watch.judged(solution.status);

  CaseResult result;
  // A study of trajectories claims nothing: a run that diverges by theory is done like one that does not.
  // Numbers that are finite to the end and yet an explosion: a picture worth drawing, but no success.
  result.verdict = solution.status.ok() ? Verdict::done
                   : reached_end        ? Verdict::not_applicable
                                        : Verdict::fails;
  result.reason = solution.status.ok() ? "reached the end" : solution.status.describe();
  const record::FrameOrigin origin = plan.origin(integrator.info(), *ivp.system);
  if (origin.spacing == "uneven") result.reason += "; frames are unevenly spaced";
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
  add_energies(gauge, columns, size, result);
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
  if (entry.problem.exact && reached_end) {
    const std::vector<Float128> exact = entry.problem.exact(ivp.t1);
    double sum = 0.0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
      sum += std::pow(static_cast<double>(Float128(solution.state[static_cast<Index>(i)]) - exact[i]), 2);
    }
    end_error = std::sqrt(sum);
  }
  result.summary =
      cells_of(SimulateRow{.problem = entry.label,
                           .method = call,
                           .step = step,
                           .end_time = solution.time,
                           .end_error = end_error,
                           .rhs_evaluations = static_cast<std::int64_t>(solution.work.rhs_evaluations),
                           .seconds = solution.work.seconds,
                           .status = solution.status,
                           .frame_origin = origin.states,
                           .frame_spacing = origin.spacing});
  return result;
}

/// Tolerances of methods that choose their own steps.
struct Tolerances {
  double relative = 1e-8, absolute = 1e-10;
  std::optional<double> absolute_velocity, maximum_step;
};

void declare(Archive& a, Tolerances& tolerances) {
  a(setting("relative", tolerances.relative)
        .unit("1")
        .positive()
        .doc("of methods that choose their own steps"));
  a(setting("absolute", tolerances.absolute).unit("SI").positive().doc("likewise"));
  a(setting("absolute_velocity", tolerances.absolute_velocity)
        .unit("m/s")
        .positive()
        .doc("absolute tolerance of velocities where it is another number"));
  a(setting("maximum_step", tolerances.maximum_step)
        .unit("s")
        .positive()
        .default_text("none")
        .doc("the longest step that they may take"));
}

struct SimulateSpec {
  std::vector<std::string> methods;
  std::optional<std::vector<double>> steps;
  std::int64_t frames = 0;  ///< 0: the default
  std::int64_t construction_steps = 0;
  Tolerances tolerances;
  std::optional<FieldSpec> field;
  std::vector<ProblemSpec> problems;
};

void declare(Archive& a, SimulateSpec& spec) {
  a(methods_setting(spec.methods));
  a(setting("steps", spec.steps)
        .unit("s")
        .positive()
        .default_text("required if a method has a fixed step")
        .doc("of `verlet*`, the interval has to be a whole number of steps"));
  a(setting("frames", spec.frames)
        .integers(2, 10'000'000)
        .or_word("auto", 0)
        .quick_at_most(101)
        .doc("states that are stored, from start to end inclusive; `auto`: 101, of constant steps about as "
             "many at equal spacing"));
  a(setting("construction_steps", spec.construction_steps)
        .integers(0, 1000)
        .doc("of a scalar equation: how so many first steps come about (slopes at both ends, solutions "
             "through "
             "both), for plots"));
  a.section({"tolerances", "Of methods that choose their own steps."}, spec.tolerances);
  a.optional_section({"vector_field",
                      "Samples of ẏ = f(t, y) of the first problem, which must have one or two "
                      "unknowns, for plots."},
                     spec.field);
  a.sections(problem_sections, spec.problems);
  a.quick_section();
}

/// Throws InputError where the method cannot go through the interval with this step.
void check_step(const MethodInfo& info, const Ivp& ivp, double step) {
  if (step > ivp.t1 - ivp.t0) {
    throw InputError(
        fmt::format("found {}, expected at most the whole interval of {:.6g} s", step, ivp.t1 - ivp.t0));
  }
  if (info.is_multistep) {
    count_whole_steps(info.name, ivp.t0, ivp.t1, step);
  } else {
    count_steps(ivp.t0, ivp.t1, step);
  }
}

void plan_simulate(const SimulateSpec& study, const StudyInput& input, Plan& plan) {
  const CheckedTable& spec = input.file;
  const Catalog& catalog = input.catalog;
  const std::vector<std::string>& methods = checked_methods(study.methods, spec, catalog);
  const std::vector<double> steps = study.steps.value_or(std::vector<double>());
  AdaptiveStep adaptive{.relative_tolerance = study.tolerances.relative,
                        .absolute_tolerance = study.tolerances.absolute};
  std::string identity_of_limit;  // none: the identity that the case had before there was one
  if (study.tolerances.absolute_velocity) {
    adaptive.absolute_velocity_tolerance = *study.tolerances.absolute_velocity;
    identity_of_limit = fmt::format("absolute velocity = {}\n", adaptive.absolute_velocity_tolerance);
  }
  if (study.tolerances.maximum_step) {
    adaptive.maximum_step = *study.tolerances.maximum_step;
    identity_of_limit += fmt::format("maximum step = {}\n", adaptive.maximum_step);
  }
  std::optional<std::uint64_t> frames;
  if (study.frames > 0) frames = static_cast<std::uint64_t>(study.frames);
  const std::string frames_text = frames ? std::to_string(*frames) : "auto";
  const std::int64_t construction = study.construction_steps;

  std::shared_ptr<const StudyProblem> first;
  for (StudyProblem& entry : make_problems(study.problems, input, plan.warnings)) {
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
        const auto* fixed = std::get_if<FixedStep>(&control);
        plan.cases.push_back(
            {.id = group_name(fmt::format("{}-{}{}", problem->label, call, suffix)),
             .identity = fmt::format("simulate\n{}method = {}\nframes = {}\nconstruction = {}\n{}",
                                     problem->identity, call, frames_text, construction, identity),
             .run =
                 [problem, call, integrator, control, frames, construction](const RunContext& context) {
                   return run_trajectory(*problem, call, *integrator, control, frames, construction, context);
                 },
             .known = {{"problem", problem->label},
                       {"method", call},
                       {"step", fixed != nullptr ? fixed->step : std::numeric_limits<double>::quiet_NaN()}}});
      };
      const bool by_tolerances =
          integrator->info().is_adaptive && (steps.empty() || !integrator->info().has_fixed_step);
      if (by_tolerances) {
        add(adaptive, "",
            fmt::format("relative = {}\nabsolute = {}\n{}", adaptive.relative_tolerance,
                        adaptive.absolute_tolerance, identity_of_limit));
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
  if (study.field) {
    const CheckedTable table = spec.table("vector_field");
    if (first->problem.ivp.system->size() > 2) {
      throw InputError(fmt::format("{}: the vector field of \"{}\" has {} components, expected 1 or 2",
                                   table.where(), first->label, first->problem.ivp.system->size()));
    }
    const FieldGrid grid = field_grid(*study.field, table, first->problem.ivp);
    plan.cases.push_back(
        {.id = "vector_field",
         .identity = "vector field\n" + first->identity + settings::identity_text(*study.field),
         .run =
             [first, grid](const RunContext&) {
               CaseResult result = sample_field(first->problem.ivp, grid);
               result.summary = cells_of(SimulateRow{.problem = first->label, .method = "vector field"});
               return result;
             },
         .known = {{"problem", first->label}, {"method", "vector field"}}});
  }
}

}  // namespace

StudyKind simulate_kind() {
  return declared_kind<SimulateSpec>(
      {.name = "simulate",
       .title = "Trajectories",
       .description = "states over time for every method, step and problem, with the exact solution",
       .summary = columns_of<SimulateRow>(),
       .verdict_meaning =
           "`done`: reached the end, nothing is claimed; `not applicable`: with an energy from nowhere; "
           "`fails`: stopped before the end",
       .reason_meaning = ""},
      plan_simulate);
}

}  // namespace fw::study
