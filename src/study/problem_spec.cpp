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

Vector Catalog::equilibrium(const SecondOrderSystem&, ConstVectorRef) const {
  throw InputError("start = \"equilibrium\": this catalogue has no search for a static equilibrium");
}

namespace {

std::vector<Invariant> energy_of(const std::shared_ptr<const mechanics::MassSpringSystem>& system) {
  const Index n = system->degrees_of_freedom();
  return {{"energy", "J", [system, n](double t, ConstVectorRef y) {
             return system->energies(t, y.head(n), y.tail(n)).total();
           }}};
}

/// The scene as a problem on [0, t_end].
Problem problem_from_scene(scene::Scene scene, const std::string& name, double t_end,
                           const Catalog& catalog) {
  Problem problem;
  problem.name = name;
  problem.title = scene.title;
  problem.ivp.y0 = initial_state(scene);
  problem.ivp.t1 = t_end;
  auto system = std::make_shared<const mechanics::MassSpringSystem>(std::move(scene.model));
  problem.is_smooth = system->is_smooth();
  if (scene.starts_at_equilibrium) {
    problem.ivp.y0.head(system->degrees_of_freedom()) = catalog.equilibrium(*system, scene.position);
  }
  if (system->force_class() == ForceClass::position && !system->is_driven())
    problem.invariants = energy_of(system);
  problem.ivp.system = std::move(system);
  return problem;
}

/// A scene as a study names it: the file, or what a result file keeps of it.
scene::Scene scene_of(const ProblemSpec& spec, const CheckedTable& section) {
  if (spec.scene_text && !spec.scene_text->empty()) {
    return scene::parse_scene(*spec.scene_text, *spec.scene + " (scene_text)");
  }
  return scene::read_scene(std::filesystem::path(section.source_name()).parent_path() / *spec.scene);
}

/// The number that a member of a family has in place of the problem's own.
struct Variation {
  std::string parameter;
  double value = 0.0;
};

/// The numbers that a study puts into a scene.
std::vector<TomlAssignment> assignments_of(const ProblemSpec& spec,
                                           const std::optional<Variation>& variation) {
  std::vector<TomlAssignment> assignments;
  for (const auto& [path, number] : spec.set.value_or(NumberTable())) assignments.push_back({path, number});
  if (variation) assignments.push_back({variation->parameter, variation->value});
  return assignments;
}

/// One section [[problem]] while its problem is made, or the members of its family.
class ProblemMaker {
 public:
  ProblemMaker(const ProblemSpec& spec, CheckedTable section, const Catalog& catalog,
               std::vector<std::string>& warnings)
      : spec_(spec), section_(std::move(section)), catalog_(catalog), warnings_(warnings) {}

  StudyProblem make(const std::optional<Variation>& variation = {}) {
    StudyProblem entry = spec_.scene ? from_scene(variation) : from_catalogue(variation);
    const Ivp& ivp = entry.problem.ivp;
    entry.identity += fmt::format("\nt0 = {}\nt1 = {}\n", ivp.t0, ivp.t1);
    return entry;
  }

  /// Puts what was worked out into the resolved section.
  void complete(TomlTree resolved, const StudyProblem& made) const {
    const auto add = [&resolved](const char* key, const TomlValue& value) {
      if (!resolved.has(key)) resolved.set(key, value);
    };
    add("label", made.label);
    add("t_end", made.problem.ivp.t1);
    if (base_) add("scene_text", base_->resolved_toml);
  }

 private:
  StudyProblem from_scene(const std::optional<Variation>& variation) {
    StudyProblem entry;
    const std::string stem = std::filesystem::path(*spec_.scene).stem().string();
    try {
      if (!base_) base_ = scene_of(spec_, section_);
      scene::Scene scene = changed(assignments_of(spec_, variation));
      warnings_.insert(warnings_.end(), scene.warnings.begin(), scene.warnings.end());
      entry.scene_toml = scene.resolved_toml;
      entry.problem = problem_from_scene(std::move(scene), stem, *spec_.t_end, catalog_);
    } catch (const InputError& error) {
      section_.fail("scene", error.what());
    }
    entry.label = spec_.label.value_or(stem);
    entry.identity = entry.scene_toml;
    return entry;
  }

  /// The scene with these numbers in it.
  scene::Scene changed(const std::vector<TomlAssignment>& assignments) const {
    if (assignments.empty()) return *base_;
    std::string name = base_name();
    for (const TomlAssignment& assignment : assignments) name += " with " + assignment.text();
    const std::string& text =
        spec_.scene_text && !spec_.scene_text->empty() ? *spec_.scene_text : base_->resolved_toml;
    return scene::read_scene(CheckedTable::parse_text(text, base_name()).with(assignments, name));
  }

  std::string base_name() const {
    if (spec_.scene_text && !spec_.scene_text->empty()) return *spec_.scene + " (scene_text)";
    return (std::filesystem::path(section_.source_name()).parent_path() / *spec_.scene).string();
  }

  StudyProblem from_catalogue(const std::optional<Variation>& variation) const {
    StudyProblem entry;
    ProblemParameters parameters;
    for (const auto& [name, value] : spec_.parameters.value_or(NumberTable())) parameters[name] = value;
    if (variation) parameters[variation->parameter] = variation->value;
    try {
      entry.problem = catalog_.problem(*spec_.name, parameters);
    } catch (const InputError& error) {
      section_.fail("name", error.what());
    }
    Ivp& ivp = entry.problem.ivp;
    ivp.t1 = spec_.t_end.value_or(ivp.t1);
    if (ivp.t1 <= ivp.t0) {
      section_.fail("t_end", fmt::format("found {}, expected more than the start {}", ivp.t1, ivp.t0));
    }
    entry.label = spec_.label.value_or(*spec_.name);
    entry.identity = fmt::format("problem = {}\nparameters = {}\n", *spec_.name, entry.problem.parameters);
    return entry;
  }

  const ProblemSpec& spec_;
  CheckedTable section_;
  const Catalog& catalog_;
  std::vector<std::string>& warnings_;
  std::optional<scene::Scene> base_;
};

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
  try {
    check_method(call, catalog);
  } catch (const InputError& error) {
    spec.fail(key, {index}, error.what());
  }
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

void check_method(const std::string& call, const Catalog& catalog) {
  catalog.method(call);
  if (call.find("petsc=") == std::string::npos) return;
  if (const std::string message = probe(call, catalog); !message.empty()) throw InputError(message);
}

void declare(settings::Archive& a, ProblemSpec& problem) {
  using settings::setting;
  a.one_of(
      {{"name",
        [&] {
          a(setting("name", problem.name).names_of("problems").doc("a problem of `federwerk list problems`"));
          a(setting("parameters", problem.parameters)
                .default_text("`{}`")
                .doc("those that `federwerk describe NAME` lists; the others keep their defaults"));
          a(setting("t_end", problem.t_end)
                .positive()
                .unit("s")
                .default_text("the problem's own")
                .doc("end time; every problem starts at 0"));
        }},
       {"scene", [&] {
          a(setting("scene", problem.scene).doc("a scene file, relative to the study file"));
          a(setting("scene_text", problem.scene_text)
                .default_text("the text of `scene`")
                .doc("the scene itself, which takes precedence over the file; a result file keeps it in its "
                     "`spec`"));
          a(setting("set", problem.set)
                .default_text("`{}`")
                .doc("numbers to replace in it, `set = { springs = { damping = 0.0 } }`"));
          a(setting("t_end", problem.t_end).required().positive().unit("s").doc("end time"));
        }}});
  a(setting("label", problem.label)
        .default_text("the name; the scene's file name without `.toml`")
        .doc("for tables and names of cases"));
}

void declare(settings::Archive& a, VariedParameter& vary) {
  a(settings::setting("parameter", vary.parameter)
        .required()
        .doc("the name of a parameter, or the path of a number in the scene file, `springs.stiffness`"));
  declare(a, vary.values);
}

void declare(settings::Archive& a, FamilySpec& family) {
  declare(a, family.problem);
  a.optional_section({"vary", "One number that takes several values, which makes a family."}, family.vary);
}

std::vector<StudyProblem> make_problems(const std::vector<ProblemSpec>& specs, const StudyInput& input,
                                        std::vector<std::string>& warnings) {
  std::vector<StudyProblem> problems;
  const std::vector<CheckedTable> sections = input.file.tables("problem");
  for (std::size_t k = 0; k < specs.size(); ++k) {
    ProblemMaker maker(specs[k], sections[k], input.catalog, warnings);
    problems.push_back(maker.make());
    maker.complete(TomlTree(input.resolved).table("problem", k), problems.back());
  }
  return problems;
}

std::vector<ProblemFamily> make_families(const std::vector<FamilySpec>& specs, const StudyInput& input,
                                         std::vector<std::string>& warnings) {
  std::vector<ProblemFamily> families;
  const std::vector<CheckedTable> sections = input.file.tables("problem");
  for (std::size_t k = 0; k < specs.size(); ++k) {
    ProblemFamily& family = families.emplace_back();
    ProblemMaker maker(specs[k].problem, sections[k], input.catalog, warnings);
    if (specs[k].vary) {
      const VariedParameter& vary = *specs[k].vary;
      family.parameter = vary.parameter;
      family.values = sorted_values(vary.values, sections[k].table("vary"));
      const std::string key = family.parameter.substr(family.parameter.find_last_of('.') + 1);
      for (const double value : family.values) {
        StudyProblem& member = family.members.emplace_back(maker.make(Variation{family.parameter, value}));
        if (family.label.empty()) {
          family.label = member.label;
          maker.complete(TomlTree(input.resolved).table("problem", k), member);
        }
        member.label += fmt::format("-{}={:.6g}", key, value);
      }
      continue;
    }
    family.members.push_back(maker.make());
    family.label = family.members.front().label;
    family.values.push_back(std::numeric_limits<double>::quiet_NaN());
    maker.complete(TomlTree(input.resolved).table("problem", k), family.members.front());
  }
  return families;
}

void thin_out(ProblemFamily& family, std::int64_t most) {
  family.values = thinned_out(std::move(family.values), most);
  family.members = thinned_out(std::move(family.members), most);
}

settings::Setting methods_setting(std::vector<std::string>& methods) {
  return settings::setting("methods", methods)
      .required()
      .not_empty()
      .names_of("methods")
      .doc(
          "names of `federwerk list methods`, with options in brackets: "
          "`\"implicit_euler_linearised[linear_solver=lu,tangent=psd_projection]\"`");
}

const std::vector<std::string>& checked_methods(const std::vector<std::string>& methods,
                                                const CheckedTable& section, const Catalog& catalog) {
  for (std::size_t i = 0; i < methods.size(); ++i) check_call(section, "methods", i, methods[i], catalog);
  return methods;
}

std::string why_no_constant_steps(const MethodInfo& info, const OdeSystem& system) {
  if (!info.has_fixed_step) return "it chooses its own steps, expected a method with a fixed step";
  return why_not_applicable(info, system);
}

void require_fixed_step(const CheckedTable& file, std::size_t i, const std::string& call,
                        const MethodInfo& info) {
  if (info.has_fixed_step) return;
  file.fail("methods", {i},
            fmt::format("\"{}\" chooses its own steps, expected a method with a fixed step", call));
}

void declare(settings::Archive& a, MethodPatterns& patterns) {
  a(methods_setting(patterns.methods)
        .doc("as everywhere, or patterns: `\"*\"` is every method, `\"sundials:*\"` all of a library"));
  a(settings::setting("without", patterns.without)
        .names_of("methods")
        .doc("methods or patterns that are taken out again"));
}

std::vector<std::string> expanded(const MethodPatterns& patterns, const StudyInput& input) {
  const CheckedTable& file = input.file;
  std::vector<std::string> methods;
  for (std::size_t i = 0; i < patterns.methods.size(); ++i) {
    for (const std::string& call : expand(file, "methods", i, patterns.methods[i], input.catalog)) {
      if (std::find(methods.begin(), methods.end(), call) == methods.end()) methods.push_back(call);
    }
  }
  for (std::size_t i = 0; i < patterns.without.size(); ++i) {
    for (const std::string& call : expand(file, "without", i, patterns.without[i], input.catalog)) {
      if (std::erase(methods, call) == 0) {
        file.fail("without", {i}, fmt::format("found \"{}\", which is not among the methods", call));
      }
    }
  }
  if (methods.empty()) file.fail("methods", "found no method, expected at least one");
  return methods;
}

}  // namespace fw::study
