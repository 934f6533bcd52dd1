#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>

#include "app/checkpoint_writer.hpp"
#include "app/commands.hpp"
#include "app/continued_run.hpp"
#include "app/input_kind.hpp"
#include "app/interrupt.hpp"
#include "app/output_file.hpp"
#include "app/progress_bar.hpp"
#include "app/run_notes.hpp"
#include "app/start_state.hpp"
#include "catalog/methods.hpp"
#include "core/error.hpp"
#include "mechanics/mass_spring_system.hpp"
#include "record/frame_selector.hpp"
#include "scene/scene.hpp"
#include "store/checkpoint_file.hpp"
#include "store/mass_spring_quantities.hpp"
#include "store/trajectory_writer.hpp"
#include "store/xdmf.hpp"
#include "study/measure/energy_gauge.hpp"
#include "system/terminal.hpp"
#include "text/wrapped_lines.hpp"

namespace fw::app {

namespace {

constexpr std::int64_t largest_frame_count = 1'000'000'000;

/// Passes steps on to the frames and shows progress.
class SimulationObserver final : public Observer {
 public:
  SimulationObserver(record::FrameSelector& frames, double end_time)
      : frames_(frames), end_time_(end_time), bar_("steps") {}

  bool observe(const StepView& view) override {
    frames_.observe(view);
    if (bar_.is_due()) {
      bar_.update(view.time / end_time_, static_cast<double>(view.index),
                  fmt::format("t = {:.4g} s", view.time));
    }
    return true;
  }
  void finish() { bar_.clear(); }

 private:
  record::FrameSelector& frames_;
  double end_time_;
  ProgressBar bar_;
};

StepControl step_control(const SimulateArguments& arguments, const MethodInfo& info) {
  const bool has_tolerances =
      arguments.has_relative || arguments.has_absolute || arguments.has_velocity_tolerance;
  if (arguments.has_step && std::isfinite(arguments.maximum_step))
    throw InputError("found --step and --maximum-step, expected one of them");
  if (arguments.has_step && has_tolerances)
    throw InputError("found --step and tolerances, expected either --step or --rtol and --atol");
  if (arguments.has_step && !info.has_fixed_step) {
    throw InputError(
        fmt::format("--step: method \"{}\" chooses its own steps, expected --rtol and --atol", info.name));
  }
  if (has_tolerances && !info.is_adaptive) {
    throw InputError(fmt::format("tolerances: method \"{}\" has a fixed step, expected --step", info.name));
  }
  if (info.is_adaptive && !arguments.has_step) {
    if (!arguments.has_relative || !arguments.has_absolute) {
      throw InputError(fmt::format("method \"{}\" chooses its own steps: expected --rtol and --atol{}",
                                   info.name, info.has_fixed_step ? ", or --step for a constant step" : ""));
    }
    const auto check = [](const char* option, double value) {
      if (!std::isfinite(value) || value <= 0.0) {
        throw InputError(fmt::format("{}: found {}, expected a finite number > 0", option, value));
      }
    };
    check("--rtol", arguments.relative_tolerance);
    check("--atol", arguments.absolute_tolerance);
    if (arguments.has_velocity_tolerance) check("--atol-velocity", arguments.velocity_tolerance);
    if (!(arguments.maximum_step > 0.0)) {
      throw InputError(
          fmt::format("--maximum-step: found {}, expected a number of seconds > 0", arguments.maximum_step));
    }
    return AdaptiveStep{.relative_tolerance = arguments.relative_tolerance,
                        .absolute_tolerance = arguments.absolute_tolerance,
                        .absolute_velocity_tolerance = arguments.velocity_tolerance,
                        .maximum_step = arguments.maximum_step};
  }
  if (!arguments.has_step) {
    throw InputError(fmt::format("method \"{}\" has a fixed step: expected --step", info.name));
  }
  if (!std::isfinite(arguments.step) || arguments.step <= 0.0) {
    throw InputError(fmt::format("--step: found {}, expected a finite number > 0", arguments.step));
  }
  return FixedStep{.step = arguments.step};
}

/// Refuses a step that does not divide the interval if the method needs that. How the interval divides.
StepCount check_interval(const StepControl& control, const MethodInfo& info, double end_time) {
  const auto* fixed = std::get_if<FixedStep>(&control);
  if (fixed == nullptr) return {};
  return info.is_multistep ? count_whole_steps(info.name, 0.0, end_time, fixed->step)
                           : count_steps(0.0, end_time, fixed->step);
}

void tell_of_short_last_step(const StepControl& control, const StepCount& count, double end_time) {
  const auto* fixed = std::get_if<FixedStep>(&control);
  if (fixed != nullptr && count.remainder > 0.0) {
    fmt::print(
        stderr,
        "federwerk: note: the end time {} is not a whole number of steps {}; the last step is {:.6g} s\n",
        end_time, fixed->step, count.remainder);
  }
}

std::string default_output(const SimulateArguments& arguments) {
  std::string method = arguments.method;
  for (char& letter : method) {
    if (!std::isalnum(static_cast<unsigned char>(letter)) && letter != '_' && letter != '-') letter = '_';
  }
  return std::filesystem::path(arguments.scene).stem().string() + "-" + method + ".h5";
}

void print_summary(const std::string& output, const Solution& solution, std::uint64_t frames,
                   const record::FrameOrigin& origin, std::uint64_t degenerate) {
  const std::string summary =
      fmt::format("{} frames{} to t = {:.6g} s, {} steps, {} right-hand sides, {:.3g} s", frames,
                  origin.spacing == "uneven" ? ", unevenly spaced," : "", solution.time,
                  solution.work.accepted_steps, solution.work.rhs_evaluations, solution.work.seconds);
  fmt::print("{}", text::wrapped_paragraph(output + ": ", summary, terminal_width(STDOUT_FILENO), 2));
  if (degenerate > 0) {
    fmt::print(stderr,
               "federwerk: note: a spring of length zero was met {} times; its direction is undefined, its "
               "force was "
               "taken as zero\n",
               degenerate);
  }
}

/// The method with --petsc as its option of that name.
std::unique_ptr<Integrator> make_method(const SimulateArguments& arguments) {
  catalog::MethodCall call = catalog::parse_method_call(arguments.method);
  if (!arguments.has_petsc) return catalog::make_method(call);
  const auto& options = catalog::find_method(call.name).options;
  if (std::none_of(options.begin(), options.end(),
                   [](const auto& option) { return option.info.name == "petsc"; })) {
    throw InputError(fmt::format("--petsc: method \"{}\" takes no options of PETSc", call.name));
  }
  if (!call.options.emplace("petsc", arguments.petsc).second) {
    throw InputError("found --petsc and the option petsc of --method, expected one of them");
  }
  return catalog::make_method(call);
}

int simulate(SimulateArguments arguments, const std::string& command_line) {
  std::optional<store::Checkpoint> from;
  if (!arguments.continued.empty() && !arguments.from.empty()) {
    throw InputError("found --from and --continue, expected one of them");
  }
  if (!arguments.continued.empty()) {
    from = store::read_checkpoint(arguments.continued);
    take_from_checkpoint(*from, arguments);
  }
  const std::unique_ptr<Integrator> integrator = make_method(arguments);
  const StepControl control = step_control(arguments, integrator->info());
  if (!std::isfinite(arguments.end_time) || arguments.end_time <= 0.0) {
    throw InputError(fmt::format("--t-end: found {}, expected a finite number > 0", arguments.end_time));
  }
  if (arguments.has_frames && (arguments.frames < 2 || arguments.frames > largest_frame_count)) {
    throw InputError(fmt::format("--frames: found {}, expected an integer from 2 to {}", arguments.frames,
                                 largest_frame_count));
  }
  const StepCount count = check_interval(control, integrator->info(), arguments.end_time);
  if (arguments.output.empty()) arguments.output = default_output(arguments);
  check_checkpoint_options(arguments);

  scene::Scene scene =
      from ? scene::parse_scene(from->scene, arguments.scene) : read_scene_for(arguments.scene, "simulate");
  for (const std::string& warning : scene.warnings) fmt::print(stderr, "federwerk: warning: {}\n", warning);
  const store::FileHeader header{
      .kind = "trajectory", .title = scene.title, .command_line = command_line, .spec = scene.resolved_toml};
  Ivp ivp;
  ivp.t1 = arguments.end_time;
  const auto system = std::make_shared<const mechanics::MassSpringSystem>(scene.model);
  ivp.system = system;
  ivp.y0 = from ? first_state(*from, scene) : start_state(scene, *system, arguments.from);
  scene = {};
  std::vector<EventRequest> requests = parse_events(arguments.log_at, arguments.stop_at, *system);
  if (!requests.empty() && (!arguments.checkpoint.empty() || from)) {
    throw InputError(
        "found events and a checkpoint: --log-at and --stop-at do not go with --checkpoint and --continue");
  }
  if (const std::string why = why_not_applicable(integrator->info(), *system); !why.empty()) {
    throw InputError(fmt::format("method \"{}\": {}", integrator->info().name, why));
  }
  prepare_output_file(arguments.output, {.xdmf = arguments.xdmf, .continues = from.has_value()});
  tell_of_short_last_step(control, count, arguments.end_time);
  StepAdvice advice;
  if (const auto* fixed = std::get_if<FixedStep>(&control);
      fixed != nullptr && integrator->info().is_explicit) {
    advice = advise_on_step(arguments.method, fixed->step, *system, ivp.y0);
    if (!advice.warning.empty()) fmt::print(stderr, "federwerk: warning: {}\n", advice.warning);
  }

  const std::atomic<bool>& interrupted = install_interrupt_flag();
  std::optional<std::uint64_t> wanted;
  if (arguments.has_frames) wanted = static_cast<std::uint64_t>(arguments.frames);
  const record::FramePlan plan(ivp.t0, ivp.t1, control, wanted);
  store::TrajectoryWriter writer(arguments.output, header, system->model(), store::quantities_of(*system),
                                 static_cast<Index>(plan.count()));
  const record::FrameOrigin origin = plan.origin(integrator->info(), *ivp.system);
  writer.describe_frames(origin);
  SolveOptions options{.stop = StopToken(interrupted)};
  std::optional<CheckpointWriter> checkpoints;
  if (!arguments.checkpoint.empty()) {
    checkpoints.emplace(arguments.checkpoint, arguments.every,
                        store::Checkpoint{.program = program_name(),
                                          .scene_name = arguments.scene,
                                          .scene = header.spec,
                                          .method = arguments.method,
                                          .petsc = arguments.petsc,
                                          .output = arguments.output,
                                          .control = control,
                                          .end_time = arguments.end_time,
                                          .frames = wanted.value_or(0),
                                          .time = from ? from->time : ivp.t0},
                        options.stop, writer);
    options.checkpoints = &*checkpoints;
  }
  FrameClock clock(checkpoints ? static_cast<record::FrameSink&>(*checkpoints) : writer);
  record::FrameSink& sink = clock;
  record::FrameSelector frames(plan, sink);
  SimulationObserver observer(frames, arguments.end_time);
  std::optional<RunEvents> events;
  if (!requests.empty()) events.emplace(std::move(requests), *system, observer);
  study::EnergyWatch watch(study::EnergyGauge(*system),
                           events ? static_cast<Observer&>(*events) : static_cast<Observer&>(observer));
  if (from) {
    repeat_frames(*from, frames, sink);
    const auto size = static_cast<std::size_t>(ivp.y0.size());
    for (std::size_t k = 0; k < from->frame_times.size(); ++k) {
      watch.add_earlier(from->frame_times[k],
                        ConstVectorMap(from->frame_states.data() + k * size, static_cast<Index>(size)));
    }
    options.resume = from->run;
  }
  Solution solution = integrator->solve(ivp, control, watch, options);
  observer.finish();
  const std::optional<std::string> stopped_at = events ? events->stop(solution) : std::nullopt;
  if (stopped_at) {
    solution.status = {};
    if (clock.time() < solution.time) sink.frame(solution.time, solution.state);
  }
  solution.status = watch.judged(solution.status);
  writer.finish(solution.status, solution.work,
                tell(solution, events ? &*events : nullptr, stopped_at, !arguments.stop_at.empty()));
  if (arguments.xdmf) store::write_xdmf(arguments.output);
  print_summary(arguments.output, solution, frames.written(), origin,
                system->degenerate_spring_evaluations());
  if (!advice.note.empty()) fmt::print("{}\n", advice.note);
  if (!solution.status.ok()) {
    fmt::print(stderr, "federwerk: {}; what was computed is in {}{}\n", solution.status.describe(),
               arguments.output,
               checkpoints && checkpoints->written() > 0 && solution.status.code != StatusCode::blow_up
                   ? fmt::format("; --continue {} goes on from the last checkpoint", arguments.checkpoint)
                   : "");
    return exit_failure;
  }
  return exit_success;
}

}  // namespace

void add_simulate_command(CLI::App& app, Action& action, const std::string& command_line) {
  CLI::App* command = app.add_subcommand("simulate", "Simulates one scene with one method into an HDF5 file");
  auto arguments = std::make_shared<SimulateArguments>();
  CLI::Option* scene =
      command->add_option("scene", arguments->scene, "Scene file (TOML)")->type_name("SCENE.toml");
  CLI::Option* method = command
                            ->add_option("--method", arguments->method,
                                         "Method, for example rk4; see \"federwerk list methods\"")
                            ->type_name("NAME");
  CLI::Option* step =
      command->add_option("--step", arguments->step, "Step [s] of a fixed-step method")->type_name("H");
  CLI::Option* relative =
      command->add_option("--rtol", arguments->relative_tolerance, "Relative tolerance of an adaptive method")
          ->type_name("R");
  CLI::Option* absolute =
      command
          ->add_option("--atol", arguments->absolute_tolerance,
                       "Absolute tolerance of an adaptive method, of positions [m] and velocities [m/s]")
          ->type_name("A");
  CLI::Option* velocity =
      command
          ->add_option("--atol-velocity", arguments->velocity_tolerance,
                       "Absolute tolerance of velocities [m/s] where it is another number")
          ->type_name("A");
  command
      ->add_option("--maximum-step", arguments->maximum_step,
                   "Longest step [s] of an adaptive method, own or foreign; default: none")
      ->type_name("H");
  command
      ->add_option("--log-at", arguments->log_at,
                   "Tell and store when this happens: contact[:PARTICLE], release[:PARTICLE], taut[:SPRING], "
                   "slack[:SPRING], plane:NX,NY,NZ,D[:PARTICLE] (where n·x = D), energy:NAME (an extremum)")
      ->type_name("EVENT")
      ->allow_extra_args(false);
  command
      ->add_option("--stop-at", arguments->stop_at,
                   "End the run where this happens first; events as of --log-at")
      ->type_name("EVENT")
      ->allow_extra_args(false);
  CLI::Option* petsc = command
                           ->add_option("--petsc", arguments->petsc,
                                        "Options of a petsc: method or of the linear solver petsc in PETSc's "
                                        "notation, as \"-ksp_type gmres -pc_type ilu\"")
                           ->type_name("TEXT");
  CLI::Option* end_time =
      command->add_option("--t-end", arguments->end_time, "End time [s]; the start is 0")->type_name("T");
  CLI::Option* frames =
      command
          ->add_option("--frames", arguments->frames,
                       "States to store from start to end inclusive; default: 101, of a fixed step about as "
                       "many at equal spacing")
          ->check(whole_number())
          ->type_name("N");
  command->add_option("-o,--output", arguments->output, "Result file; default: <scene>-<method>.h5")
      ->type_name("FILE.h5");
  command->add_flag("--xdmf", arguments->xdmf, "Also write FILE.xdmf, which ParaView opens");
  command
      ->add_option(
          "--checkpoint", arguments->checkpoint,
          "Keep the run in FILE, so that --continue can go on from it; only for methods of federwerk")
      ->type_name("FILE");
  CLI::Option* every =
      command
          ->add_option(
              "--every", arguments->every,
              "Time between checkpoints [s] of the simulation: one is written after the first step that "
              "reaches a multiple of S, and one where the run is interrupted")
          ->type_name("S");
  command
      ->add_option(
          "--continue", arguments->continued,
          "Go on from a checkpoint, to the same bits as without a stop; scene, method, step, end time "
          "and frames come from it")
      ->type_name("FILE");
  command
      ->add_option(
          "--from", arguments->from,
          "Start at t = 0 from the last frame of a result file (of \"simulate\" or \"equilibrium\") of a "
          "system with as many particles")
      ->type_name("FILE.h5");
  command->callback([=, &action] {
    if (arguments->continued.empty()) {
      for (const CLI::Option* needed : {scene, method, end_time}) {
        if (needed->count() == 0) throw CLI::RequiredError(needed->get_name());
      }
    }
    arguments->has_end_time = end_time->count() > 0;
    arguments->has_frames = frames->count() > 0;
    arguments->has_every = every->count() > 0;
    arguments->has_step = step->count() > 0;
    arguments->has_petsc = petsc->count() > 0;
    arguments->has_relative = relative->count() > 0;
    arguments->has_absolute = absolute->count() > 0;
    arguments->has_velocity_tolerance = velocity->count() > 0;
    action = [arguments, command_line] { return simulate(*arguments, command_line); };
  });
}

}  // namespace fw::app
