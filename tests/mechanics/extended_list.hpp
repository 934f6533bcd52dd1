#pragma once

#include <memory>
#include <utility>
#include <variant>
#include <vector>

#include "mechanics/mass_spring_system.hpp"
#include "mechanics/model_elements.hpp"
#include "tetrahedron_volume.hpp"
#include "triangle_area.hpp"

namespace fw::mechanics {

/// The shipped list of force elements and more types.
template <class List, class... More>
struct Extended;
template <class... Shipped, class... More>
struct Extended<std::variant<Shipped...>, More...> {
  using type = std::variant<Shipped..., More...>;
};
using TestBatch = Extended<ElementBatch, TriangleAreaBatch, TetrahedronVolumeBatch>::type;

/// The parts of a system that has these elements besides those of its model. The list is read again when the
/// elements of the system are changed.
inline SystemParts with_elements(std::shared_ptr<const std::vector<TestBatch>> further) {
  return {.elements = [further = std::move(further)](const MassSpringModel& model) {
    return assemble<TestBatch>(model, *further);
  }};
}
inline SystemParts with_elements(std::vector<TestBatch> further) {
  return with_elements(std::make_shared<const std::vector<TestBatch>>(std::move(further)));
}

}  // namespace fw::mechanics
