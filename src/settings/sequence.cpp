#include "settings/sequence.hpp"

#include <cmath>

namespace fw::settings {

std::vector<double> geometric_sequence(double from, double to, std::int64_t count) {
  std::vector<double> values;
  for (std::int64_t k = 0; k < count; ++k) {
    values.push_back(from * std::pow(to / from, static_cast<double>(k) / static_cast<double>(count - 1)));
  }
  values.back() = to;
  return values;
}

}  // namespace fw::settings
