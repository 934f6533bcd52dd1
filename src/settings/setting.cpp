#include "settings/setting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace fw::settings {

std::string expectation(const SettingInfo& info) {
  constexpr auto none_below = std::numeric_limits<std::int64_t>::min();
  constexpr auto none_above = std::numeric_limits<std::int64_t>::max();
  const bool has_lowest = info.lowest != none_below, has_highest = info.highest != none_above;
  const std::string integers = has_lowest && has_highest
                                   ? fmt::format(" from {} to {}", info.lowest, info.highest)
                               : has_lowest  ? fmt::format(" >= {}", info.lowest)
                               : has_highest ? fmt::format(" <= {}", info.highest)
                                             : "";
  std::string names;
  for (const std::string& name : info.choices) names += (names.empty() ? "\"" : ", \"") + name + '"';
  switch (info.type) {
    case Type::number:
      return "a finite number" + info.range.text();
    case Type::integer:
      return "an integer" + integers + (info.word.empty() ? "" : fmt::format(", or \"{}\"", info.word));
    case Type::boolean:
      return "true or false";
    case Type::string:
      return names.empty() ? "a string" : "one of " + names;
    case Type::vector:
      return "an array of 3 numbers [x, y, z]";
    case Type::numbers:
      return "a list of finite numbers" + info.range.text();
    case Type::integers:
      return "a list of integers" + integers;
    case Type::strings:
      return names.empty() ? "a list of strings" : "a list of " + names;
    case Type::number_table:
      return "a table of numbers";
    case Type::sequence:
      return "a list of finite numbers" + info.range.text() + ", or { from, to, count }";
    case Type::vectors:
      return "an array of vectors [x, y, z]";
    case Type::number_or_list:
      return fmt::format("one number, or an array with one number per {} ({})", info.what, info.count);
    case Type::number_or_table:
      return "a number";
    case Type::indices:
      return fmt::format("an array of {} indices", info.what);
    case Type::index_pairs:
      return fmt::format("an array of pairs [i, j] of {} indices", info.what);
    case Type::points:
      return fmt::format("the index of a {} or a name, or an array of these", info.what);
    case Type::numbers_or_strings:
      return "a list of numbers or of strings";
  }
  return "";
}

template Setting::Setting(std::string_view, double&);
template Setting::Setting(std::string_view, int&);
template Setting::Setting(std::string_view, std::int64_t&);
template Setting::Setting(std::string_view, std::uint64_t&);
template Setting::Setting(std::string_view, bool&);
template Setting::Setting(std::string_view, std::string&);
template Setting::Setting(std::string_view, Vec3<double>&);
template Setting::Setting(std::string_view, std::vector<double>&);
template Setting::Setting(std::string_view, std::vector<std::int64_t>&);
template Setting::Setting(std::string_view, std::vector<std::string>&);
template Setting::Setting(std::string_view, std::optional<double>&);
template Setting::Setting(std::string_view, std::optional<std::int64_t>&);
template Setting::Setting(std::string_view, std::optional<std::string>&);
template Setting::Setting(std::string_view, std::optional<std::vector<double>>&);
template Setting::Setting(std::string_view, std::optional<std::vector<std::string>>&);

Setting::Setting(const Setting&) = default;
Setting::Setting(Setting&&) noexcept = default;
Setting& Setting::operator=(const Setting&) = default;
Setting& Setting::operator=(Setting&&) noexcept = default;
Setting::~Setting() = default;

Setting& Setting::unit(std::string_view text) {
  return info_.unit = text, *this;
}

Setting& Setting::doc(std::string_view text) {
  return info_.doc = text, *this;
}

Setting& Setting::required() {
  return info_.is_required = true, *this;
}

Setting& Setting::default_text(std::string_view text) {
  return info_.default_text = text, *this;
}

Setting& Setting::positive() {
  return info_.range = NumberRule::positive, *this;
}

Setting& Setting::nonnegative() {
  return info_.range = NumberRule::nonnegative, *this;
}

Setting& Setting::between(double lowest, double highest) {
  return info_.range = {lowest, highest}, *this;
}

Setting& Setting::at_least_number(double lowest) {
  return info_.range.lowest = lowest, *this;
}

Setting& Setting::up_to(double bound) {
  return info_.range.highest = bound, *this;
}

Setting& Setting::at_least(std::int64_t lowest) {
  return info_.lowest = lowest, *this;
}

Setting& Setting::choices(std::vector<std::string> names) {
  return info_.choices = std::move(names), *this;
}

Setting& Setting::names_of(std::string_view what) {
  return info_.names_of = what, *this;
}

Setting& Setting::entries(std::size_t count) {
  return info_.fewest = info_.most = count, *this;
}

Setting& Setting::not_empty() {
  return info_.fewest = 1, *this;
}

Setting& Setting::or_sequence() {
  return info_.type = Type::sequence, *this;
}

Setting& Setting::quick() {
  return info_.quick = {QuickRule::Kind::same}, *this;
}

Setting& Setting::quick_at_most(std::int64_t bound) {
  return info_.quick = {QuickRule::Kind::at_most, bound}, *this;
}

Setting& Setting::quick_fixed(std::int64_t value) {
  return info_.quick = {QuickRule::Kind::fixed, value}, *this;
}

Setting& Setting::selects_cases() {
  return info_.selects_cases = true, *this;
}

Setting& Setting::above(double bound) {
  info_.range.lowest = bound;
  info_.range.excludes_lowest = true;
  return *this;
}

Setting& Setting::or_one_per(std::string what, std::size_t count) {
  info_.type = Type::number_or_list;
  get_ = [get = get_]() -> std::optional<TomlValue> {
    std::optional<TomlValue> held = get();
    const auto* numbers = held ? std::get_if<std::vector<double>>(&*held) : nullptr;
    return numbers != nullptr && numbers->size() == 1 ? TomlValue(numbers->front()) : held;
  };
  return into(std::move(what), count);
}

Setting& Setting::or_by_name(std::vector<std::string> names) {
  info_.type = Type::number_or_table;
  return choices(std::move(names));
}

Setting& Setting::into(std::string what, std::size_t count) {
  info_.what = std::move(what);
  info_.count = count;
  return *this;
}

Setting& Setting::integers(std::int64_t lowest, std::int64_t highest) {
  info_.lowest = lowest;
  info_.highest = highest;
  return *this;
}

Setting& Setting::or_word(std::string word, std::int64_t value) {
  info_.word = std::move(word);
  get_ = [get = get_, word = info_.word, value]() -> std::optional<TomlValue> {
    std::optional<TomlValue> held = get();
    if (held && std::get<std::int64_t>(*held) == value) return TomlValue(word);
    return held;
  };
  set_ = [set = set_, value](const TomlValue& given) {
    set(std::holds_alternative<std::string>(given) ? TomlValue(value) : given);
  };
  return *this;
}

SettingInfo Setting::quick_info() const {
  SettingInfo info = info_;
  info.is_required = false;
  info.quick = {};
  info.default_text = info_.quick.kind == QuickRule::Kind::fixed ? fmt::format("`{}`", info_.quick.bound)
                      : info_.quick.kind == QuickRule::Kind::at_most
                          ? fmt::format("`{}`, at most {}", info_.name, info_.quick.bound)
                          : fmt::format("`{}`", info_.name);
  return info;
}

TomlValue Setting::quick_default() const {
  const std::optional<TomlValue> full = value();
  if (!full) throw std::logic_error("a setting without a value has no default in [quick]: " + info_.name);
  // A word in the place of an integer has no size.
  if (info_.quick.kind == QuickRule::Kind::same || std::holds_alternative<std::string>(*full)) return *full;
  if (info_.quick.kind == QuickRule::Kind::fixed) return info_.quick.bound;
  return std::min(std::get<std::int64_t>(*full), info_.quick.bound);
}

}  // namespace fw::settings
