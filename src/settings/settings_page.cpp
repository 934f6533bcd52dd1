#include "settings/settings_page.hpp"

#include <fmt/format.h>

#include <cmath>

namespace fw::settings {
namespace {

/// "10 000 000"; up to four digits together.
std::string grouped(std::int64_t value) {
  const std::string digits = fmt::format("{}", value);
  const std::size_t first = value < 0 ? 1 : 0, count = digits.size() - first;
  if (count <= 4) return digits;
  std::string text = digits.substr(0, first);
  for (std::size_t k = 0; k < count; ++k) {
    if (k > 0 && (count - k) % 3 == 0) text += ' ';
    text += digits[first + k];
  }
  return text;
}

std::string range_of(const NumberRange& range) {
  const bool has_lowest = std::isfinite(range.lowest), has_highest = std::isfinite(range.highest);
  if (has_lowest && has_highest) {
    return fmt::format(" {}{}…{}{}", range.excludes_lowest ? "> " : "", range.lowest,
                       range.excludes_highest ? "< " : "", range.highest);
  }
  if (has_lowest) return fmt::format(" {} {}", range.excludes_lowest ? ">" : "≥", range.lowest);
  if (has_highest) return fmt::format(" {} {}", range.excludes_highest ? "<" : "≤", range.highest);
  return "";
}

std::string integers_of(const SettingInfo& info) {
  const bool has_lowest = info.lowest != std::numeric_limits<std::int64_t>::min();
  const bool has_highest = info.highest != std::numeric_limits<std::int64_t>::max();
  if (has_lowest && has_highest) return fmt::format(" {}…{}", grouped(info.lowest), grouped(info.highest));
  if (has_lowest) return fmt::format(" ≥ {}", grouped(info.lowest));
  return has_highest ? fmt::format(" ≤ {}", grouped(info.highest)) : "";
}

std::string names_of(const SettingInfo& info) {
  std::string text;
  for (const std::string& name : info.choices)
    text += fmt::format("{}`\"{}\"`", text.empty() ? "" : ", ", name);
  return text;
}

std::string length_of(const SettingInfo& info) {
  return info.fewest > 0 && info.fewest != info.most ? ", not empty" : "";
}

std::string type_of(const SettingInfo& info) {
  const std::string count = info.fewest == info.most ? fmt::format("{} ", info.fewest) : "list of ";
  switch (info.type) {
    case Type::number:
      return "number" + range_of(info.range);
    case Type::integer:
      return "integer" + integers_of(info) +
             (info.word.empty() ? "" : fmt::format(", or `\"{}\"`", info.word));
    case Type::boolean:
      return "boolean";
    case Type::string:
      return info.choices.empty() ? "string" : names_of(info);
    case Type::vector:
      return "vector";
    case Type::numbers:
      return count + "numbers" + range_of(info.range) + length_of(info);
    case Type::integers:
      return count + "integers" + integers_of(info) + length_of(info);
    case Type::strings:
      return count + (info.choices.empty() ? "strings" : names_of(info)) + length_of(info);
    case Type::number_table:
      return "table of numbers";
    case Type::sequence:
      return count + "numbers" + range_of(info.range) + length_of(info) + ", or `{ from, to, count }`";
    case Type::vectors:
      return "list of vectors" + length_of(info);
    case Type::number_or_list:
      return "number" + range_of(info.range) + ", or one per " + info.what;
    case Type::number_or_table:
      return "number" + range_of(info.range) + ", or a table with numbers by name";
    case Type::indices:
      return "list of different indices";
    case Type::index_pairs:
      return "list of index pairs `[i, j]`, i ≠ j";
    case Type::points:
      return "index or name, or a list of these";
    case Type::numbers_or_strings:
      return "list of numbers or strings" + length_of(info);
  }
  return "";
}

std::string default_of(const SettingDescription& setting) {
  if (!setting.info.default_text.empty()) return setting.info.default_text;
  if (setting.info.is_required) return "required";
  return setting.default_value ? fmt::format("`{}`", toml_text(*setting.default_value)) : "";
}

std::string meaning_of(const SettingInfo& info) {
  if (info.unit.empty() || info.unit == "1") return info.doc;
  return info.doc + (info.doc.empty() ? "" : " ") + "[" + info.unit + "]";
}

/// The rows of a section's own keys and of its forms; of a key that several forms have in the same way once.
void add_rows(const SectionDescription& section, const std::string& form, bool has_forms,
              std::vector<std::pair<std::string, std::string>>& rows) {
  for (const SettingDescription& setting : section.settings) {
    const std::string row =
        fmt::format(" {} | {} | {} |", type_of(setting.info), default_of(setting), meaning_of(setting.info));
    const std::string head = fmt::format("| `{}` |", setting.info.name);
    if (has_forms) {
      bool is_there = false;
      for (auto& [known, forms] : rows) {
        if (known != head + "\n" + row) continue;
        forms += ", " + form;
        is_there = true;
      }
      if (is_there) continue;
    }
    rows.emplace_back(head + "\n" + row, form);
  }
  for (const SectionChoice& choice : section.choices) {
    for (const SectionForm& inner : choice.forms) {
      const std::string name = "`" + inner.name + "`";
      add_rows(inner.keys, choice.key.empty() && !form.empty() ? form : name, has_forms, rows);
    }
  }
}

}  // namespace

std::string markdown_table(const SectionDescription& section, const std::string& heading) {
  const bool has_forms = !section.choices.empty();
  std::vector<std::pair<std::string, std::string>> rows;
  add_rows(section, "", has_forms, rows);
  std::string text = fmt::format("| {} |{} type | default | meaning |\n|---|{}---|---|---|\n", heading,
                                 has_forms ? " with |" : "", has_forms ? "---|" : "");
  for (const auto& [row, forms] : rows) {
    const std::size_t cut = row.find('\n');
    text += row.substr(0, cut) + (has_forms ? " " + forms + " |" : "") + row.substr(cut + 1) + "\n";
  }
  return text;
}

}  // namespace fw::settings
