#pragma once

#include <vector>

#include "catalog/methods.hpp"

namespace fw::catalog {

/// The foreign solvers, one list per library.
std::vector<MethodEntry> sundials_methods();
std::vector<MethodEntry> arkode_methods();  ///< and IDA
std::vector<MethodEntry> petsc_methods();
std::vector<MethodEntry> gsl_methods();

}  // namespace fw::catalog
