#include <fmt/format.h>

#include "text/checked_table_section.hpp"

namespace fw {
namespace {

/// Applies `read(node, place)` to every entry of an array.
template <class Value, class Read>
std::vector<Value> read_all(const toml::array& array, const EntryPlace& place, Read read) {
  std::vector<Value> values;
  values.reserve(array.size());
  for (std::size_t i = 0; i < array.size(); ++i) values.push_back(read(array[i], place.at(i)));
  return values;
}

}  // namespace

std::vector<double> CheckedTable::numbers(std::string_view key, const NumberRange& range) const {
  constexpr std::string_view expected = "an array of numbers";
  const auto& array = section_->array_of(section_->require(key, expected), {key}, expected);
  return read_all<double>(array, {key}, [&](const toml::node& node, const EntryPlace& place) {
    return section_->number_of(node, place, range);
  });
}

std::vector<std::int64_t> CheckedTable::integers(std::string_view key, std::int64_t lowest,
                                                 std::int64_t highest) const {
  constexpr std::string_view expected = "an array of integers";
  const auto& array = section_->array_of(section_->require(key, expected), {key}, expected);
  return read_all<std::int64_t>(array, {key}, [&](const toml::node& node, const EntryPlace& place) {
    return section_->integer_of(node, place, lowest, highest);
  });
}

std::vector<std::string> CheckedTable::strings(std::string_view key) const {
  constexpr std::string_view expected = "an array of strings";
  const auto& array = section_->array_of(section_->require(key, expected), {key}, expected);
  return read_all<std::string>(array, {key}, [&](const toml::node& node, const EntryPlace& place) {
    return section_->string_of(node, place);
  });
}

std::vector<std::string> CheckedTable::choices(std::string_view key,
                                               const std::vector<std::string>& allowed) const {
  constexpr std::string_view expected = "an array of strings";
  const auto& array = section_->array_of(section_->require(key, expected), {key}, expected);
  return read_all<std::string>(array, {key}, [&](const toml::node& node, const EntryPlace& place) {
    return section_->choice_of(node, place, allowed);
  });
}

std::vector<Vec3<double>> CheckedTable::vectors(std::string_view key) const {
  constexpr std::string_view expected = "an array of vectors [x, y, z]";
  const auto& array = section_->array_of(section_->require(key, expected), {key}, expected);
  return read_all<Vec3<double>>(array, {key}, [&](const toml::node& node, const EntryPlace& place) {
    return section_->vec3_of(node, place);
  });
}

std::vector<int> CheckedTable::indices(std::string_view key, std::size_t count, std::string_view what) const {
  const std::string expected = fmt::format("an array of {} indices", what);
  const auto& array = section_->array_of(section_->require(key, expected), {key}, expected);
  return read_all<int>(array, {key}, [&](const toml::node& node, const EntryPlace& place) {
    return section_->index_of(node, place, count, what);
  });
}

std::vector<std::array<int, 2>> CheckedTable::index_pairs(std::string_view key, std::size_t count,
                                                          std::string_view what) const {
  const std::string expected = fmt::format("an array of pairs [i, j] of {} indices", what);
  const std::string expected_pair = fmt::format("a pair [i, j] of {} indices", what);
  const auto& array = section_->array_of(section_->require(key, expected), {key}, expected);
  return read_all<std::array<int, 2>>(array, {key}, [&](const toml::node& node, const EntryPlace& place) {
    const auto& pair = section_->array_of(node, place, expected_pair);
    if (pair.size() != 2) section_->fail(node, place, expected_pair);
    return std::array<int, 2>{section_->index_of(pair[0], place.at(0), count, what),
                              section_->index_of(pair[1], place.at(1), count, what)};
  });
}

std::vector<std::variant<int, std::string>> CheckedTable::indices_or_names(
    std::string_view key, std::size_t count, std::string_view what,
    const std::vector<std::string>& names) const {
  using Entry = std::variant<int, std::string>;
  const std::string expected = fmt::format("the index of a {} or a name, or an array of these", what);
  const auto read = [&](const toml::node& node, const EntryPlace& place) -> Entry {
    if (node.is_string()) return section_->choice_of(node, place, names);
    return section_->index_of(node, place, count, what);
  };
  const auto& node = section_->require(key, expected);
  if (node.is_string() || node.is_integer()) return {read(node, {key})};
  return read_all<Entry>(section_->array_of(node, {key}, expected), {key}, read);
}

std::vector<double> CheckedTable::number_or_list(std::string_view key, std::size_t count,
                                                 std::string_view what, const NumberRange& range) const {
  const std::string expected =
      fmt::format("one number, or an array with one number per {} ({})", what, count);
  const auto& node = section_->require(key, expected);
  if (node.is_number()) return {section_->number_of(node, {key}, range)};
  const auto& array = section_->array_of(node, {key}, expected);
  if (array.size() != count) section_->fail(node, {key}, expected);
  return numbers(key, range);
}

}  // namespace fw
