#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace fw::record {

/// Stands for an integer that is not there, in a column that says so by its attribute `missing`.
inline constexpr std::int64_t missing_integer = std::numeric_limits<std::int64_t>::min();

/// Values of one column; text is UTF-8.
using ColumnValues = std::variant<std::vector<double>, std::vector<std::int64_t>, std::vector<std::string>>;

/// A named array with a unit ("1" where it has no dimension, "" for text). `shape` is row-major; empty means
/// one dimension with as many entries as there are values. `attributes` are further facts, for example the
/// norm.
struct Column {
  std::string name;
  std::string unit;
  ColumnValues values;
  std::vector<std::uint64_t> shape;
  std::vector<std::pair<std::string, std::string>> attributes;

  /// Whether a value is one that is not there.
  template <class Value>
  bool lacks(const Value& value) const {
    if constexpr (std::is_same_v<Value, std::int64_t>) {
      return value == missing_integer &&
             std::any_of(attributes.begin(), attributes.end(),
                         [](const auto& attribute) { return attribute.first == "missing"; });
    }
    return false;
  }
};

}  // namespace fw::record
