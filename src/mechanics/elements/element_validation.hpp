#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <string>
#include <string_view>

#include "core/error.hpp"
#include "core/vec3.hpp"

namespace fw::mechanics {

/// Throws InputError `array[index]member: found …, expected …`.
template <class Found>
[[noreturn]] void refuse(std::string_view array, std::size_t index, std::string_view member,
                         const Found& found, std::string_view expected) {
  throw InputError(fmt::format("{}[{}]{}: found {}, expected {}", array, index, member, found, expected));
}

bool is_finite(const Vec3<double>& a);

/// "(x, y, z)".
std::string to_text(const Vec3<double>& a);

/// The following throw InputError that names the entry unless it is as they say.
void require_not_negative(std::string_view array, std::size_t index, std::string_view member, double value);
void require_finite(std::string_view array, std::size_t index, std::string_view member,
                    const Vec3<double>& value);
void require_particle(std::string_view array, std::size_t index, std::string_view member, int particle,
                      std::size_t count);

}  // namespace fw::mechanics
