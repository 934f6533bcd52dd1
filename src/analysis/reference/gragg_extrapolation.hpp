#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/status.hpp"
#include "core/work.hpp"
#include "ode/ivp.hpp"

namespace fw::analysis {

/// The numbers of the Aitken–Neville scheme that extrapolates Gragg's modified midpoint rule to step zero.
/// Row j uses n_j = 2(j + 1) substeps; T_{j,k} = T_{j,k−1} + (T_{j,k−1} − T_{j−1,k−1})/divisor[j][k] with
/// divisor[j][k] = (n_j/n_{j−k})² − 1. T_{j,j} has order 2(j + 1). A value, so that tests can damage it.
struct ExtrapolationTableau {
  std::vector<int> substeps;                   ///< n_j, even and increasing
  std::vector<std::vector<Float128>> divisor;  ///< row j has entries 1…j (entry 0 unused)

  std::size_t rows() const { return substeps.size(); }
};

/// The tableau with `rows` rows for n_j = 2, 4, 6, … [Hairer, Nørsett, Wanner 1993, II.9].
ExtrapolationTableau harmonic_extrapolation(int rows);

/// How finely an initial value problem is resolved.
struct ExtrapolationSettings {
  ExtrapolationTableau tableau;
  /// Largest estimated error per step in component i, relative to the largest |y_i| met so far.
  double tolerance = 1e-30;
  /// The least number of steps for the whole interval. It keeps short events from being stepped over.
  int least_steps = 50;
  /// The least number of steps from one time asked for to the next.
  int least_steps_per_output = 1;
  std::uint64_t step_limit = 5'000'000;
  /// How many steps of the smallest size may be taken with their error test failed.
  std::uint64_t forced_step_limit = 1'000;
};

/// States at the times asked for.
struct ExtrapolationRun {
  std::vector<std::vector<Float128>> states;  ///< one per time that was reached
  std::vector<Float128> scale;                ///< the largest |y_i| met, per component
  std::uint64_t forced_steps = 0;             ///< steps of the smallest size that failed the error test
  Status status;
  Work work;
};

/// Told after each accepted step: the part of the interval that is done, in [0, 1]. May throw to end the run.
using ExtrapolationProgress = std::function<void(double fraction)>;

/// Integrates `ivp` in binary128 by Gragg–Bulirsch–Stoer extrapolation with adaptive steps and gives the
/// state at each of `times` (non-decreasing, ≥ t₀), which steps hit exactly.
///
/// A step that fails its error test is repeated with a smaller one, down to some units in the last place of
/// t: kinks and jumps of the right-hand side are thereby closed in on until they no longer matter. Numerical
/// failure is told by the status. [Gragg 1965; Bulirsch, Stoer 1966; Hairer, Nørsett, Wanner 1993, II.9]
ExtrapolationRun integrate_by_extrapolation(const Ivp& ivp, std::span<const double> times,
                                            const ExtrapolationSettings& settings,
                                            const ExtrapolationProgress& progress = {});

}  // namespace fw::analysis
