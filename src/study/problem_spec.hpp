#pragma once

#include <string>
#include <vector>

#include "core/checked_table.hpp"
#include "problems/problem.hpp"
#include "study/catalog.hpp"

namespace fw::study {

/// A problem as a study names it.
struct StudyProblem {
  std::string label;  ///< for case names and tables
  Problem problem;
  std::string identity;    ///< what determines it, as text: name and parameters, or the resolved scene
  std::string scene_toml;  ///< the resolved scene; empty for a problem of the catalogue
};

/// Reads the [[problem]] sections: `name` (with `parameters = { … }`) or `scene` (a path relative to the
/// study file, then `t_end` is required), `t_end`, `label`. Throws InputError.
/// `warnings` gains what a scene says without effect.
std::vector<StudyProblem> read_problems(const CheckedTable& spec, const Catalog& catalog,
                                        std::vector<std::string>& warnings);

/// Checks the calls of `methods` and returns them. Throws InputError that names the entry.
std::vector<std::string> read_methods(const CheckedTable& spec, const Catalog& catalog);

/// The same where a call may be a pattern such as "sundials:*" or "*" (every method), in the order of the
/// list; the calls or patterns of the key `without` are left out again.
std::vector<std::string> read_method_patterns(const CheckedTable& spec, const Catalog& catalog);

}  // namespace fw::study
