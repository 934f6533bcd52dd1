#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <utility>
#include <vector>

#include "catalog/method_call.hpp"
#include "core/error.hpp"

namespace fw::catalog {

/// The value of an option out of a list of names.
template <class Value>
Value choose(const MethodOptions& options, const std::string& name, Value fallback,
             const std::vector<std::pair<std::string, Value>>& values) {
  const auto option = options.find(name);
  if (option == options.end()) return fallback;
  std::vector<std::string> names;
  for (const auto& [text, value] : values) {
    if (text == option->second) return value;
    names.push_back(text);
  }
  throw InputError(fmt::format("option {}: found \"{}\", expected one of {}", name, option->second,
                               fmt::join(names, ", ")));
}

/// A number in (0, 1].
double positive_number(const MethodOptions& options, const std::string& name, double fallback);

/// `text` as a whole number of a range; `alternative` is what else is allowed, for the message.
int whole_number(const std::string& name, const std::string& text, int least, int most,
                 const std::string& alternative = "");

/// A number whose range the method itself checks.
double number(const MethodOptions& options, const std::string& name, double fallback);

/// A count whose range the method itself checks.
int count(const MethodOptions& options, const std::string& name, int fallback);

/// The text of an option, or nothing.
std::string text(const MethodOptions& options, const std::string& name);

}  // namespace fw::catalog
