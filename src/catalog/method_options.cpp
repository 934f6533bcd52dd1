#include "catalog/method_options.hpp"

#include <charconv>

namespace fw::catalog {

double positive_number(const MethodOptions& options, const std::string& name, double fallback) {
  const auto option = options.find(name);
  if (option == options.end()) return fallback;
  double value = 0.0;
  const char* end = option->second.data() + option->second.size();
  const auto [stop, error] = std::from_chars(option->second.data(), end, value);
  if (error != std::errc() || stop != end || !(value > 0.0) || value > 1.0) {
    throw InputError(
        fmt::format("option {}: found \"{}\", expected a number in (0, 1]", name, option->second));
  }
  return value;
}

int whole_number(const std::string& name, const std::string& text, int least, int most,
                 const std::string& alternative) {
  int value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end || value < least || value > most) {
    throw InputError(fmt::format("option {}: found \"{}\", expected a whole number from {} to {}{}", name,
                                 text, least, most, alternative));
  }
  return value;
}

double number(const MethodOptions& options, const std::string& name, double fallback) {
  const auto option = options.find(name);
  if (option == options.end()) return fallback;
  double value = 0.0;
  const char* end = option->second.data() + option->second.size();
  const auto [stop, error] = std::from_chars(option->second.data(), end, value);
  if (error != std::errc() || stop != end) {
    throw InputError(fmt::format("option {}: found \"{}\", expected a number", name, option->second));
  }
  return value;
}

int count(const MethodOptions& options, const std::string& name, int fallback) {
  const auto option = options.find(name);
  if (option == options.end()) return fallback;
  int value = 0;
  const char* end = option->second.data() + option->second.size();
  const auto [stop, error] = std::from_chars(option->second.data(), end, value);
  if (error != std::errc() || stop != end) {
    throw InputError(fmt::format("option {}: found \"{}\", expected a whole number", name, option->second));
  }
  return value;
}

std::string text(const MethodOptions& options, const std::string& name) {
  const auto option = options.find(name);
  return option == options.end() ? std::string() : option->second;
}

}  // namespace fw::catalog
