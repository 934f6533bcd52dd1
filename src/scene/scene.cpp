#include "scene/scene.hpp"

namespace fw::scene {

Vector initial_state(const Scene& scene) {
  Vector y(scene.position.size() + scene.velocity.size());
  y << scene.position, scene.velocity;
  return y;
}

}  // namespace fw::scene
