#include "text/checked_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include "core/error.hpp"
#include "text/checked_table_section.hpp"
#include "text/closest_name.hpp"
#include "text/toml_writer.hpp"

namespace fw {
namespace {

std::string read_file(const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found) {
    throw InputError(fmt::format("{}: no such file", path.string()));
  }
  if (status.type() == std::filesystem::file_type::directory) {
    throw InputError(fmt::format("{}: found a directory, expected a TOML file", path.string()));
  }
  using std::filesystem::file_type;
  if (status.type() == file_type::character || status.type() == file_type::block) {
    throw InputError(fmt::format("{}: found a device, expected a TOML file", path.string()));
  }
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(fmt::format("{}: cannot be read: {}", path.string(), std::strerror(errno)));
  // Not `text << file.rdbuf()`, which takes a failure to read for the end of the file.
  std::string text;
  std::array<char, 65536> buffer{};
  while (file.read(buffer.data(), buffer.size()) || file.gcount() > 0) {
    text.append(buffer.data(), static_cast<std::size_t>(file.gcount()));
  }
  if (file.bad())
    throw SystemError(fmt::format("{}: reading failed: {}", path.string(), std::strerror(errno)));
  return text;
}

}  // namespace

CheckedTable::CheckedTable(std::shared_ptr<Section> section) : section_(std::move(section)) {}

CheckedTable CheckedTable::parse_file(const std::filesystem::path& path) {
  return parse_text(read_file(path), path.string());
}

CheckedTable CheckedTable::parse_text(std::string_view text, std::string name) {
  auto document = std::make_shared<Section::Document>();
  document->name = std::move(name);
  document->text = text;
  try {
    document->root = toml::parse(text);
  } catch (const toml::parse_error& error) {
    const auto position = error.source().begin;
    throw InputError(fmt::format("{}:{}:{}: TOML syntax error: {}", document->name, position.line,
                                 position.column, error.description()));
  }
  toml::table* root = &document->root;
  return CheckedTable(std::make_shared<Section>(Section{std::move(document), root, ""}));
}

const std::string& CheckedTable::source_name() const {
  return section_->document->name;
}

const std::string& CheckedTable::path() const {
  return section_->path;
}

std::vector<std::string> CheckedTable::keys() const {
  std::vector<std::string> result;
  for (const auto& [key, node] : *section_->table) {
    result.emplace_back(key.str());
  }
  return result;
}

bool CheckedTable::has(std::string_view key) const {
  return section_->table->contains(key);
}

bool CheckedTable::is_table(std::string_view key) const {
  return has(key) && section_->table->get(key)->is_table();
}

bool CheckedTable::is_list(std::string_view key) const {
  return has(key) && section_->table->get(key)->is_array();
}

bool CheckedTable::is_string(std::string_view key) const {
  return has(key) && section_->table->get(key)->is_string();
}

bool CheckedTable::holds_strings(std::string_view key) const {
  const toml::array* array = has(key) ? section_->table->get(key)->as_array() : nullptr;
  return array != nullptr && !array->empty() && array->front().is_string();
}

double CheckedTable::number(std::string_view key, const NumberRange& range) const {
  return section_->number_of(section_->require(key, "a number"), {key}, range);
}

std::int64_t CheckedTable::integer(std::string_view key, std::int64_t lowest, std::int64_t highest) const {
  return section_->integer_of(section_->require(key, "an integer"), {key}, lowest, highest);
}

bool CheckedTable::boolean(std::string_view key) const {
  const auto& node = section_->require(key, "true or false");
  if (!node.is_boolean()) section_->fail(node, {key}, "true or false");
  return node.as_boolean()->get();
}

std::string CheckedTable::string(std::string_view key) const {
  return section_->string_of(section_->require(key, "a string"), {key});
}

std::string CheckedTable::choice(std::string_view key, const std::vector<std::string>& allowed) const {
  std::string expected = allowed.size() > 1 ? "one of " : "";
  for (std::size_t i = 0; i < allowed.size(); ++i) expected += (i ? ", \"" : "\"") + allowed[i] + '"';
  return section_->choice_of(section_->require(key, expected), {key}, allowed);
}

Vec3<double> CheckedTable::vec3(std::string_view key) const {
  return section_->vec3_of(section_->require(key, "an array of 3 numbers [x, y, z]"), {key});
}

CheckedTable CheckedTable::table(std::string_view key) const {
  const std::string child = (path().empty() ? "" : path() + ".") + std::string(key);
  auto& node = section_->require(key, fmt::format("a section [{}]", child));
  if (!node.is_table()) section_->fail(node, {key}, fmt::format("a section [{}]", child));
  return CheckedTable(std::make_shared<Section>(Section{section_->document, node.as_table(), child}));
}

std::vector<CheckedTable> CheckedTable::tables(std::string_view key) const {
  const std::string child = (path().empty() ? "" : path() + ".") + std::string(key);
  std::vector<CheckedTable> result;
  auto* node = section_->table->get(key);
  if (!node) return result;
  auto* array = node->as_array();
  if (!array || (!array->empty() && !array->is_array_of_tables())) {
    section_->fail(*node, {key}, fmt::format("sections [[{}]]", child));
  }
  for (std::size_t i = 0; i < array->size(); ++i) {
    result.push_back(CheckedTable(std::make_shared<Section>(
        Section{section_->document, array->get(i)->as_table(), fmt::format("{}[{}]", child, i)})));
  }
  return result;
}

std::map<std::string, double> CheckedTable::number_table(std::string_view key) const {
  std::map<std::string, double> numbers;
  table(key).section_->add_numbers("", numbers);
  return numbers;
}

CheckedTable CheckedTable::with(const std::vector<TomlAssignment>& assignments, std::string name) const {
  CheckedTable changed = parse_text(section_->document->text, std::move(name));
  Section::Document& document = *changed.section_->document;
  document.assigned = section_->document->assigned;
  document.assigned.emplace_back(path(), assignments);
  for (const auto& [place, values] : document.assigned) {
    assign(section_at(document.root, place), document.name, values);
  }
  changed.section_->path = path();
  changed.section_->table = &section_at(document.root, path());
  return changed;
}

std::optional<CheckedTable::UnknownKey> CheckedTable::unknown_key(
    const std::vector<std::string>& known) const {
  std::optional<UnknownKey> first;
  for (auto&& [key, node] : *section_->table) {
    if (std::find(known.begin(), known.end(), key.str()) != known.end()) continue;
    const std::size_t line = key.source().begin.line;
    if (first && first->line <= line) continue;
    first = {line, closest_name(key.str(), known).has_value(),
             fmt::format("{}{}: {}", source_name(), line > 0 ? fmt::format(":{}", line) : "",
                         section_->unknown_key_message(key, node, known))};
  }
  return first;
}

void CheckedTable::fail_missing(std::string_view key, const std::string& expected,
                                const std::vector<std::string>& known) const {
  section_->fail_missing(key, expected, known);
}

std::string CheckedTable::section_text(std::string_view key) const {
  return fmt::format("a section [{}{}{}]", path(), path().empty() ? "" : ".", key);
}

CheckedTable CheckedTable::empty_table(std::string_view key) const {
  auto section = std::make_shared<Section>(Section{section_->document, &section_->document->nothing,
                                                   (path().empty() ? "" : path() + ".") + std::string(key)});
  return CheckedTable(std::move(section));
}

std::string CheckedTable::where(std::string_view key, std::initializer_list<std::size_t> indices) const {
  EntryPlace place{key};
  const toml::node* node = key.empty() ? nullptr : section_->table->get(key);
  for (const std::size_t i : indices) {
    place = place.at(i);
    const auto* array = node ? node->as_array() : nullptr;
    if (array && i < array->size()) node = array->get(i);
  }
  return section_->where(node, place);
}

void CheckedTable::fail(std::string_view key, const std::string& message) const {
  fail(key, {}, message);
}

void CheckedTable::fail(std::string_view key, std::initializer_list<std::size_t> indices,
                        const std::string& message) const {
  throw InputError(where(key, indices) + ": " + message);
}

}  // namespace fw
