#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "ode/ivp.hpp"
#include "settings/setting.hpp"
#include "study/plan.hpp"
#include "study/result.hpp"

namespace fw::study {

/// The keys of [vector_field].
struct FieldSpec {
  std::vector<double> lower, upper;
  std::vector<std::int64_t> counts;
  std::optional<std::vector<double>> times;
};
void declare(settings::Archive& a, FieldSpec& field);

/// ẏ = f(t, y) on a grid: (t, y) for one unknown, (y₁, y₂) at each of `times` for two.
struct FieldGrid {
  std::vector<double> lower, upper;
  std::vector<std::int64_t> counts;
  std::vector<double> times;  ///< [s]
};

/// The grid for a problem. Throws InputError that names the key of `table` where corners are reversed, or times are
/// given for one unknown, whose grid has the time as an axis.
FieldGrid field_grid(const FieldSpec& field, const CheckedTable& table, const Ivp& ivp);

/// ẏ = f(t, y) at the points of the grid, in the columns field_t [s], field_y [SI] and field_dydt [SI/s]; the first axis
/// runs fastest. The summary is left to the kind.
CaseResult sample_field(const Ivp& ivp, const FieldGrid& grid);

}  // namespace fw::study
