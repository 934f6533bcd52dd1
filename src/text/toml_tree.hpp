#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/vec3.hpp"
#include "text/checked_table.hpp"

namespace fw {

/// Numbers by name; one number under "" stands for all.
using NumberTable = std::map<std::string, double>;

/// Pairs [i, j] of indices.
using IndexPairs = std::vector<std::array<int, 2>>;

/// Indices and names of points, in any mixture.
using PointList = std::vector<std::variant<int, std::string>>;

/// What an entry of a TOML table can hold.
using TomlValue = std::variant<double, std::int64_t, bool, std::string, Vec3<double>, std::vector<double>,
                               std::vector<std::int64_t>, std::vector<std::string>, std::vector<Vec3<double>>,
                               NumberTable, IndexPairs, PointList>;

/// The value as a TOML file has it: `1.5`, `["a", "b"]`.
std::string toml_text(const TomlValue& value);

/// A TOML table that is put together entry by entry. A light handle: copies, and the tables below, are of
/// one tree.
class TomlTree {
 public:
  TomlTree();

  /// Puts the value in the place of what is there.
  void set(std::string_view key, const TomlValue& value);
  /// Puts the entry as the file gives it, which may be a section.
  void copy(std::string_view key, const CheckedTable& from);
  /// Puts in every entry of a section as the file gives it.
  void copy_all(const CheckedTable& from);

  bool has(std::string_view key) const;
  /// The section [key], made if it is not there.
  TomlTree table(std::string_view key);
  /// The section number `index` of [[key]]; the next one is made. std::logic_error beyond it.
  TomlTree table(std::string_view key, std::size_t index);

  /// The text with sorted keys (`to_toml_text`).
  std::string text() const;

 private:
  struct Node;
  explicit TomlTree(std::shared_ptr<Node> node);
  std::shared_ptr<Node> node_;
};

}  // namespace fw
