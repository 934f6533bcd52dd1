#pragma once

#include "conformance/seeded_code.hpp"
#include "conformance/seeded_coefficients.hpp"

namespace fw::conformance {

/// Every mistake that the verification has to notice.
inline const std::vector<SeededBug>& seeded_bugs() {
  static const std::vector<SeededBug> list = [] {
    std::vector<SeededBug> all;
    for (const auto& part : {wrong_coefficients_in_the_code(), wrong_coefficients_in_the_data(),
                             wrong_mechanics(), wrong_algorithms(), wrong_step_control(), wrong_claims()}) {
      all.insert(all.end(), part.begin(), part.end());
    }
    return all;
  }();
  return list;
}

}  // namespace fw::conformance
