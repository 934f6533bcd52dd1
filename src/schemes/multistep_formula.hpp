#pragma once

#include <string>

#include "schemes/coefficient.hpp"

namespace fw::schemes {

/// A linear multistep method Σ_{j=0}^{k} α_j y_{n+j} = h Σ_{j=0}^{k} β_j f_{n+j} with α_k = 1
/// [Hairer, Nørsett, Wanner 1993, III.2].
struct MultistepFormula {
  std::string name{};
  std::string title{};
  CoefficientRow alpha{};  ///< α_0 … α_k
  CoefficientRow beta{};   ///< β_0 … β_k
  std::string reference{};

  int steps() const { return static_cast<int>(alpha.size()) - 1; }
};

}  // namespace fw::schemes
