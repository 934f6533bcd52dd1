#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "settings/description.hpp"

namespace fw::catalog {

/// Options of a method by name.
using MethodOptions = std::map<std::string, std::string>;

/// A method and its options as one text, `name` or `name[option=value,option=value]`.
struct MethodCall {
  std::string name;
  MethodOptions options;
};

/// Throws InputError where the brackets or an option have no such form.
MethodCall parse_method_call(const std::string& text);

/// An option that a method takes.
struct OptionInfo {
  std::string name;
  std::string default_value;
  std::string expected;  ///< for people: "cg, cholesky or lu"
  /// Type, range and default, of options that are declared (`declared_options`).
  std::optional<settings::SettingDescription> setting{};
};

}  // namespace fw::catalog
