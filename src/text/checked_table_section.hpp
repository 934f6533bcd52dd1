#pragma once

// Private to checked_table*.cpp: keeps the slow headers of toml++ out of everybody else's way.

#include <toml++/toml.h>

#include "text/checked_table.hpp"
#include "text/toml_assignment.hpp"

namespace fw {

/// An entry of a section: a key, and indices if it lies in an array.
struct EntryPlace {
  std::string_view key;
  std::array<std::size_t, 3> index{};
  std::size_t depth = 0;

  EntryPlace at(std::size_t i) const {
    EntryPlace inner = *this;
    inner.index.at(inner.depth++) = i;
    return inner;
  }
};

struct CheckedTable::Section {
  struct Document {
    std::string name;
    std::string text;
    /// What was put into it since, each in the section at the path.
    std::vector<std::pair<std::string, std::vector<TomlAssignment>>> assigned;
    toml::table root;
    toml::table nothing;  ///< what a section that is not there has in it
  };

  std::shared_ptr<Document> document;
  toml::table* table = nullptr;
  std::string path;

  /// The entry of a key that has to be there.
  toml::node& require(std::string_view key, std::string_view expected) const;

  std::string where(const toml::node* node, const EntryPlace& place) const;
  [[noreturn]] void fail(const toml::node& node, const EntryPlace& place, std::string_view expected) const;
  std::string unknown_key_message(const toml::key& key, const toml::node& node,
                                  const std::vector<std::string>& known) const;
  [[noreturn]] void fail_missing(std::string_view key, std::string_view expected,
                                 const std::vector<std::string>& known) const;
  void add_numbers(const std::string& prefix, std::map<std::string, double>& numbers) const;

  double number_of(const toml::node& node, const EntryPlace& place, const NumberRange& range) const;
  std::int64_t integer_of(const toml::node& node, const EntryPlace& place, std::int64_t lowest,
                          std::int64_t highest) const;
  int index_of(const toml::node& node, const EntryPlace& place, std::size_t count,
               std::string_view what) const;
  std::string string_of(const toml::node& node, const EntryPlace& place) const;
  std::string choice_of(const toml::node& node, const EntryPlace& place,
                        const std::vector<std::string>& allowed) const;
  Vec3<double> vec3_of(const toml::node& node, const EntryPlace& place) const;
  const toml::array& array_of(const toml::node& node, const EntryPlace& place,
                              std::string_view expected) const;
};

/// Puts values into a document (see TomlAssignment).
void assign(toml::node& root, const std::string& name, const std::vector<TomlAssignment>& assignments);

/// The section at `path`, such as "study" or "problem[1]"; the whole document for "".
toml::table& section_at(toml::table& root, const std::string& path);

/// What a message says was found: `the string "abc"`, `-1`, `an array of 2 entries`.
std::string describe(const toml::node& node);

}  // namespace fw
