#pragma once

#include <string>
#include <string_view>

namespace fw {

/// SHA-256 of the bytes of `text` as 64 lower-case hexadecimal digits [FIPS 180-4].
std::string sha256_hex(std::string_view text);

}  // namespace fw
