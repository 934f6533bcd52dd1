#pragma once

#include <span>
#include <vector>

#include "core/work.hpp"
#include "settings/archive.hpp"
#include "study/result.hpp"

namespace fw::study {

/// Appends one column per counter of `Work`, under the counter's name, with one entry per run; the wall-clock
/// time is not among them.
void add_work_columns(std::vector<Column>& columns, std::span<const Work> runs);

/// Declared costs of operations in units of one right-hand side, for a measure of cost that is the same on
/// every machine.
struct OperationCosts {
  double jacobian = 3.0;  ///< assembling J or the tangent matrices
  double jacobian_product = 1.0;
  double factorisation = 10.0;
  double linear_solve = 2.0;  ///< with a factorisation at hand
  double linear_iteration = 1.0;

  /// Σ count·cost over all operations of a run. Solves by Krylov iteration count by their iterations.
  double of(const Work& work) const;
};
/// One key per operation.
void declare(settings::Archive& a, OperationCosts& costs);

}  // namespace fw::study
