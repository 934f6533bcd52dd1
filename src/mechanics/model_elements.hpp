#pragma once

#include <memory>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "mechanics/assembly/assembly_of.hpp"
#include "mechanics/mass_spring_model.hpp"

namespace fw::mechanics {

/// The force elements of a model in the order in which they are summed: gravity and drag, the groups of
/// springs, anchors, obstacles, further elements. The batches view the model, which has to outlive them.
/// Throws InputError if an array of the springs has another length than the others.
template <class Batch>
std::vector<Batch> elements_of(const MassSpringModel& model) {
  validate_arrays(model.springs);
  std::vector<Batch> batches;
  batches.reserve(3 + model.springs.groups.size() + model.obstacles.size() + model.further_elements.size());
  batches.emplace_back(GravityDragBatch{model.mass, model.gravity, model.drag, model.mass_drag});
  model.springs.for_each_group([&](const SpringGroup& group, std::size_t begin) {
    with_spring_law(group.law, [&](auto law) {
      batches.emplace_back(SpringBatch<law()>{&model.springs, begin, begin + group.size});
    });
  });
  batches.emplace_back(AnchorBatch{model.anchors});
  for (std::size_t k = 0; k < model.obstacles.size(); ++k) {
    const Obstacle& obstacle = model.obstacles[k];
    std::visit(
        [&]<class Shape>(const Shape&) {
          batches.emplace_back(ObstacleBatch<Shape>{&obstacle, k, model.mass.size()});
        },
        obstacle.shape);
  }
  for (const ElementBatch& batch : model.further_elements) {
    std::visit([&](const auto& elements) { batches.emplace_back(elements); }, batch);
  }
  return batches;
}

extern template class AssemblyOf<ElementBatch>;  // compiled once, in model_elements.cpp

/// The sums over the elements of a model and `further` ones, over the types in `Batch`: `ElementBatch`, or a
/// longer list. The model has to outlive them. Throws InputError for a bad model.
template <class Batch>
std::unique_ptr<const ElementAssembly> assemble(const MassSpringModel& model,
                                                std::vector<Batch> further = {}) {
  std::vector<Batch> batches = elements_of<Batch>(model);
  for (Batch& batch : further) batches.push_back(std::move(batch));
  return std::make_unique<const AssemblyOf<Batch>>(std::move(batches), model.mass.size(), model.fixed);
}

}  // namespace fw::mechanics
