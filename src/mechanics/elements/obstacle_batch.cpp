#include "mechanics/elements/obstacle_batch.hpp"

#include <cmath>

#include "mechanics/elements/element_validation.hpp"

namespace fw::mechanics {

namespace {

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

void validate_obstacle(const Obstacle& obstacle, std::size_t number) {
  require_not_negative("obstacles", number, ".stiffness", obstacle.stiffness);
  require_not_negative("obstacles", number, ".damping", obstacle.damping);
  std::visit(ShapeValidation{number}, obstacle.shape);
}

}  // namespace fw::mechanics
