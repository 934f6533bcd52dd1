#pragma once

#include <string>

#include "core/extended_precision.hpp"

namespace fw {

/// Half a unit of the last digit of a decimal string such as "-0.0123".
inline Float128 half_unit_of_last_digit(const std::string& digits) {
  const std::size_t point = digits.find('.');
  const std::size_t places = point == std::string::npos ? 0 : digits.size() - point - 1;
  return Float128(5) * pow(Float128(10), -static_cast<int>(places) - 1);
}

}  // namespace fw
