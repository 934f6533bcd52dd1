#pragma once

#include <optional>
#include <string>
#include <vector>

#include "problems/problem.hpp"
#include "study/parameter_values.hpp"
#include "study/plan.hpp"

namespace fw::study {

/// One section [[problem]]: a problem of the catalogue by `name`, or a scene.
struct ProblemSpec {
  std::optional<std::string> name;
  std::optional<NumberTable> parameters;
  std::optional<std::string> scene;       ///< a path relative to the study file
  std::optional<std::string> scene_text;  ///< what a result file keeps of it; takes precedence over the file
  std::optional<NumberTable> set;         ///< numbers to replace in the scene, by their paths
  std::optional<double> t_end;            ///< [s]
  std::optional<std::string> label;
};
void declare(settings::Archive& a, ProblemSpec& problem);

/// One number of a problem that takes several values: of a catalogue problem the name of a parameter; of a
/// scene the path of a number in its file, such as "springs.stiffness" or "generate.damping".
struct VariedParameter {
  std::string parameter;
  ParameterValues values;
};
void declare(settings::Archive& a, VariedParameter& vary);

/// A [[problem]] that may be a family.
struct FamilySpec {
  ProblemSpec problem;
  std::optional<VariedParameter> vary;
};
void declare(settings::Archive& a, FamilySpec& family);

/// A problem as a study names it.
struct StudyProblem {
  std::string label;  ///< for case names and tables
  Problem problem;
  std::string identity;    ///< what determines it, as text: name and parameters, or the resolved scene
  std::string scene_toml;  ///< the resolved scene; empty for a problem of the catalogue
};

/// The sections [[problem]] of a kind that needs at least one.
inline const settings::SectionInfo problem_sections{
    .name = "problem", .doc = "A problem of the catalogue, or a scene.", .is_required = true};

/// Makes the problems of the [[problem]] sections. The resolved specification gains their end times and
/// labels and the scene's own text as `scene_text`. Throws InputError. `warnings` gains what a scene says
/// without effect.
std::vector<StudyProblem> make_problems(const std::vector<ProblemSpec>& specs, const StudyInput& input,
                                        std::vector<std::string>& warnings);

/// The same problem with one of its numbers varied.
struct ProblemFamily {
  std::string label;
  std::string parameter;              ///< what is varied, as given; empty: nothing, and there is one member
  std::vector<double> values;         ///< of the parameter, in the study's order; NaN for the one member
  std::vector<StudyProblem> members;  ///< one per value, labelled `<label>-<last key>=<value>`
};

/// Leaves at most `most` members, evenly spread over the family: see `spread_indices`.
void thin_out(ProblemFamily& family, std::int64_t most);

/// Makes the families of the [[problem]] sections, like `make_problems`.
std::vector<ProblemFamily> make_families(const std::vector<FamilySpec>& specs, const StudyInput& input,
                                         std::vector<std::string>& warnings);

/// Throws InputError where a call is not one of a method; options in PETSc's notation are tried out in a process
/// of their own.
void check_method(const std::string& call, const Catalog& catalog);

/// The key `methods`: calls of methods, at least one.
settings::Setting methods_setting(std::vector<std::string>& methods);

/// Checks the calls of `methods` in `section` and returns them. Throws InputError that names the entry.
const std::vector<std::string>& checked_methods(const std::vector<std::string>& methods,
                                                const CheckedTable& section, const Catalog& catalog);

/// Why a method cannot make constant steps on a system: its needs, or that it chooses its steps; nothing where
/// it can.
std::string why_no_constant_steps(const MethodInfo& info, const OdeSystem& system);

/// Throws InputError that names entry `i` of `methods` where the method chooses its own steps.
void require_fixed_step(const CheckedTable& file, std::size_t i, const std::string& call,
                        const MethodInfo& info);

/// Methods where a call may be a pattern such as "sundials:*" or "*" (every method).
struct MethodPatterns {
  std::vector<std::string> methods, without;
};
void declare(settings::Archive& a, MethodPatterns& patterns);

/// The calls that fit, in the order of the list, those of `without` left out. Throws InputError.
std::vector<std::string> expanded(const MethodPatterns& patterns, const StudyInput& input);

}  // namespace fw::study
