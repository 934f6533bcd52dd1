#pragma once

#include <toml++/toml.h>
#include <string>
#include <string_view>

namespace fw {

/// The table as a TOML document. Keys are sorted, plain values before sections, so that equal tables give
/// equal text; numbers are written with the fewest digits that read back to the same double.
std::string to_toml_text(const toml::table& table);

/// A TOML basic string, quoted and escaped, for example `"a\nb"`.
std::string toml_quoted(std::string_view text);

/// A number as a TOML float (always with a point, an exponent, `inf` or `nan`).
std::string toml_float(double value);

}  // namespace fw
