#pragma once

#include <vector>

#include "core/vec3.hpp"
#include "mechanics/driving_force.hpp"
#include "mechanics/elements/element_batch.hpp"

namespace fw::mechanics {

/// The parameters of a mass-spring system [Zachmann 2011, S5-S9, S37]; the state is kept apart.
struct MassSpringModel {
  std::vector<double> mass;  ///< one per particle, > 0 [kg]
  std::vector<int> fixed;    ///< particles that never move
  Springs springs;           ///< in one group or several with laws of their own
  Vec3<double> gravity{};    ///< [m/s²]
  double drag = 0.0;         ///< force −drag·v on every particle [kg/s]
  std::vector<Anchor> anchors;
  std::vector<Obstacle> obstacles;
  std::vector<ElementBatch> further_elements{};  ///< of any type of the list; they own what they hold
  std::vector<DrivingForce> forces{};            ///< functions of time
  std::vector<SupportMotion> support_motions{};  ///< anchors whose rest position moves
  double mass_drag = 0.0;  ///< α of Rayleigh damping: force −α m v on every particle [1/s]
};

}  // namespace fw::mechanics
