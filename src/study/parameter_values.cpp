#include "study/parameter_values.hpp"

#include <cmath>

namespace fw::study {

std::vector<double> read_parameter_values(const CheckedTable& section) {
  if (section.has("values")) {
    std::vector<double> values = section.numbers("values");
    if (values.empty()) section.fail("values", "found an empty list, expected at least one number");
    return values;
  }
  const double from = section.positive_number("from"), to = section.positive_number("to");
  const std::int64_t count = section.integer("count", 2, 10'000);
  std::vector<double> values;
  for (std::int64_t k = 0; k < count; ++k) {
    values.push_back(from * std::pow(to / from, static_cast<double>(k) / static_cast<double>(count - 1)));
  }
  values.back() = to;
  return values;
}

}  // namespace fw::study
