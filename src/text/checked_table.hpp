#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/vec3.hpp"

namespace fw {

/// What a number has to satisfy; it has to be finite in any case.
enum class NumberRule { any, nonnegative, positive };

/// The numbers from `lowest` to `highest`, without these where they are excluded.
struct NumberRange {
  NumberRange(NumberRule rule = NumberRule::any);
  NumberRange(double from, double to) : lowest(from), highest(to) {}

  double lowest = -std::numeric_limits<double>::infinity();
  double highest = std::numeric_limits<double>::infinity();
  bool excludes_lowest = false, excludes_highest = false;

  bool contains(double value) const;
  /// " > 0", " >= 0", " from 1 to 5", " > 0 and <= 1"; nothing for all numbers.
  std::string text() const;
};

struct TomlAssignment;

/// One table of a TOML document, read with checks.
///
/// Every reader throws InputError of the form `file:line: [section] key[index]: found X, expected Y`, also
/// where the key is missing. A CheckedTable is a light handle on a shared document, which reading does not
/// change; defaults, resolved text and unknown keys are the business of `settings::Reader`.
class CheckedTable {
 public:
  /// Reads a file. InputError if there is none, or it is a directory, unreadable, or no TOML (with line and
  /// column).
  static CheckedTable parse_file(const std::filesystem::path& path);
  /// Reads a text; `name` stands for the file in messages.
  static CheckedTable parse_text(std::string_view text, std::string name);

  /// The file's name as given by the caller.
  const std::string& source_name() const;
  /// The section as in messages: "springs", "obstacle[1]", "" for the whole document.
  const std::string& path() const;
  /// The keys that the file gives in this table, sorted.
  std::vector<std::string> keys() const;
  /// Whether the file gives the key.
  bool has(std::string_view key) const;
  /// Whether the file gives the key as a table, for keys that may also be plain values.
  bool is_table(std::string_view key) const;
  /// Whether the file gives the key as a list, which sections [[key]] are as well.
  bool is_list(std::string_view key) const;
  /// Whether the file gives the key as a string, for keys that may also be numbers.
  bool is_string(std::string_view key) const;
  /// Whether the file gives the key as a list that begins with a string, for lists that may also be numbers.
  bool holds_strings(std::string_view key) const;

  double number(std::string_view key, const NumberRange& range = {}) const;
  double positive_number(std::string_view key) const { return number(key, NumberRule::positive); }

  /// An integer in [lowest, highest].
  std::int64_t integer(std::string_view key, std::int64_t lowest = std::numeric_limits<std::int64_t>::min(),
                       std::int64_t highest = std::numeric_limits<std::int64_t>::max()) const;
  bool boolean(std::string_view key) const;

  std::string string(std::string_view key) const;

  /// One of the allowed strings.
  std::string choice(std::string_view key, const std::vector<std::string>& allowed) const;

  /// [x, y, z].
  Vec3<double> vec3(std::string_view key) const;

  /// Lists of any length, also empty.
  std::vector<double> numbers(std::string_view key, const NumberRange& range = {}) const;
  std::vector<std::int64_t> integers(std::string_view key,
                                     std::int64_t lowest = std::numeric_limits<std::int64_t>::min(),
                                     std::int64_t highest = std::numeric_limits<std::int64_t>::max()) const;
  std::vector<std::string> strings(std::string_view key) const;
  /// A list of allowed strings.
  std::vector<std::string> choices(std::string_view key, const std::vector<std::string>& allowed) const;
  /// [[x, y, z], …].
  std::vector<Vec3<double>> vectors(std::string_view key) const;

  /// Indices into `count` things called `what` ("particle"), each in [0, count).
  std::vector<int> indices(std::string_view key, std::size_t count, std::string_view what) const;
  /// Pairs [i, j] of such indices.
  std::vector<std::array<int, 2>> index_pairs(std::string_view key, std::size_t count,
                                              std::string_view what) const;

  /// Such indices and the allowed names, in any mixture: `5`, `"corners"` or `["left_edge", 5]`.
  std::vector<std::variant<int, std::string>> indices_or_names(std::string_view key, std::size_t count,
                                                               std::string_view what,
                                                               const std::vector<std::string>& names) const;

  /// One number for all of `count` things called `what` ("spring"), or a list with one for each.
  std::vector<double> number_or_list(std::string_view key, std::size_t count, std::string_view what,
                                     const NumberRange& range = {}) const;

  /// The section [key].
  CheckedTable table(std::string_view key) const;
  /// The sections [[key]] in the file's order; none if the file has none.
  std::vector<CheckedTable> tables(std::string_view key) const;
  /// A section [key] with nothing in it, for messages about what is not there.
  CheckedTable empty_table(std::string_view key) const;
  /// "a section [section.key]"
  std::string section_text(std::string_view key) const;

  /// The numbers of the table [key] and of the tables below it, by their paths in it: "springs.damping".
  std::map<std::string, double> number_table(std::string_view key) const;

  /// This table with these values put in, to be read from anew: from the text, so that messages name its
  /// lines; `name` stands for the file in messages. Throws InputError for a path that is none, an index out
  /// of range, or a path that goes through something that is no table.
  CheckedTable with(const std::vector<TomlAssignment>& assignments, std::string name) const;

  /// A key that the file gives in this table, but nobody knows.
  struct UnknownKey {
    std::size_t line = 0;
    bool has_suggestion = false;
    std::string message{};  ///< `file:line: unknown key "stifness" in [springs]; did you mean "stiffness"?`
  };
  /// The first one in the file that is not among `known`.
  std::optional<UnknownKey> unknown_key(const std::vector<std::string>& known) const;
  /// Throws InputError for an absent key, or for a given key that is probably its misspelling, since it is
  /// not among `known`.
  [[noreturn]] void fail_missing(std::string_view key, const std::string& expected,
                                 const std::vector<std::string>& known) const;

  /// `file:line: [section] key[i][j]`, for messages about an entry. Without a key: `file:line: [section]`.
  std::string where(std::string_view key = {}, std::initializer_list<std::size_t> indices = {}) const;
  /// Throws InputError `where(key, indices): message`.
  [[noreturn]] void fail(std::string_view key, const std::string& message) const;
  [[noreturn]] void fail(std::string_view key, std::initializer_list<std::size_t> indices,
                         const std::string& message) const;

 private:
  friend class TomlTree;
  struct Section;
  explicit CheckedTable(std::shared_ptr<Section> section);
  std::shared_ptr<Section> section_;
};

}  // namespace fw
