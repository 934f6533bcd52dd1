#include "integrators/graphics/explicit_external_force.hpp"

#include <algorithm>

#include "mechanics/mass_spring_force.hpp"

namespace fw::integrators {

ExplicitExternalForce::ExplicitExternalForce(const mechanics::MassSpringModel& model, bool with_dampers)
    : external_(model), elastic_(model), zero_(Vector::Zero(3 * static_cast<Index>(model.mass.size()))) {
  std::ranges::fill(external_.springs.stiffness, 0.0);
  external_.springs.law = mechanics::SpringLaw::hooke;
  for (mechanics::Anchor& anchor : external_.anchors) anchor.stiffness = 0.0;
  if (!with_dampers || std::ranges::none_of(model.springs.damping, [](double c) { return c > 0.0; })) {
    external_.springs = {};
  }
  if (!with_dampers) external_.anchors.clear();

  std::ranges::fill(elastic_.springs.damping, 0.0);
  for (mechanics::Anchor& anchor : elastic_.anchors) anchor.damping = 0.0;
  elastic_.gravity = {};
  elastic_.drag = 0.0;
  elastic_.obstacles.clear();
}

void ExplicitExternalForce::evaluate(ConstVectorRef q, ConstVectorRef v, VectorRef force) const {
  mechanics::mass_spring_force(external_, q.data(), v.data(), force.data());
}

void ExplicitExternalForce::elastic(ConstVectorRef q, VectorRef force) {
  mechanics::mass_spring_force(elastic_, q.data(), zero_.data(), force.data());
}

}  // namespace fw::integrators
