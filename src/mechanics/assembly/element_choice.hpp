#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace fw::mechanics {

/// What a sum over elements takes of one batch.
struct BatchChoice {
  enum class Part {
    none,
    whole,    ///< the whole force
    dampers,  ///< the damping force alone
  };
  Part part = Part::whole;
  std::optional<std::vector<std::size_t>> elements{};  ///< their numbers, ascending; without: all
};

/// One entry per batch.
using ElementChoice = std::vector<BatchChoice>;

/// Calls `visit(e)` for the chosen elements of a batch; `choice` null stands for all.
template <class Batch, class Visit>
void for_each_element(const Batch& batch, const BatchChoice* choice, Visit&& visit) {
  if (choice != nullptr && choice->part == BatchChoice::Part::none) return;
  if (choice != nullptr && choice->elements) {
    for (const std::size_t e : *choice->elements) visit(e);
    return;
  }
  const std::size_t size = batch.size();
  for (std::size_t e = 0; e < size; ++e) visit(e);
}

}  // namespace fw::mechanics
