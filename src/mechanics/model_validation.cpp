#include "mechanics/model_validation.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <string_view>

#include "core/error.hpp"
#include "mechanics/spring_force.hpp"

namespace fw::mechanics {

namespace {

template <class Found>
[[noreturn]] void refuse(std::string_view array, std::size_t index, std::string_view member,
                         const Found& found, std::string_view expected) {
  throw InputError(fmt::format("{}[{}]{}: found {}, expected {}", array, index, member, found, expected));
}

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

void validate_springs(const Springs& springs, std::size_t particles) {
  const auto require_size = [&](std::string_view array, std::size_t size) {
    if (size != springs.size()) {
      throw InputError(fmt::format("springs.{}: found {} entries, expected {} (as many as springs.first)",
                                   array, size, springs.size()));
    }
  };
  require_size("second", springs.second.size());
  require_size("stiffness", springs.stiffness.size());
  require_size("damping", springs.damping.size());
  require_size("rest_length", springs.rest_length.size());
  with_spring_law(springs.law, [](auto) {});  // refuses a value outside the enumeration
  for (std::size_t e = 0; e < springs.size(); ++e) {
    require_particle("springs.first", e, "", springs.first[e], particles);
    require_particle("springs.second", e, "", springs.second[e], particles);
    if (springs.first[e] == springs.second[e]) {
      refuse("springs.second", e, "", springs.second[e], "a particle other than springs.first");
    }
    require_not_negative("springs.stiffness", e, "", springs.stiffness[e]);
    require_not_negative("springs.damping", e, "", springs.damping[e]);
    require_not_negative("springs.rest_length", e, "", springs.rest_length[e]);
    if (springs.law == SpringLaw::strain && springs.rest_length[e] == 0.0) {
      refuse("springs.rest_length", e, "", 0.0, "a number > 0 under the law \"strain\"");
    }
  }
}

struct ShapeValidation {
  std::size_t index;

  void operator()(const Plane& plane) const {
    require_finite("obstacles", index, ".point", plane.point);
    require_finite("obstacles", index, ".normal", plane.normal);
    // Formed by rounding a quotient a normal is this close to length 1; anything further off would be scaled
    // into the depth and the force unseen.
    constexpr double tolerance = 1e-12;
    if (!(std::abs(norm(plane.normal) - 1.0) <= tolerance)) {
      refuse("obstacles", index, ".normal", to_text(plane.normal), "a unit vector");
    }
  }
  void operator()(const Sphere& sphere) const {
    require_finite("obstacles", index, ".centre", sphere.centre);
    if (!(sphere.radius > 0.0) || !std::isfinite(sphere.radius)) {
      refuse("obstacles", index, ".radius", sphere.radius, "a finite number > 0");
    }
  }
  void operator()(const Box& box) const {
    require_finite("obstacles", index, ".lower", box.lower);
    require_finite("obstacles", index, ".upper", box.upper);
    if (!(box.lower.x < box.upper.x && box.lower.y < box.upper.y && box.lower.z < box.upper.z)) {
      refuse("obstacles", index, ".upper", to_text(box.upper),
             fmt::format("more than lower = {} in every coordinate", to_text(box.lower)));
    }
  }
};

}  // namespace

void validate(const MassSpringModel& model) {
  const std::size_t particles = model.mass.size();
  if (particles == 0) throw InputError("mass: found 0 entries, expected at least one particle");
  // Degrees of freedom of the first-order system are counted in 32 bits by the sparse matrices.
  constexpr auto most = static_cast<std::size_t>(std::numeric_limits<int>::max()) / 6;
  if (particles > most) {
    throw InputError(fmt::format("mass: found {} entries, expected at most {}", particles, most));
  }
  for (std::size_t i = 0; i < particles; ++i) {
    if (!(model.mass[i] > 0.0) || !std::isfinite(model.mass[i])) {
      refuse("mass", i, "", model.mass[i], "a finite number > 0");
    }
  }
  for (std::size_t k = 0; k < model.fixed.size(); ++k) {
    require_particle("fixed", k, "", model.fixed[k], particles);
  }
  validate_springs(model.springs, particles);
  if (!is_finite(model.gravity)) {
    throw InputError(fmt::format("gravity: found {}, expected finite numbers", to_text(model.gravity)));
  }
  if (!(model.drag >= 0.0) || !std::isfinite(model.drag)) {
    throw InputError(fmt::format("drag: found {}, expected a finite number >= 0", model.drag));
  }
  for (std::size_t k = 0; k < model.anchors.size(); ++k) {
    const Anchor& anchor = model.anchors[k];
    require_particle("anchors", k, ".particle", anchor.particle, particles);
    require_finite("anchors", k, ".rest_position", anchor.rest_position);
    require_not_negative("anchors", k, ".stiffness", anchor.stiffness);
    require_not_negative("anchors", k, ".damping", anchor.damping);
  }
  for (std::size_t k = 0; k < model.obstacles.size(); ++k) {
    const Obstacle& obstacle = model.obstacles[k];
    require_not_negative("obstacles", k, ".stiffness", obstacle.stiffness);
    require_not_negative("obstacles", k, ".damping", obstacle.damping);
    std::visit(ShapeValidation{k}, obstacle.shape);
  }
}

}  // namespace fw::mechanics
