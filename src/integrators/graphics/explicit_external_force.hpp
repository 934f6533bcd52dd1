#pragma once

#include <cstdint>
#include <string_view>

#include "core/types.hpp"
#include "mechanics/mass_spring_system.hpp"

namespace fw::integrators {

/// The forces of a mass-spring system as graphics' position-based schemes divide them: the elasticity of
/// springs and anchors, which they treat implicitly, and everything else, which they evaluate at the start of
/// the step.
class ExplicitExternalForce {
 public:
  /// Where the dampers of springs and anchors belong.
  enum class Dampers { to_neither, to_external };

  /// The system has to outlive this. Throws InputError that names `method` where other elements than springs
  /// and anchors are elastic.
  ExplicitExternalForce(const mechanics::MassSpringSystem& system, Dampers dampers, std::string_view method);

  /// Gravity, drag, obstacles and, unless left out, dampers at (q, v), and what depends on time alone at the
  /// end `t` of the step [N]; zero on fixed particles.
  void evaluate(double t, ConstVectorRef q, ConstVectorRef v, VectorRef force);

  /// Springs and anchors at rest at q [N]; zero on fixed particles.
  void elastic(ConstVectorRef q, VectorRef force);

 private:
  void choose();

  const mechanics::MassSpringSystem& system_;
  Dampers dampers_;
  std::string_view method_;
  std::uint64_t revision_;  ///< of the elements that the choices are for
  mechanics::ElementChoice external_, elastic_;
  Vector zero_;
};

}  // namespace fw::integrators
