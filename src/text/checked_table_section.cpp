#include "text/checked_table_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "text/closest_name.hpp"
#include "text/toml_writer.hpp"

namespace fw {
namespace {

std::string shortened(const std::string& text) {
  constexpr std::size_t longest = 60;
  if (text.size() <= longest) return text;
  std::size_t end = longest;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;  // not inside a character
  return text.substr(0, end) + "...";
}

std::string entries(std::size_t count) {
  return fmt::format("{} entr{}", count, count == 1 ? "y" : "ies");
}

}  // namespace

NumberRange::NumberRange(NumberRule rule) {
  if (rule == NumberRule::any) return;
  lowest = 0.0;
  excludes_lowest = rule == NumberRule::positive;
}

bool NumberRange::contains(double value) const {
  return (excludes_lowest ? value > lowest : value >= lowest) &&
         (excludes_highest ? value < highest : value <= highest);
}

std::string NumberRange::text() const {
  const bool is_bounded_below = std::isfinite(lowest), is_bounded_above = std::isfinite(highest);
  if (is_bounded_below && is_bounded_above && !excludes_lowest && !excludes_highest) {
    return fmt::format(" from {} to {}", lowest, highest);
  }
  std::string text;
  if (is_bounded_below) text = fmt::format(" {} {}", excludes_lowest ? ">" : ">=", lowest);
  if (is_bounded_above) {
    text += fmt::format("{} {} {}", text.empty() ? "" : " and", excludes_highest ? "<" : "<=", highest);
  }
  return text;
}

std::string describe(const toml::node& node) {
  if (const auto* text = node.as_string()) return "the string " + toml_quoted(shortened(text->get()));
  if (const auto* integer = node.as_integer()) return fmt::format("{}", integer->get());
  if (const auto* number = node.as_floating_point()) return toml_float(number->get());
  if (const auto* boolean = node.as_boolean()) return boolean->get() ? "true" : "false";
  if (const auto* array = node.as_array()) {
    if (!array->empty() && array->is_array_of_tables()) return "an array of tables";
    return array->empty() ? "an empty array" : "an array of " + entries(array->size());
  }
  return node.is_table() ? "a table" : "a date or time";
}

toml::node& CheckedTable::Section::require(std::string_view key, std::string_view expected) const {
  if (toml::node* node = table->get(key)) return *node;
  fail_missing(key, expected, {std::string(key)});
}

void CheckedTable::Section::fail_missing(std::string_view key, std::string_view expected,
                                         const std::vector<std::string>& known) const {
  // A misspelt key is the likeliest reason: a given key that nobody knows, close to a known one that is not
  // given.
  std::vector<std::string> absent;
  for (const std::string& name : known) {
    if (!table->contains(name)) absent.push_back(name);
  }
  for (const auto& [given, node] : *table) {
    if (std::find(known.begin(), known.end(), given.str()) != known.end()) continue;
    if (closest_name(given.str(), absent)) {
      throw InputError(fmt::format("{}:{}: {}", document->name, given.source().begin.line,
                                   unknown_key_message(given, node, known)));
    }
  }
  throw InputError(
      fmt::format("{}: missing key \"{}\", expected {}", where(nullptr, EntryPlace{}), key, expected));
}

std::string CheckedTable::Section::where(const toml::node* node, const EntryPlace& place) const {
  toml::source_index line = node ? node->source().begin.line : 0;
  if (line == 0 && !path.empty()) line = table->source().begin.line;
  std::string text = document->name;
  if (line != 0) text += fmt::format(":{}", line);
  if (!path.empty()) text += fmt::format(": [{}]", path);
  if (!place.key.empty()) {
    text += fmt::format("{}{}", path.empty() ? ": " : " ", place.key);
    for (std::size_t i = 0; i < place.depth; ++i) text += fmt::format("[{}]", place.index[i]);
  }
  return text;
}

void CheckedTable::Section::fail(const toml::node& node, const EntryPlace& place,
                                 std::string_view expected) const {
  throw InputError(fmt::format("{}: found {}, expected {}", where(&node, place), describe(node), expected));
}

std::string CheckedTable::Section::unknown_key_message(const toml::key& key, const toml::node& node,
                                                       const std::vector<std::string>& known) const {
  const auto suggestion = closest_name(key.str(), known);
  const std::string prefix = path.empty() ? "" : path + ".";
  const auto section = [&](std::string_view name) {
    return node.is_table() ? fmt::format("[{}{}]", prefix, name) : fmt::format("[[{}{}]]", prefix, name);
  };
  const auto* array = node.as_array();
  if (node.is_table() || (array && array->is_array_of_tables())) {
    return fmt::format("unknown section {}{}", section(key.str()),
                       suggestion ? fmt::format("; did you mean \"{}{}\"?", prefix, *suggestion) : "");
  }
  const std::string place = path.empty() ? "at the top of the file" : fmt::format("in [{}]", path);
  std::string message = fmt::format("unknown key {} {}", toml_quoted(key.str()), place);
  if (suggestion) message += fmt::format("; did you mean \"{}\"?", *suggestion);
  return message;
}

double CheckedTable::Section::number_of(const toml::node& node, const EntryPlace& place,
                                        const NumberRange& range) const {
  double value = 0.0;
  if (const auto* number = node.as_floating_point()) {
    value = number->get();
  } else if (const auto* integer = node.as_integer()) {
    value = static_cast<double>(integer->get());
  } else {
    fail(node, place, "a finite number" + range.text());
  }
  if (!std::isfinite(value) || !range.contains(value)) fail(node, place, "a finite number" + range.text());
  return value;
}

void CheckedTable::Section::add_numbers(const std::string& prefix,
                                        std::map<std::string, double>& numbers) const {
  for (const auto& [key, node] : *table) {
    const std::string name(key.str());
    if (auto* inner = node.as_table()) {
      Section{document, inner, path + "." + name}.add_numbers(prefix + name + ".", numbers);
    } else {
      numbers[prefix + name] = number_of(node, {key.str()}, {});
    }
  }
}

std::int64_t CheckedTable::Section::integer_of(const toml::node& node, const EntryPlace& place,
                                               std::int64_t lowest, std::int64_t highest) const {
  const auto* integer = node.as_integer();
  if (integer && integer->get() >= lowest && integer->get() <= highest) return integer->get();
  const bool bounded_below = lowest != std::numeric_limits<std::int64_t>::min();
  const bool bounded_above = highest != std::numeric_limits<std::int64_t>::max();
  std::string range;
  if (bounded_below && bounded_above) {
    range = fmt::format(" from {} to {}", lowest, highest);
  } else if (bounded_below) {
    range = fmt::format(" >= {}", lowest);
  } else if (bounded_above) {
    range = fmt::format(" <= {}", highest);
  }
  fail(node, place, "an integer" + range);
}

int CheckedTable::Section::index_of(const toml::node& node, const EntryPlace& place, std::size_t count,
                                    std::string_view what) const {
  const auto* integer = node.as_integer();
  constexpr auto largest = static_cast<std::size_t>(std::numeric_limits<int>::max());
  const auto end = static_cast<std::int64_t>(std::min(count, largest));
  if (integer && integer->get() >= 0 && integer->get() < end) return static_cast<int>(integer->get());
  fail(node, place,
       end > 0 ? fmt::format("the index of a {}, an integer from 0 to {}", what, end - 1)
               : fmt::format("no index, as there is no {}", what));
}

std::string CheckedTable::Section::string_of(const toml::node& node, const EntryPlace& place) const {
  const auto* text = node.as_string();
  if (!text) fail(node, place, "a string");
  return text->get();
}

std::string CheckedTable::Section::choice_of(const toml::node& node, const EntryPlace& place,
                                             const std::vector<std::string>& allowed) const {
  std::string expected = allowed.size() > 1 ? "one of " : "";
  for (std::size_t i = 0; i < allowed.size(); ++i) expected += (i ? ", \"" : "\"") + allowed[i] + '"';
  const auto* text = node.as_string();
  if (!text) fail(node, place, expected);
  if (std::find(allowed.begin(), allowed.end(), text->get()) == allowed.end()) {
    fail(node, place, expected + did_you_mean(text->get(), allowed));
  }
  return text->get();
}

const toml::array& CheckedTable::Section::array_of(const toml::node& node, const EntryPlace& place,
                                                   std::string_view expected) const {
  const auto* array = node.as_array();
  if (!array) fail(node, place, expected);
  return *array;
}

Vec3<double> CheckedTable::Section::vec3_of(const toml::node& node, const EntryPlace& place) const {
  constexpr std::string_view expected = "an array of 3 numbers [x, y, z]";
  const toml::array& array = array_of(node, place, expected);
  if (array.size() != 3) fail(node, place, expected);
  return {number_of(array[0], place.at(0), {}), number_of(array[1], place.at(1), {}),
          number_of(array[2], place.at(2), {})};
}

}  // namespace fw
