#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>

#include "app/commands.hpp"
#include "app/input_kind.hpp"
#include "app/output_file.hpp"
#include "catalog/equilibrium.hpp"
#include "core/error.hpp"
#include "mechanics/mass_spring_system.hpp"
#include "scene/scene.hpp"
#include "store/mass_spring_quantities.hpp"
#include "store/trajectory_writer.hpp"
#include "text/json_writer.hpp"

namespace fw::app {

namespace {

struct EquilibriumArguments {
  std::string scene, solver = "kinsol", output;
  bool as_json = false;
};

/// What is said of a search.
struct Report {
  catalog::Equilibrium found;
  catalog::LowestMode lowest{};
  double largest_displacement = 0.0;  ///< [m]
  Index farthest = 0;                 ///< the particle that is displaced so far
  double potential_before = 0.0, potential_after = 0.0;

  const char* stability() const {
    if (!lowest.status.ok()) return "not known";
    return lowest.is_stable() ? "stable" : lowest.is_unstable() ? "unstable" : "indifferent";
  }
};

void print(const Report& report, const EquilibriumArguments& arguments) {
  const auto line = [](const char* label, const std::string& value) {
    fmt::print("  {:<22} {}\n", label, value);
  };
  fmt::print("static equilibrium of {}\n", arguments.scene);
  line("largest force",
       fmt::format("{:.3g} N (at the start {:.6g} N)", report.found.residual, report.found.first_force));
  line("search", fmt::format("{}, tangent \"{}\", {} iterations", arguments.solver, report.found.tangent,
                             report.found.iterations));
  line("largest displacement",
       fmt::format("{:.6g} m, of particle {}", report.largest_displacement, report.farthest));
  line("potential energy",
       fmt::format("{:.6g} J (at the start {:.6g} J)", report.potential_after, report.potential_before));
  std::string mode = report.stability();
  if (!report.lowest.status.ok()) {
    mode += ": " + report.lowest.status.describe();
  } else if (report.lowest.is_stable()) {
    mode += fmt::format(", lowest frequency {:.6g} Hz",
                        std::sqrt(report.lowest.lambda) / (2.0 * std::numbers::pi));
  } else if (report.lowest.is_unstable()) {
    mode += fmt::format(", a disturbance grows e-fold in {:.3g} s without damping",
                        1.0 / std::sqrt(-report.lowest.lambda));
  } else {
    mode += ", something moves without force";
  }
  line("stability", mode);
  if (!arguments.output.empty()) line("written to", arguments.output);
}

void print_json(const Report& report, const EquilibriumArguments& arguments, ConstVectorRef position) {
  text::JsonWriter json;
  json.begin_object();
  json.key("scene").value(arguments.scene).key("solver").value(arguments.solver);
  json.key("tangent").value(report.found.tangent);
  json.key("iterations").value(report.found.iterations);
  json.key("force_evaluations").value(report.found.force_evaluations);
  json.key("residual").value(report.found.residual).key("first_force").value(report.found.first_force);
  json.key("largest_displacement").value(report.largest_displacement);
  json.key("farthest_particle").value(static_cast<std::int64_t>(report.farthest));
  json.key("potential_energy").value(report.potential_after);
  json.key("potential_energy_start").value(report.potential_before);
  json.key("stability").value(report.stability());
  json.key("lowest_omega_squared").value(report.lowest.lambda);
  json.key("position").begin_array();
  for (Index i = 0; i < position.size(); i += 3) {
    json.begin_array();
    for (Index c = 0; c < 3; ++c) json.value(position[i + c]);
    json.end_array();
  }
  json.end_array().end_object();
  fmt::print("{}\n", json.text());
}

/// A trajectory of one frame at rest, from which `simulate --from` starts.
void write(const EquilibriumArguments& arguments, const std::string& command_line, const scene::Scene& scene,
           const mechanics::MassSpringSystem& system, const Report& report) {
  const store::FileHeader header{
      .kind = "trajectory", .title = scene.title, .command_line = command_line, .spec = scene.resolved_toml};
  store::TrajectoryWriter writer(arguments.output, header, system.model(), store::quantities_of(system), 1);
  Vector state = Vector::Zero(2 * report.found.position.size());
  state.head(report.found.position.size()) = report.found.position;
  writer.frame(0.0, state);
  Work work;
  work.newton_iterations = report.found.iterations;
  work.rhs_evaluations = report.found.force_evaluations;
  writer.finish(report.found.status, work);
}

int find(const EquilibriumArguments& arguments, const std::string& command_line) {
  const scene::Scene scene = read_scene_for(arguments.scene, "equilibrium");
  for (const std::string& warning : scene.warnings) fmt::print(stderr, "federwerk: warning: {}\n", warning);
  if (!arguments.output.empty()) prepare_output_file(arguments.output);
  const mechanics::MassSpringSystem system(scene.model);
  Report report{.found = catalog::find_equilibrium(system, scene.position, 0.0, arguments.solver),
                .lowest = {}};
  if (!report.found.status.ok()) {
    fmt::print(
        stderr,
        "federwerk: {}: no static equilibrium was found, largest force {:.3g} N: {}; expected a system "
        "that is held against its weight\n",
        arguments.scene, report.found.residual, report.found.status.message);
    return exit_failure;
  }
  report.lowest = catalog::lowest_mode(system, report.found.position);
  for (Index i = 0; i < scene.position.size(); i += 3) {
    const double moved = (report.found.position.segment<3>(i) - scene.position.segment<3>(i)).norm();
    if (moved <= report.largest_displacement) continue;
    report.largest_displacement = moved;
    report.farthest = i / 3;
  }
  const Vector rest = Vector::Zero(scene.position.size());
  report.potential_before = system.energies(0.0, scene.position, rest).potential();
  report.potential_after = system.energies(0.0, report.found.position, rest).potential();
  if (!arguments.output.empty()) write(arguments, command_line, scene, system, report);
  if (arguments.as_json) {
    print_json(report, arguments, report.found.position);
  } else {
    print(report, arguments);
  }
  return exit_success;
}

}  // namespace

void add_equilibrium_command(CLI::App& app, Action& action, const std::string& command_line) {
  CLI::App* command = app.add_subcommand(
      "equilibrium", "Finds where the forces of a scene vanish, and whether it is stable there");
  auto arguments = std::make_shared<EquilibriumArguments>();
  command->add_option("scene", arguments->scene, "Scene file (TOML)")->required()->type_name("SCENE.toml");
  std::string solvers;
  for (const catalog::EquilibriumSolver& solver : catalog::equilibrium_solvers()) {
    solvers += fmt::format("{}{} ({})", solvers.empty() ? "" : ", ", solver.name, solver.description);
  }
  command->add_option("--solver", arguments->solver, solvers)->capture_default_str()->type_name("NAME");
  command
      ->add_option("-o,--output", arguments->output,
                   "Result file with the equilibrium as its one frame, for \"simulate --from\"")
      ->type_name("FILE.h5");
  command->add_flag("--json", arguments->as_json, "As JSON, with all positions");
  command->callback(
      [=, &action] { action = [arguments, command_line] { return find(*arguments, command_line); }; });
}

}  // namespace fw::app
