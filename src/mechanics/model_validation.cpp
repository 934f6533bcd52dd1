#include "mechanics/model_validation.hpp"

#include <cmath>
#include <cstddef>
#include <limits>

#include "mechanics/elements/element_validation.hpp"

namespace fw::mechanics {

void validate_particles(const MassSpringModel& model) {
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
}

}  // namespace fw::mechanics
