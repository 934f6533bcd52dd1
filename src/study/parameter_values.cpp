#include "study/parameter_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace fw::study {

namespace {

std::vector<double> geometric_sequence(const CheckedTable& section) {
  const double from = section.positive_number("from"), to = section.positive_number("to");
  const std::int64_t count = section.integer("count", 2, 10'000);
  std::vector<double> values;
  for (std::int64_t k = 0; k < count; ++k) {
    values.push_back(from * std::pow(to / from, static_cast<double>(k) / static_cast<double>(count - 1)));
  }
  values.back() = to;
  return values;
}

}  // namespace

std::vector<double> read_parameter_values(const CheckedTable& section) {
  const bool is_list = section.has("values");
  std::vector<double> values = is_list ? section.numbers("values") : geometric_sequence(section);
  if (values.empty()) section.fail("values", "found an empty list, expected at least one number");
  std::stable_sort(values.begin(), values.end(),
                   [](double a, double b) { return std::abs(a) < std::abs(b); });
  for (std::size_t k = 1; k < values.size(); ++k) {
    if (std::count(values.begin(), values.end(), values[k]) > 1) {
      section.fail(is_list ? "values" : "to",
                   fmt::format("found {} twice, expected different numbers", values[k]));
    }
  }
  return values;
}

}  // namespace fw::study
