#pragma once

#include <map>
#include <string>
#include <vector>

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
};

}  // namespace fw::catalog
