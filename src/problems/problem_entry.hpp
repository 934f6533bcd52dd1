#pragma once

#include <functional>
#include <map>
#include <string>

#include "problems/problem.hpp"

namespace fw {

/// Parameters of a problem by name. What is not given keeps its default.
using ProblemParameters = std::map<std::string, double>;

/// One line of the list of problems.
struct ProblemEntry {
  std::string name;            ///< as it is called in studies
  ProblemParameters defaults;  ///< every parameter there is, with its default
  /// Makes the problem. Throws InputError for an unknown parameter name or a value out of range.
  std::function<Problem(const ProblemParameters&)> make;
};

}  // namespace fw
