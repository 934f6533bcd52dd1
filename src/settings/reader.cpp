#include "settings/reader.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.hpp"
#include "settings/sequence.hpp"

namespace fw::settings {
namespace {

/// What a list has to have, "at least one entry"; nothing where its length is right.
std::string wrong_length(const SettingInfo& info, std::size_t count) {
  if (count >= info.fewest && count <= info.most) return "";
  const std::string found = count == 0   ? "an empty list"
                            : count == 1 ? "one entry"
                                         : fmt::format("{} entries", count);
  if (info.fewest == info.most) return fmt::format("found {}, expected {}", found, info.fewest);
  if (count < info.fewest) {
    return fmt::format("found {}, expected at least {}", found,
                       info.fewest == 1 ? "one entry" : fmt::format("{}", info.fewest));
  }
  return fmt::format("found {}, expected at most {}", found, info.most);
}

template <class Values>
TomlValue checked_list(const CheckedTable& table, const SettingInfo& info, Values values) {
  if (const std::string wrong = wrong_length(info, values.size()); !wrong.empty())
    table.fail(info.name, wrong);
  return values;
}

TomlValue sequence(const CheckedTable& table) {
  if (const auto unknown = table.unknown_key({"from", "to", "count"})) throw InputError(unknown->message);
  return geometric_sequence(table.positive_number("from"), table.positive_number("to"),
                            table.integer("count", 2, 10'000));
}

TomlValue number_or_table(const CheckedTable& table, const SettingInfo& info) {
  if (!table.is_table(info.name)) return NumberTable{{"", table.number(info.name, info.range)}};
  const CheckedTable inner = table.table(info.name);
  if (const auto unknown = inner.unknown_key(info.choices)) throw InputError(unknown->message);
  NumberTable numbers;
  for (const std::string& key : inner.keys()) numbers[key] = inner.number(key, info.range);
  return numbers;
}

TomlValue value_of(const CheckedTable& table, const SettingInfo& info) {
  switch (info.type) {
    case Type::number:
      return table.number(info.name, info.range);
    case Type::integer:
      if (!info.word.empty() && table.is_string(info.name)) return table.choice(info.name, {info.word});
      return table.integer(info.name, info.lowest, info.highest);
    case Type::boolean:
      return table.boolean(info.name);
    case Type::string:
      return info.choices.empty() ? table.string(info.name) : table.choice(info.name, info.choices);
    case Type::vector:
      return table.vec3(info.name);
    case Type::numbers:
      return checked_list(table, info, table.numbers(info.name, info.range));
    case Type::integers:
      return checked_list(table, info, table.integers(info.name, info.lowest, info.highest));
    case Type::strings:
      return checked_list(
          table, info,
          info.choices.empty() ? table.strings(info.name) : table.choices(info.name, info.choices));
    case Type::number_table:
      return table.number_table(info.name);
    case Type::sequence:
      return table.is_table(info.name) ? sequence(table.table(info.name))
                                       : checked_list(table, info, table.numbers(info.name, info.range));
    case Type::vectors:
      return checked_list(table, info, table.vectors(info.name));
    case Type::number_or_list:
      return table.number_or_list(info.name, info.count, info.what, info.range);
    case Type::number_or_table:
      return number_or_table(table, info);
    case Type::indices: {
      const std::vector<int> indices = table.indices(info.name, info.count, info.what);
      return std::vector<std::int64_t>(indices.begin(), indices.end());
    }
    case Type::index_pairs:
      return table.index_pairs(info.name, info.count, info.what);
    case Type::points:
      return table.indices_or_names(info.name, info.count, info.what, info.choices);
    case Type::numbers_or_strings:
      return table.holds_strings(info.name) ? checked_list(table, info, table.strings(info.name))
                                            : checked_list(table, info, table.numbers(info.name, info.range));
  }
  throw std::logic_error("a setting of unknown type");
}

/// "a" and "b" of the names of forms.
std::string quoted_names(const std::vector<const Form*>& forms) {
  std::string text;
  for (std::size_t k = 0; k < forms.size(); ++k) {
    text += (k == 0 ? "\"" : k + 1 == forms.size() ? " and \"" : ", \"") + forms[k]->name + "\"";
  }
  return text;
}

}  // namespace

Reader::Reader(const CheckedTable& table, bool is_quick)
    : is_quick_(is_quick), levels_{{table, TomlTree()}} {}

void Reader::read(const SettingInfo& info, const std::function<void(const TomlValue&)>& assign,
                  const std::optional<TomlValue>& default_value) {
  Level& level = levels_.back();
  level.known.push_back(info.name);
  if (level.missing && !info.what.empty()) return;  // what is missing may tell the count
  if (level.table.has(info.name)) {
    assign(value_of(level.table, info));
    level.resolved.copy(info.name, level.table);
  } else if (info.is_required) {
    if (!level.missing) level.missing = {info.name, expectation(info)};
  } else if (default_value) {
    level.resolved.set(info.name, *default_value);
  }
}

void Reader::visit(const Setting& setting) {
  read(
      setting.info(), [&](const TomlValue& value) { setting.assign(value); }, setting.value());
  if (setting.info().quick.kind != QuickRule::Kind::none) shrinkable_.push_back(setting);
}

void Reader::visit_section(const SectionInfo& info, const std::function<void()>& inside) {
  Level& level = levels_.back();
  level.known.push_back(info.name);
  const bool is_given = level.table.has(info.name);
  if (!is_given && info.is_required) {
    if (!level.missing) level.missing = {info.name, level.table.section_text(info.name)};
    return;
  }
  levels_.push_back({is_given ? level.table.table(info.name) : level.table.empty_table(info.name),
                     level.resolved.table(info.name)});
  inside();
  leave();
}

void Reader::visit_section_of_list(const SectionInfo& info, std::size_t index,
                                   const std::function<void()>& inside) {
  Level& level = levels_.back();
  levels_.push_back({level.table.tables(info.name)[index], level.resolved.table(info.name, index)});
  inside();
  leave();
}

void Reader::visit_free_section(const SectionInfo& info) {
  Level& level = levels_.back();
  level.known.push_back(info.name);
  if (!level.table.has(info.name)) {
    if (!level.missing) level.missing = {info.name, level.table.section_text(info.name)};
    return;
  }
  level.resolved.table(info.name).copy_all(level.table.table(info.name));
}

void Reader::visit_one_of(const std::vector<Form>& forms) {
  const CheckedTable table = levels_.back().table;
  if (levels_.back().missing) {  // of which the section tells
    for (const Form& form : forms) levels_.back().known.push_back(form.name);
    return;
  }
  std::vector<const Form*> given, all;
  for (const Form& form : forms) {
    all.push_back(&form);
    if (table.has(form.name)) given.push_back(&form);
  }
  if (given.empty()) {
    // A misspelt key is the likeliest reason.
    std::vector<std::string> known = levels_.back().known;
    for (const Form& form : forms) known.push_back(form.name);
    if (const auto unknown = table.unknown_key(known); unknown && unknown->has_suggestion) {
      throw InputError(unknown->message);
    }
    throw InputError(
        fmt::format("{}: found none of {}, expected exactly one", table.where(), quoted_names(all)));
  }
  if (given.size() > 1) {
    const std::string place = table.where(given[1]->name);
    throw InputError(given.size() == 2 && forms.size() == 2
                         ? fmt::format("{}: found both of {}, expected exactly one", place, quoted_names(all))
                         : fmt::format("{}: found {}, expected exactly one of {}", place, quoted_names(given),
                                       quoted_names(all)));
  }
  given.front()->declare();
}

void Reader::visit_by(const Setting& setting, const std::vector<Form>& forms) {
  visit(setting);
  const std::optional<TomlValue> value = setting.value();
  if (levels_.back().missing || !value) return;
  for (const Form& form : forms) {
    if (form.name == std::get<std::string>(*value)) form.declare();
  }
}

void Reader::visit_quick(const std::function<void()>& declare_more) {
  Level& level = levels_.back();
  level.known.emplace_back("quick");
  levels_.push_back({level.table.has("quick") ? level.table.table("quick") : level.table.empty_table("quick"),
                     level.resolved.table("quick")});
  for (const Setting& setting : shrinkable_) {
    if (!setting.value()) continue;  // a required one that is missing, of which the section tells
    const TomlValue default_value = setting.quick_default();
    TomlValue value = default_value;
    read(
        setting.quick_info(), [&](const TomlValue& given) { value = given; }, default_value);
    if (is_quick_) setting.assign(value);
  }
  shrinkable_.clear();
  if (declare_more) declare_more();
  leave();
}

bool Reader::has_section(const SectionInfo& info, bool) {
  Level& level = levels_.back();
  level.known.push_back(info.name);
  return level.table.has(info.name);
}

std::size_t Reader::section_count(const SectionInfo& info, std::size_t) {
  Level& level = levels_.back();
  level.known.push_back(info.name);
  const std::size_t count = level.table.tables(info.name).size();
  if (count == 0 && level.table.has(info.name)) {
    if (info.is_required)
      level.table.fail(info.name, "found an empty list of sections, expected at least one");
    level.resolved.copy(info.name, level.table);
  }
  if (count == 0 && info.is_required && level.missing_list.empty()) level.missing_list = info.name;
  return count;
}

std::optional<bool> Reader::gives_list(const std::string& name) const {
  const CheckedTable& table = levels_.back().table;
  return table.has(name) && table.is_list(name);
}

/// Ends the section on top: what is missing is told first, as all keys are known now.
void Reader::leave() {
  const Level& level = levels_.back();
  if (level.missing) level.table.fail_missing(level.missing->first, level.missing->second, level.known);
  const auto unknown = level.table.unknown_key(level.known);
  if (!level.missing_list.empty()) {
    if (unknown && unknown->has_suggestion) throw InputError(unknown->message);
    throw InputError(fmt::format("{}: found no [[{}]], expected at least one", level.table.source_name(),
                                 level.missing_list));
  }
  if (unknown && (!unknown_ || unknown->line < unknown_->line)) unknown_ = unknown;
  if (levels_.size() > 1) levels_.pop_back();
}

void Reader::finish() {
  leave();
  if (unknown_) throw InputError(unknown_->message);
}

}  // namespace fw::settings
