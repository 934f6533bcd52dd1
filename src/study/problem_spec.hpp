#pragma once

#include <string>
#include <vector>

#include "problems/problem.hpp"
#include "study/catalog.hpp"
#include "text/checked_table.hpp"

namespace fw::study {

/// A problem as a study names it.
struct StudyProblem {
  std::string label;  ///< for case names and tables
  Problem problem;
  std::string identity;    ///< what determines it, as text: name and parameters, or the resolved scene
  std::string scene_toml;  ///< the resolved scene; empty for a problem of the catalogue
};

/// Reads the [[problem]] sections: `name` (with `parameters = { … }`) or `scene` (a path relative to the
/// study file, then `t_end` is required), `t_end`, `label`. The resolved specification holds the scene's own
/// text as `scene_text`, which goes before the file. Throws InputError. `warnings` gains what a scene says
/// without effect.
std::vector<StudyProblem> read_problems(const CheckedTable& spec, const Catalog& catalog,
                                        std::vector<std::string>& warnings);

/// The same problem with one of its numbers varied.
struct ProblemFamily {
  std::string label;
  std::string parameter;              ///< what is varied, as given; empty: nothing, and there is one member
  std::vector<double> values;         ///< of the parameter, in the study's order; NaN for the one member
  std::vector<StudyProblem> members;  ///< one per value, labelled `<label>-<last key>=<value>`
};

/// Reads the [[problem]] sections like `read_problems`, each with an optional table
/// `vary = { parameter = "stiffness", values = […] }` (or `from`, `to`, `count` for a geometric sequence). Of
/// a catalogue problem `parameter` is the name of a parameter; of a scene it is the path of a number in its
/// file, such as "springs.stiffness" or "generate.damping". Throws InputError.
std::vector<ProblemFamily> read_problem_families(const CheckedTable& spec, const Catalog& catalog,
                                                 std::vector<std::string>& warnings);

/// Checks the calls of `methods` and returns them. Throws InputError that names the entry.
std::vector<std::string> read_methods(const CheckedTable& spec, const Catalog& catalog);

/// The same where a call may be a pattern such as "sundials:*" or "*" (every method), in the order of the
/// list; the calls or patterns of the key `without` are left out again.
std::vector<std::string> read_method_patterns(const CheckedTable& spec, const Catalog& catalog);

}  // namespace fw::study
