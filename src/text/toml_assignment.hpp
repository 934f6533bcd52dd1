#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace fw {

/// One value put into a TOML document, replacing what is there.
struct TomlAssignment {
  /// Where: keys and indices from the top, such as "springs.stiffness" or "problem[0].parameters.mass".
  std::string path;
  std::variant<double, std::int64_t, bool, std::string> value;

  /// "springs.stiffness = 100.0"
  std::string text() const;
};

/// The document with these values in place, as TOML text. A missing last key is added, missing tables on the
/// way to it as well; `name` stands for the document in messages. Throws InputError for a text that is no
/// TOML, a path that is none, an index out of range, or a path that goes through something that is no table.
std::string toml_with(std::string_view text, const std::string& name,
                      const std::vector<TomlAssignment>& assignments);

}  // namespace fw
