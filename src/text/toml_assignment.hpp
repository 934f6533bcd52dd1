#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace fw {

/// One value put into a TOML document, replacing what is there (`CheckedTable::with`). A missing last key is
/// added, missing tables on the way to it as well.
struct TomlAssignment {
  /// Where: keys and indices from the top, such as "springs.stiffness" or "problem[0].parameters.mass".
  std::string path;
  std::variant<double, std::int64_t, bool, std::string> value;

  /// "springs.stiffness = 100.0"
  std::string text() const;
};

}  // namespace fw
