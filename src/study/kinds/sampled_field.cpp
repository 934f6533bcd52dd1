#include "study/kinds/sampled_field.hpp"

#include <fmt/format.h>

namespace fw::study {

using settings::Archive;
using settings::setting;

void declare(Archive& a, FieldSpec& field) {
  a(setting("lower", field.lower)
        .required()
        .entries(2)
        .doc("corner of the grid: (t, y) for one unknown; (y₁, y₂) for two"));
  a(setting("upper", field.upper).required().entries(2).doc("the opposite corner"));
  a(setting("counts", field.counts).required().entries(2).integers(2, 1000).doc("points along each axis"));
  a(setting("times", field.times)
        .unit("s")
        .not_empty()
        .default_text("the start")
        .doc("of two unknowns: when, for fields that change with time"));
}

FieldGrid field_grid(const FieldSpec& field, const CheckedTable& table, const Ivp& ivp) {
  if (field.times && ivp.system->size() == 1)
    table.fail("times", "found with one unknown, whose grid has the time as an axis");
  for (std::size_t axis = 0; axis < 2; ++axis) {
    if (field.lower[axis] >= field.upper[axis]) {
      table.fail("upper", {axis},
                 fmt::format("found {}, expected more than lower[{}] = {}", field.upper[axis], axis,
                             field.lower[axis]));
    }
  }
  return {field.lower, field.upper, field.counts, field.times.value_or(std::vector<double>{ivp.t0})};
}

CaseResult sample_field(const Ivp& ivp, const FieldGrid& grid) {
  const bool scalar = ivp.system->size() == 1;
  const std::vector<double> field_times = scalar ? std::vector<double>{ivp.t0} : grid.times;
  std::vector<double> times, states, slopes;
  Vector y(ivp.system->size()), slope(ivp.system->size());
  const auto coordinate = [&](std::size_t axis, std::int64_t k) {
    return grid.lower[axis] + (grid.upper[axis] - grid.lower[axis]) * static_cast<double>(k) /
                                  static_cast<double>(grid.counts[axis] - 1);
  };
  for (const double field_time : field_times) {
    for (std::int64_t j = 0; j < grid.counts[1]; ++j) {
      for (std::int64_t i = 0; i < grid.counts[0]; ++i) {
        const double t = scalar ? coordinate(0, i) : field_time;
        if (scalar) {
          y[0] = coordinate(1, j);
        } else {
          y << coordinate(0, i), coordinate(1, j);
        }
        ivp.system->rhs(t, y, slope);
        times.push_back(t);
        states.insert(states.end(), y.data(), y.data() + y.size());
        slopes.insert(slopes.end(), slope.data(), slope.data() + slope.size());
      }
    }
  }
  const auto size = static_cast<std::uint64_t>(ivp.system->size());
  CaseResult result;
  result.verdict = Verdict::done;
  result.reason = "sampled right-hand side";
  result.columns = {{"field_t", "s", times, {}, {}},
                    {"field_y", "SI", states, {times.size(), size}, {}},
                    {"field_dydt", "SI/s", slopes, {times.size(), size}, {}}};
  return result;
}

}  // namespace fw::study
