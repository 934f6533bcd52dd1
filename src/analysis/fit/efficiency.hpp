#pragma once

#include <span>
#include <vector>

namespace fw::analysis {

/// Which of the points (cost_k, error_k) no other one dominates: none is at most as expensive and at most as
/// inaccurate, and better in one of the two. One flag per point; of equal points all or none. Points that are
/// not finite and positive in both never count.
std::vector<char> pareto_front(std::span<const double> costs, std::span<const double> errors);

/// What an error of `target` costs on a ladder of runs, by interpolation on logarithmic axes between
/// neighbours of which one has a larger and the next a smaller error; the cheapest of these. Where every run
/// is more accurate already, the cheapest run's cost; NaN where none is. Points that are not finite and
/// positive in both are left out.
double cost_at_error(std::span<const double> costs, std::span<const double> errors, double target);

}  // namespace fw::analysis
