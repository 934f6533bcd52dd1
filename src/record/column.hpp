#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace fw::record {

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
};

}  // namespace fw::record
