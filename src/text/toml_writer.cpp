#include "text/toml_writer.hpp"

#include <fmt/format.h>

#include <cmath>
#include <sstream>

namespace fw {
namespace {

bool is_bare_key(std::string_view key) {
  if (key.empty()) return false;
  for (const char c : key) {
    const bool allowed =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
    if (!allowed) return false;
  }
  return true;
}

std::string key_text(std::string_view key) {
  return is_bare_key(key) ? std::string(key) : toml_quoted(key);
}

bool is_section(const toml::node& node) {
  return node.is_table() || node.is_array_of_tables();  // an empty array is no array of tables
}

void write_value(std::string& out, const toml::node& node);

void write_inline_table(std::string& out, const toml::table& table) {
  out += "{ ";
  bool first = true;
  for (const auto& [key, value] : table) {
    if (!first) out += ", ";
    first = false;
    out += key_text(key.str());
    out += " = ";
    write_value(out, value);
  }
  out += " }";
}

void write_value(std::string& out, const toml::node& node) {
  if (const auto* array = node.as_array()) {
    out += '[';
    bool first = true;
    for (const toml::node& element : *array) {
      if (!first) out += ", ";
      first = false;
      write_value(out, element);
    }
    out += ']';
  } else if (const auto* table = node.as_table()) {
    write_inline_table(out, *table);
  } else if (const auto* number = node.as_floating_point()) {
    out += toml_float(number->get());
  } else if (const auto* integer = node.as_integer()) {
    fmt::format_to(std::back_inserter(out), "{}", integer->get());
  } else if (const auto* text = node.as_string()) {
    out += toml_quoted(text->get());
  } else if (const auto* boolean = node.as_boolean()) {
    out += boolean->get() ? "true" : "false";
  } else {  // dates and times
    std::ostringstream stream;
    node.visit([&stream](const auto& value) { stream << value; });
    out += stream.str();
  }
}

void write_section(std::string& out, const toml::table& table, const std::string& path) {
  for (const auto& [key, value] : table) {
    if (is_section(value)) continue;
    out += key_text(key.str());
    out += " = ";
    write_value(out, value);
    out += '\n';
  }
  for (const auto& [key, value] : table) {
    if (!is_section(value)) continue;
    const std::string child = (path.empty() ? "" : path + ".") + key_text(key.str());
    if (const auto* section = value.as_table()) {
      out += fmt::format("{}[{}]\n", out.empty() ? "" : "\n", child);
      write_section(out, *section, child);
      continue;
    }
    for (const toml::node& element : *value.as_array()) {
      out += fmt::format("{}[[{}]]\n", out.empty() ? "" : "\n", child);
      write_section(out, *element.as_table(), child);
    }
  }
}

}  // namespace

std::string toml_quoted(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (c == '\n') {
      out += "\\n";
    } else if (c == '\t') {
      out += "\\t";
    } else if (byte < 0x20 || byte == 0x7f) {
      out += fmt::format("\\u{:04X}", static_cast<unsigned>(byte));
    } else {
      out += c;
    }
  }
  return out + '"';
}

std::string toml_float(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

std::string to_toml_text(const toml::table& table) {
  std::string out;
  write_section(out, table, "");
  return out;
}

}  // namespace fw
