#pragma once

#include <map>
#include <string>

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

}  // namespace fw::catalog
