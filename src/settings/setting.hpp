#pragma once

#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "text/toml_tree.hpp"

namespace fw::settings {

/// What a setting holds.
enum class Type {
  number,
  integer,
  boolean,
  string,
  vector,              ///< [x, y, z]
  numbers,             ///< a list
  integers,            ///< a list
  strings,             ///< a list
  number_table,        ///< numbers by names that the declaration does not know, also in tables of tables
  sequence,            ///< a list of numbers, or { from, to, count } for a geometric sequence
  vectors,             ///< a list of [x, y, z]
  number_or_list,      ///< one number for all, or a list with one for each of `count`
  number_or_table,     ///< one number for all, or a table with numbers for some of `choices`
  indices,             ///< a list, each in [0, count)
  index_pairs,         ///< a list of [i, j], each in [0, count)
  points,              ///< indices in [0, count) and names out of `choices`, one or a list
  numbers_or_strings,  ///< a list of one or the other
};

/// Numbers or strings, as the list of a file has them.
using NumbersOrStrings = std::variant<std::vector<double>, std::vector<std::string>>;

/// How `[quick]` may replace a setting: a key of the same name, type and range there, whose default is…
struct QuickRule {
  enum class Kind {
    none,     ///< there is no such key
    same,     ///< the setting itself
    at_most,  ///< the setting, at most `bound`
    fixed,    ///< `bound`
  };
  Kind kind = Kind::none;
  std::int64_t bound = 0;
};

/// All that a declaration says of a setting; ranges and choices are those of the entries of a list.
struct SettingInfo {
  std::string name;
  Type type = Type::number;
  std::string unit{};  ///< of numbers; "1" where they have no dimension
  std::string doc{};   ///< what it means, in Markdown
  NumberRange range{};
  std::int64_t lowest = std::numeric_limits<std::int64_t>::min();
  std::int64_t highest = std::numeric_limits<std::int64_t>::max();
  std::vector<std::string> choices{};  ///< of strings; empty: any
  std::size_t fewest = 0;              ///< entries of a list
  std::size_t most = std::numeric_limits<std::size_t>::max();
  bool is_required = false;
  std::string default_text{};  ///< in Markdown, where the default is worked out from other things
  QuickRule quick{};
  bool selects_cases = false;  ///< says which cases there are, and changes nothing of one
  std::size_t count = 0;       ///< of the things that numbers belong to or indices count
  std::string what{};          ///< they are: "particle"
  std::string word{};          ///< that may stand in the place of an integer
  std::string names_of{};      ///< what the strings name, such as "methods", for completion in editors
};

/// What a message expects: "a finite number > 1", "an integer from 6 to 100", "a list of strings".
std::string expectation(const SettingInfo& info);

/// One setting: what is known of it and the variable that holds its value. The value that the variable has
/// before a file is read is the default; a std::optional without a value has none, and stays empty where the
/// file does not give it.
class Setting {
 public:
  template <class Value>
  Setting(std::string_view name, Value& variable);

  /// One of the names, each for a value of the variable.
  template <class Value>
  Setting(std::string_view name, Value& variable, std::vector<std::pair<std::string, Value>> names);

  // Not inline: every declaration has dozens of settings.
  Setting(const Setting&);
  Setting(Setting&&) noexcept;
  Setting& operator=(const Setting&);
  Setting& operator=(Setting&&) noexcept;
  ~Setting();

  Setting& unit(std::string_view text);
  Setting& doc(std::string_view text);
  Setting& required();
  Setting& default_text(std::string_view text);
  Setting& positive();
  Setting& nonnegative();
  /// Numbers > `bound`.
  Setting& above(double bound);
  /// Numbers from `lowest` to `highest`, both included.
  Setting& between(double lowest, double highest);
  Setting& at_least_number(double lowest);
  /// Numbers ≤ `bound`, beside what else they have to satisfy.
  Setting& up_to(double bound);
  /// Integers from `lowest` to `highest`, both included.
  Setting& integers(std::int64_t lowest, std::int64_t highest);
  Setting& at_least(std::int64_t lowest);
  /// An integer, or a word for this value of the variable: `"auto"` for 0.
  Setting& or_word(std::string word, std::int64_t value);
  Setting& choices(std::vector<std::string> names);
  Setting& names_of(std::string_view what);
  /// Entries of a list.
  Setting& entries(std::size_t count);
  Setting& not_empty();
  /// A list of numbers that may also be { from, to, count }.
  Setting& or_sequence();
  /// One number for all of `count` things, or a list with one for each; so many numbers the variable gets.
  Setting& or_one_per(std::string what, std::size_t count);
  /// One number for all, or a table with numbers for some of these names. The variable has it under "".
  Setting& or_by_name(std::vector<std::string> names);
  /// Indices, pairs of them, or indices and names, into `count` things.
  Setting& into(std::string what, std::size_t count);
  Setting& quick();
  Setting& quick_at_most(std::int64_t bound);
  Setting& quick_fixed(std::int64_t value);
  Setting& selects_cases();

  const SettingInfo& info() const { return info_; }
  /// Nothing for a std::optional without a value.
  std::optional<TomlValue> value() const { return get_(); }
  void assign(const TomlValue& value) const { set_(value); }
  /// The key of `[quick]` that replaces this setting there: its default is worked out from the value here.
  SettingInfo quick_info() const;
  TomlValue quick_default() const;

 private:
  template <class Value>
  static constexpr Type type_of();
  /// Integers of other types than that of TOML.
  template <class Value>
  static constexpr bool is_small_integer =
      std::is_integral_v<Value> && !std::is_same_v<Value, bool> && !std::is_same_v<Value, std::int64_t>;

  SettingInfo info_;
  std::function<std::optional<TomlValue>()> get_;
  std::function<void(const TomlValue&)> set_;
};

/// A setting of a variable: double, an integer, bool, std::string, Vec3<double>; lists of double,
/// std::int64_t, std::string, Vec3<double>, int (indices); IndexPairs, PointList, NumberTable,
/// NumbersOrStrings; or a std::optional of one of them.
template <class Value>
Setting setting(std::string_view name, Value& variable) {
  return Setting(name, variable);
}

/// A setting whose values have names: `choice("control", control, {{"fixed", Control::fixed}, …})`.
template <class Value>
Setting choice(std::string_view name, Value& variable,
               std::initializer_list<std::pair<std::string, std::type_identity_t<Value>>> names) {
  return Setting(name, variable, std::vector<std::pair<std::string, Value>>(names));
}

template <class Value>
constexpr Type Setting::type_of() {
  if constexpr (std::is_same_v<Value, double>) return Type::number;
  if constexpr (std::is_same_v<Value, std::int64_t>) return Type::integer;
  if constexpr (std::is_same_v<Value, bool>) return Type::boolean;
  if constexpr (is_small_integer<Value>) return Type::integer;
  if constexpr (std::is_same_v<Value, std::vector<Vec3<double>>>) return Type::vectors;
  if constexpr (std::is_same_v<Value, std::vector<int>>) return Type::indices;
  if constexpr (std::is_same_v<Value, IndexPairs>) return Type::index_pairs;
  if constexpr (std::is_same_v<Value, PointList>) return Type::points;
  if constexpr (std::is_same_v<Value, std::string>) return Type::string;
  if constexpr (std::is_same_v<Value, Vec3<double>>) return Type::vector;
  if constexpr (std::is_same_v<Value, std::vector<double>>) return Type::numbers;
  if constexpr (std::is_same_v<Value, std::vector<std::int64_t>>) return Type::integers;
  if constexpr (std::is_same_v<Value, std::vector<std::string>>) return Type::strings;
  if constexpr (std::is_same_v<Value, NumberTable>) return Type::number_table;
  if constexpr (std::is_same_v<Value, NumbersOrStrings>) return Type::numbers_or_strings;
}

namespace detail {
template <class Value>
struct Plain {
  using type = Value;
};
template <class Value>
struct Plain<std::optional<Value>> {
  using type = Value;
};
}  // namespace detail

template <class Variable>
Setting::Setting(std::string_view name, Variable& variable) {
  using Value = typename detail::Plain<Variable>::type;
  info_.name = name;
  info_.type = type_of<Value>();
  get_ = [&variable]() -> std::optional<TomlValue> {
    const Value* held = nullptr;
    if constexpr (std::is_same_v<Value, Variable>) {
      held = &variable;
    } else if (variable) {
      held = &*variable;
    }
    if (held == nullptr) return std::nullopt;
    if constexpr (std::is_same_v<Value, NumbersOrStrings>) {
      return std::visit([](const auto& list) { return TomlValue(list); }, *held);
    } else if constexpr (is_small_integer<Value>) {
      return TomlValue(static_cast<std::int64_t>(*held));
    } else if constexpr (std::is_same_v<Value, std::vector<int>>) {
      return TomlValue(std::vector<std::int64_t>(held->begin(), held->end()));
    } else {
      return TomlValue(*held);
    }
  };
  set_ = [&variable](const TomlValue& value) {
    if constexpr (std::is_same_v<Value, NumbersOrStrings>) {
      if (const auto* numbers = std::get_if<std::vector<double>>(&value)) {
        variable = NumbersOrStrings(*numbers);
      } else {
        variable = NumbersOrStrings(std::get<std::vector<std::string>>(value));
      }
    } else if constexpr (is_small_integer<Value>) {
      variable = static_cast<Value>(std::get<std::int64_t>(value));
    } else if constexpr (std::is_same_v<Value, std::vector<int>>) {
      Value list;
      for (const std::int64_t index : std::get<std::vector<std::int64_t>>(value)) {
        list.push_back(static_cast<int>(index));
      }
      variable = std::move(list);
    } else {
      variable = std::get<Value>(value);
    }
  };
}

template <class Value>
Setting::Setting(std::string_view name, Value& variable, std::vector<std::pair<std::string, Value>> names) {
  info_.name = name;
  info_.type = Type::string;
  for (const auto& [text, value] : names) info_.choices.push_back(text);
  get_ = [&variable, names]() -> std::optional<TomlValue> {
    for (const auto& [text, value] : names) {
      if (value == variable) return TomlValue(text);
    }
    return std::nullopt;
  };
  set_ = [&variable, names](const TomlValue& given) {
    for (const auto& [text, value] : names) {
      if (text == std::get<std::string>(given)) variable = value;
    }
  };
}

// Compiled once, in setting.cpp.
extern template Setting::Setting(std::string_view, double&);
extern template Setting::Setting(std::string_view, int&);
extern template Setting::Setting(std::string_view, std::int64_t&);
extern template Setting::Setting(std::string_view, std::uint64_t&);
extern template Setting::Setting(std::string_view, bool&);
extern template Setting::Setting(std::string_view, std::string&);
extern template Setting::Setting(std::string_view, Vec3<double>&);
extern template Setting::Setting(std::string_view, std::vector<double>&);
extern template Setting::Setting(std::string_view, std::vector<std::int64_t>&);
extern template Setting::Setting(std::string_view, std::vector<std::string>&);
extern template Setting::Setting(std::string_view, std::optional<double>&);
extern template Setting::Setting(std::string_view, std::optional<std::int64_t>&);
extern template Setting::Setting(std::string_view, std::optional<std::string>&);
extern template Setting::Setting(std::string_view, std::optional<std::vector<double>>&);
extern template Setting::Setting(std::string_view, std::optional<std::vector<std::string>>&);

}  // namespace fw::settings
