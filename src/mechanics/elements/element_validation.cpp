#include "mechanics/elements/element_validation.hpp"

#include <cmath>

namespace fw::mechanics {

bool is_finite(const Vec3<double>& a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

std::string to_text(const Vec3<double>& a) {
  return fmt::format("({}, {}, {})", a.x, a.y, a.z);
}

void require_not_negative(std::string_view array, std::size_t index, std::string_view member, double value) {
  if (!(value >= 0.0) || !std::isfinite(value)) refuse(array, index, member, value, "a finite number >= 0");
}

void require_finite(std::string_view array, std::size_t index, std::string_view member,
                    const Vec3<double>& value) {
  if (!is_finite(value)) refuse(array, index, member, to_text(value), "finite numbers");
}

void require_particle(std::string_view array, std::size_t index, std::string_view member, int particle,
                      std::size_t count) {
  if (particle < 0 || static_cast<std::size_t>(particle) >= count) {
    refuse(array, index, member, particle, fmt::format("a particle index from 0 to {}", count - 1));
  }
}

}  // namespace fw::mechanics
