#pragma once

#include <variant>

#include "mechanics/elements/anchor_batch.hpp"
#include "mechanics/elements/gravity_drag_batch.hpp"
#include "mechanics/elements/obstacle_batch.hpp"
#include "mechanics/elements/spring_batch.hpp"

namespace fw::mechanics {

/// Every type of force element there is: the one line where a new one is registered. A type T has
///  - `arity` (nodes per element), `labels`, `Tangent` (see tangent_blocks.hpp), `size()`, `nodes(e)`;
///  - `force(e, x, v, degenerate)` and `energy(e, x)` as templates over the scalar, so that Float128 and
///    Complex follow from the same lines;
///  - `tangent(e, x, v, model, out, degenerate)`, false where it is zero;
///  - `dissipated_power(e, x, v, degenerate)`, or `total_dissipated_power(v)` for all at once;
///  - `force_class()`, `has_kinks()`, `is_internal()` (sums of forces and torques vanish),
///  `validate(particles)`;
///  - `damping_force(e, x, v)` where an elastic element has a damper; `discrete_force(e, x, new_x, mean_v)`
///    where energy-momentum schemes have something better than the midpoint; `rate(e)` [N/m] where it can be
///    stiffer than others;
///  - where it `has_kinks()`, `phase(e, x, v)`, `stays(e, phase, paths)`, `kink(...)` and `switch_number(e)`
///    (see switch_search.hpp): integrators know then where their steps have to end.
/// `degenerate` goes up by one for an element that has no direction.
using ElementBatch =
    std::variant<GravityDragBatch, SpringBatch<SpringLaw::hooke>, SpringBatch<SpringLaw::strain>,
                 SpringBatch<SpringLaw::tension_only>, AnchorBatch, ObstacleBatch<Plane>,
                 ObstacleBatch<Sphere>, ObstacleBatch<Box>>;

}  // namespace fw::mechanics
