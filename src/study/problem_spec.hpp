#pragma once

#include <filesystem>
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
std::vector<StudyProblem> read_problems(const CheckedTable& spec, const Catalog& catalog);

/// Checks the calls of `methods` and returns them. Throws InputError that names the entry.
std::vector<std::string> read_methods(const CheckedTable& spec, const Catalog& catalog);

/// The scene as a problem on [0, t_end] with energy-like invariants where the scene has them.
Problem problem_from_scene(const std::filesystem::path& path, double t_end, std::string* resolved_toml);

}  // namespace fw::study
