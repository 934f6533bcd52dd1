#include "catalog/declared_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/error.hpp"
#include "text/closest_name.hpp"

namespace fw::catalog {

namespace {

/// The whole text as a number; false where it is none.
template <class Number>
bool parse(const std::string& text, Number& number) {
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  return error == std::errc() && stop == end;
}

}  // namespace

void OptionReader::visit(const settings::Setting& setting) {
  const settings::SettingInfo& info = setting.info();
  const auto given = given_.find(info.name);
  if (given == given_.end()) return;
  const std::string& text = given->second;
  const auto fail = [&](const std::string& more = "") {
    throw InputError(fmt::format("option {}: found \"{}\", expected {}{}", info.name, text,
                                 settings::expectation(info), more));
  };
  if (info.type == settings::Type::number) {
    double number = 0.0;
    if (!parse(text, number) || !std::isfinite(number) || !info.range.contains(number)) fail();
    setting.assign(number);
  } else if (info.type == settings::Type::integer && !info.word.empty() && text == info.word) {
    setting.assign(text);
  } else if (info.type == settings::Type::integer) {
    std::int64_t number = 0;
    if (!parse(text, number) || number < info.lowest || number > info.highest) fail();
    setting.assign(number);
  } else {
    const bool is_known = std::find(info.choices.begin(), info.choices.end(), text) != info.choices.end();
    if (!info.choices.empty() && !is_known) fail(did_you_mean(text, info.choices));
    setting.assign(text);
  }
}

std::string default_text(const settings::SettingDescription& option) {
  if (!option.info.default_text.empty() || !option.default_value) return option.info.default_text;
  if (const auto* text = std::get_if<std::string>(&*option.default_value)) return *text;
  if (const auto* number = std::get_if<double>(&*option.default_value)) return fmt::format("{}", *number);
  return toml_text(*option.default_value);
}

}  // namespace fw::catalog
