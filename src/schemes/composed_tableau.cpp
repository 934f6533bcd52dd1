#include "schemes/composed_tableau.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace fw::schemes {

ButcherTableau repeated(const ButcherTableau& tableau, int count) {
  if (count < 1) throw std::logic_error("repeated: expected at least one step");
  const auto part = [count](const Coefficient& whole) {
    return Coefficient(fmt::format("({})/{}", whole.text(), count));
  };
  ButcherTableau result;
  result.name = fmt::format("{}_x{}", tableau.name, count);
  result.title = fmt::format("{} steps of {}", count, tableau.title);
  result.reference = tableau.reference;
  for (int step = 0; step < count; ++step) {
    for (const CoefficientRow& given : tableau.A) {
      CoefficientRow row = result.b;  // the weights of the steps before
      for (const Coefficient& a : given) row.push_back(part(a));
      result.A.push_back(std::move(row));
    }
    CoefficientRow weights = result.b;
    for (const Coefficient& b : tableau.b) weights.push_back(part(b));
    result.b = std::move(weights);
  }
  return result;
}

}  // namespace fw::schemes
