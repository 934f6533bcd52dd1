#include "study/parameter_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "settings/sequence.hpp"

namespace fw::study {

void declare(settings::Archive& a, ParameterValues& values) {
  using settings::setting;
  a.one_of({{"values", [&] { a(setting("values", values.values).not_empty().doc("the numbers")); }},
            {"from", [&] { declare_sequence(a, values); }}});
}

void declare_sequence(settings::Archive& a, ParameterValues& values) {
  using settings::setting;
  a(setting("from", values.from).positive().doc("first of a geometric sequence"));
  a(setting("to", values.to).required().positive().doc("last of it"));
  a(setting("count", values.count).required().integers(2, 10'000).doc("how many numbers"));
}

std::vector<double> sequence_of(const ParameterValues& given) {
  if (given.values) return *given.values;
  return settings::geometric_sequence(*given.from, *given.to, *given.count);
}

std::vector<double> sorted_values(const ParameterValues& given, const CheckedTable& section) {
  std::vector<double> values = sequence_of(given);
  std::stable_sort(values.begin(), values.end(),
                   [](double a, double b) { return std::abs(a) < std::abs(b); });
  for (std::size_t k = 1; k < values.size(); ++k) {
    if (std::count(values.begin(), values.end(), values[k]) > 1) {
      section.fail(given.values ? "values" : "to",
                   fmt::format("found {} twice, expected different numbers", values[k]));
    }
  }
  return values;
}

std::vector<std::size_t> spread_indices(std::size_t size, std::size_t most) {
  const std::size_t count = std::min(size, most);
  std::vector<std::size_t> indices(count);
  for (std::size_t k = 0; k < count; ++k) indices[k] = count == 1 ? 0 : k * (size - 1) / (count - 1);
  return indices;
}

}  // namespace fw::study
