#include "study/problem_spec.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>

#include "core/error.hpp"
#include "mechanics/mass_spring_system.hpp"
#include "scene/scene.hpp"
#include "study/parameter_values.hpp"
#include "system/worker_process.hpp"
#include "text/toml_assignment.hpp"

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
  Problem problem;
  problem.name = name;
  problem.title = scene.title;
  problem.ivp.y0 = initial_state(scene);
  problem.ivp.t1 = t_end;
  auto system = std::make_shared<const mechanics::MassSpringSystem>(std::move(scene.model));
  problem.is_smooth = !system->elements().has_kinks();
  if (system->force_class() == ForceClass::position) problem.invariants = energy_of(system);
  problem.ivp.system = std::move(system);
  return problem;
}

/// A scene as a study names it: the file, or what a result file keeps of it.
struct SceneText {
  std::string name;  ///< for messages
  std::string text;
};

SceneText scene_text_of(const CheckedTable& section) {
  const std::filesystem::path path =
      std::filesystem::path(section.source_name()).parent_path() / section.string("scene");
  const std::string kept = section.has("scene_text") ? section.string("scene_text") : "";
  if (!kept.empty()) return {fmt::format("{} (scene_text)", section.string("scene")), kept};
  return {path.string(), scene::read_scene(path).resolved_toml};
}

/// The values of a table [problem.set], whose keys are those of the scene file.
void collect(const CheckedTable& table, const std::string& path, std::vector<TomlAssignment>& assignments) {
  for (const std::string& key : table.keys()) {
    const std::string full = path.empty() ? key : path + "." + key;
    if (table.is_table(key)) {
      collect(table.table(key), full, assignments);
      continue;
    }
    assignments.push_back({full, table.number(key)});
  }
}

/// The number that a member of a family has in place of the problem's own.
struct Variation {
  std::string parameter;
  double value = 0.0;
};

StudyProblem read_problem(const CheckedTable& section, const Catalog& catalog,
                          std::vector<std::string>& warnings,
                          const std::optional<Variation>& variation = {}) {
  StudyProblem entry;
  if (section.has("scene") == section.has("name")) {
    throw InputError(fmt::format("{}: found {} of \"name\" and \"scene\", expected exactly one",
                                 section.where(), section.has("name") ? "both" : "none"));
  }
  if (section.has("scene")) {
    const double t_end = section.positive_number("t_end");
    const std::string stem = std::filesystem::path(section.string("scene")).stem().string();
    try {
      SceneText given = scene_text_of(section);
      const std::string& kept = section.string_or("scene_text", given.text);
      std::vector<TomlAssignment> assignments;
      if (section.has("set")) collect(section.table("set"), "", assignments);
      if (variation) assignments.push_back({variation->parameter, variation->value});
      if (!assignments.empty()) given.text = toml_with(kept, given.name, assignments);
      for (const TomlAssignment& assignment : assignments) given.name += " with " + assignment.text();
      scene::Scene scene = scene::parse_scene(given.text, given.name);
      warnings.insert(warnings.end(), scene.warnings.begin(), scene.warnings.end());
      entry.scene_toml = scene.resolved_toml;
      entry.problem = problem_from_scene(std::move(scene), stem, t_end);
    } catch (const InputError& error) {
      section.fail("scene", error.what());
    }
    entry.label = section.string_or("label", stem);
    entry.identity = entry.scene_toml;
  } else {
    const std::string name = section.string("name");
    ProblemParameters parameters = read_parameters(section);
    if (variation) parameters[variation->parameter] = variation->value;
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

/// Options in PETSc's notation are known to be wrong only when they are used: a few steps of a small system.
/// PETSc and MPI are started for that in a process of their own, since workers are forked from this one. The
/// message of what is wrong, or nothing.
std::string probe(const std::string& call, const Catalog& catalog) {
  return answer_of_a_process([&]() -> std::string {
    try {
      const std::unique_ptr<Integrator> integrator = catalog.method(call);
      Ivp ivp = catalog.problem("linear_chain", {}).ivp;
      ivp.t1 = ivp.t0 + 0.01;
      if (!why_not_applicable(integrator->info(), *ivp.system).empty()) return "";
      NullObserver observer;
      if (integrator->info().has_fixed_step) {
        integrator->solve(ivp, FixedStep{.step = 0.005}, observer);
      } else {
        integrator->solve(ivp, AdaptiveStep{}, observer);
      }
      return "";
    } catch (const std::exception& error) {
      return error.what();
    }
  });
}

/// Throws InputError that names the entry where a call is not one of a method.
void check_call(const CheckedTable& spec, const std::string& key, std::size_t index, const std::string& call,
                const Catalog& catalog) {
  std::string message;
  try {
    catalog.method(call);
    if (call.find("petsc=") != std::string::npos) message = probe(call, catalog);
  } catch (const InputError& error) {
    message = error.what();
  }
  if (!message.empty()) spec.fail(key, {index}, message);
}

/// Whether `text` is `pattern`, in which each * stands for any letters.
bool matches(std::string_view pattern, std::string_view text) {
  const auto star = pattern.find('*');
  if (star == std::string_view::npos) return pattern == text;
  if (text.substr(0, star) != pattern.substr(0, star)) return false;
  const std::string_view rest = pattern.substr(star + 1);
  for (std::size_t from = star; from <= text.size(); ++from) {
    if (matches(rest, text.substr(from))) return true;
  }
  return false;
}

/// The names of the catalogue that fit, or the call itself where it is no pattern.
std::vector<std::string> expand(const CheckedTable& spec, const std::string& key, std::size_t index,
                                const std::string& call, const Catalog& catalog) {
  if (call.find('*') == std::string::npos) {
    check_call(spec, key, index, call, catalog);
    return {call};
  }
  std::vector<std::string> fitting;
  for (const std::string& name : catalog.method_names()) {
    if (matches(call, name)) fitting.push_back(name);
  }
  if (fitting.empty()) spec.fail(key, {index}, fmt::format("found \"{}\", which no method fits", call));
  return fitting;
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

std::vector<ProblemFamily> read_problem_families(const CheckedTable& spec, const Catalog& catalog,
                                                 std::vector<std::string>& warnings) {
  std::vector<ProblemFamily> families;
  for (const CheckedTable& section : spec.tables("problem")) {
    ProblemFamily& family = families.emplace_back();
    if (!section.has("vary")) {
      family.members.push_back(read_problem(section, catalog, warnings));
      family.label = family.members.front().label;
      family.values.push_back(std::numeric_limits<double>::quiet_NaN());
      continue;
    }
    const CheckedTable vary = section.table("vary");
    family.parameter = vary.string("parameter");
    family.values = read_parameter_values(vary);
    const std::string key = family.parameter.substr(family.parameter.find_last_of('.') + 1);
    for (const double value : family.values) {
      StudyProblem& member = family.members.emplace_back(
          read_problem(section, catalog, warnings, Variation{family.parameter, value}));
      family.label = member.label;
      member.label += fmt::format("-{}={:.6g}", key, value);
    }
  }
  if (families.empty()) {
    throw InputError(fmt::format("{}: found no [[problem]], expected at least one", spec.source_name()));
  }
  return families;
}

std::vector<std::string> read_method_patterns(const CheckedTable& spec, const Catalog& catalog) {
  std::vector<std::string> methods;
  const std::vector<std::string> wanted = spec.strings("methods");
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    for (const std::string& call : expand(spec, "methods", i, wanted[i], catalog)) {
      if (std::find(methods.begin(), methods.end(), call) == methods.end()) methods.push_back(call);
    }
  }
  const std::vector<std::string> unwanted = spec.strings_or("without", {});
  for (std::size_t i = 0; i < unwanted.size(); ++i) {
    for (const std::string& call : expand(spec, "without", i, unwanted[i], catalog)) {
      if (std::erase(methods, call) == 0) {
        spec.fail("without", {i}, fmt::format("found \"{}\", which is not among the methods", call));
      }
    }
  }
  if (methods.empty()) spec.fail("methods", "found no method, expected at least one");
  return methods;
}

std::vector<std::string> read_methods(const CheckedTable& spec, const Catalog& catalog) {
  std::vector<std::string> methods = spec.strings("methods");
  if (methods.empty()) spec.fail("methods", "found an empty list, expected at least one method");
  for (std::size_t i = 0; i < methods.size(); ++i) check_call(spec, "methods", i, methods[i], catalog);
  return methods;
}

}  // namespace fw::study
