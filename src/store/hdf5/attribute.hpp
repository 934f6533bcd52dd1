#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "store/hdf5/hdf5_library.hpp"

namespace fw::store {

using AttributeValue = std::variant<std::int64_t, double, std::string>;
using Attributes = std::vector<std::pair<std::string, AttributeValue>>;

/// A scalar attribute: text as a UTF-8 string of variable length, int64 or float64. Throws LibraryError.
void write_attribute(hid_t object, const std::string& name, const AttributeValue& value);

/// All scalar attributes of an object in the order in which they were made. Throws LibraryError.
Attributes read_attributes(hid_t object);

/// The text of the attribute `name`; empty if it is missing or no text.
std::string text_of(const Attributes& attributes, const std::string& name);

/// The integer of the attribute `name`; `otherwise` if it is missing or no integer.
std::int64_t integer_of(const Attributes& attributes, const std::string& name, std::int64_t otherwise);

/// The type of UTF-8 strings of variable length. Throws LibraryError.
Handle text_type();

/// `text` as it can be stored in a string that ends at its first NUL: each NUL becomes U+FFFD.
std::string without_nul(std::string text);

}  // namespace fw::store
