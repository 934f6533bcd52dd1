#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace fw::text {

/// Writes JSON (RFC 8259), indented by two spaces. Numbers are written with the digits that give the same
/// double back; what is not finite has no form in JSON and becomes null. Bytes that are not UTF-8 become
/// U+FFFD.
class JsonWriter {
 public:
  JsonWriter& begin_object() { return begin('{'); }
  JsonWriter& end_object() { return end('}'); }
  JsonWriter& begin_array() { return begin('['); }
  JsonWriter& end_array() { return end(']'); }

  JsonWriter& key(std::string_view name);
  JsonWriter& value(std::string_view text);
  JsonWriter& value(const char* text) { return value(std::string_view(text)); }
  JsonWriter& value(const std::string& text) { return value(std::string_view(text)); }
  JsonWriter& value(double number);
  JsonWriter& value(std::int64_t number);
  JsonWriter& value(std::uint64_t number);
  JsonWriter& value(bool truth);

  const std::string& text() const { return text_; }

 private:
  JsonWriter& begin(char bracket);
  JsonWriter& end(char bracket);
  void separate();
  void quote(std::string_view text);

  std::string text_;
  std::vector<bool> empty_;  ///< per open bracket: nothing inside yet
  bool after_key_ = false;
};

}  // namespace fw::text
