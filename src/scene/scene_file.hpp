#pragma once

#include <vector>

#include "text/toml_tree.hpp"

namespace fw::scene {

/// A scene file whose values have been read.
struct SceneFile {
  CheckedTable root;  ///< where they stand, for messages about what one demands of another
  TomlTree resolved;  ///< gains the defaults that are worked out from other values
};

/// A setting that has one number for all, or one for each, as `count` numbers.
inline std::vector<double> for_each_of(std::size_t count, const std::vector<double>& numbers) {
  return numbers.size() == 1 ? std::vector<double>(count, numbers.front()) : numbers;
}

}  // namespace fw::scene
