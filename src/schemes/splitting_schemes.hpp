#pragma once

#include <vector>

#include "schemes/splitting_scheme.hpp"

namespace fw::schemes {

/// The composition of position Verlet steps (drift ½w, kick w, drift ½w) with the weights w_1 … w_m, w_{m+1}
/// = 1 − 2Σw, w_m … w_1: a symmetric scheme of 2m + 1 kicks whose order is a matter of the weights [Yoshida
/// 1990].
SplittingScheme from_symmetric_weights(SplittingScheme names, const CoefficientRow& weights);

/// Every splitting scheme of the catalogue, by ascending order.
///
/// Where the literature prints decimals of 15 to 26 digits, the numbers here are the solution of the order
/// conditions that is nearest to them, found by Newton's method with 60 digits; they agree with the print to
/// its last digits.
const std::vector<SplittingScheme>& splitting_schemes();

}  // namespace fw::schemes
