#pragma once

#include "mechanics/mass_spring_model.hpp"

#include "core/types.hpp"

namespace fw::integrators {

/// The forces of a mass-spring model as graphics' position-based schemes divide them: the elasticity of
/// springs and anchors, which they treat implicitly, and everything else, which they evaluate at the start of
/// the step.
class ExplicitExternalForce {
 public:
  /// `with_dampers`: whether the dampers of springs and anchors belong to the external force (or to neither).
  explicit ExplicitExternalForce(const mechanics::MassSpringModel& model, bool with_dampers = true);

  /// Gravity, drag, obstacles and, unless left out, dampers at (q, v) [N]; zero on fixed particles.
  void evaluate(ConstVectorRef q, ConstVectorRef v, VectorRef force) const;

  /// Springs and anchors without their dampers at q [N]; zero on fixed particles.
  void elastic(ConstVectorRef q, VectorRef force);

 private:
  mechanics::MassSpringModel external_, elastic_;
  Vector zero_;
};

}  // namespace fw::integrators
