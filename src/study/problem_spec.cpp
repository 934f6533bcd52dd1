#include "study/problem_spec.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "core/error.hpp"
#include "mechanics/mass_spring_system.hpp"
#include "scene/scene.hpp"

namespace fw::study {

namespace {

ProblemParameters read_parameters(const CheckedTable& section) {
  ProblemParameters parameters;
  if (!section.has("parameters")) return parameters;
  const CheckedTable table = section.table("parameters");
  for (const std::string& name : table.keys()) parameters[name] = table.number(name);
  return parameters;
}

std::vector<Invariant> energy_of(const std::shared_ptr<const mechanics::MassSpringSystem>& system) {
  const Index n = system->degrees_of_freedom();
  return {{"energy", "J",
           [system, n](double, ConstVectorRef y) { return system->energies(y.head(n), y.tail(n)).total(); }}};
}

/// The scene as a problem on [0, t_end].
Problem problem_from_scene(scene::Scene scene, const std::string& name, double t_end) {
  const bool has_kinks =
      scene.model.springs.law == mechanics::SpringLaw::tension_only || !scene.model.obstacles.empty();
  Problem problem;
  problem.name = name;
  problem.title = scene.title;
  problem.is_smooth = !has_kinks;
  problem.ivp.y0 = initial_state(scene);
  problem.ivp.t1 = t_end;
  auto system = std::make_shared<const mechanics::MassSpringSystem>(std::move(scene.model));
  if (system->force_class() == ForceClass::position) problem.invariants = energy_of(system);
  problem.ivp.system = std::move(system);
  return problem;
}

StudyProblem read_problem(const CheckedTable& section, const Catalog& catalog,
                          std::vector<std::string>& warnings) {
  StudyProblem entry;
  if (section.has("scene") == section.has("name")) {
    throw InputError(fmt::format("{}: found {} of \"name\" and \"scene\", expected exactly one",
                                 section.where(), section.has("name") ? "both" : "none"));
  }
  if (section.has("scene")) {
    const std::filesystem::path path =
        std::filesystem::path(section.source_name()).parent_path() / section.string("scene");
    const double t_end = section.positive_number("t_end");
    try {
      scene::Scene scene = scene::read_scene(path);
      warnings.insert(warnings.end(), scene.warnings.begin(), scene.warnings.end());
      entry.scene_toml = scene.resolved_toml;
      entry.problem = problem_from_scene(std::move(scene), path.stem().string(), t_end);
    } catch (const InputError& error) {
      section.fail("scene", error.what());
    }
    entry.label = section.string_or("label", path.stem().string());
    entry.identity = entry.scene_toml;
  } else {
    const std::string name = section.string("name");
    const ProblemParameters parameters = read_parameters(section);
    try {
      entry.problem = catalog.problem(name, parameters);
    } catch (const InputError& error) {
      section.fail("name", error.what());
    }
    entry.problem.ivp.t1 = section.number_or("t_end", entry.problem.ivp.t1);
    if (entry.problem.ivp.t1 <= entry.problem.ivp.t0) {
      section.fail("t_end", fmt::format("found {}, expected more than the start {}", entry.problem.ivp.t1,
                                        entry.problem.ivp.t0));
    }
    entry.label = section.string_or("label", name);
    entry.identity = fmt::format("problem = {}\nparameters = {}\n", name, entry.problem.parameters);
  }
  entry.identity += fmt::format("\nt0 = {}\nt1 = {}\n", entry.problem.ivp.t0, entry.problem.ivp.t1);
  return entry;
}

}  // namespace

std::vector<StudyProblem> read_problems(const CheckedTable& spec, const Catalog& catalog,
                                        std::vector<std::string>& warnings) {
  std::vector<StudyProblem> problems;
  for (const CheckedTable& section : spec.tables("problem"))
    problems.push_back(read_problem(section, catalog, warnings));
  if (problems.empty()) {
    throw InputError(fmt::format("{}: found no [[problem]], expected at least one", spec.source_name()));
  }
  return problems;
}

std::vector<std::string> read_methods(const CheckedTable& spec, const Catalog& catalog) {
  std::vector<std::string> methods = spec.strings("methods");
  if (methods.empty()) spec.fail("methods", "found an empty list, expected at least one method");
  for (std::size_t i = 0; i < methods.size(); ++i) {
    try {
      catalog.method(methods[i]);
    } catch (const InputError& error) {
      spec.fail("methods", {i}, error.what());
    }
  }
  return methods;
}

}  // namespace fw::study
