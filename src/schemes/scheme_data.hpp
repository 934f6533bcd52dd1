#pragma once

#include <optional>
#include <variant>

#include "schemes/additive_tableau.hpp"
#include "schemes/butcher_tableau.hpp"
#include "schemes/multistep_formula.hpp"
#include "schemes/nystrom_tableau.hpp"
#include "schemes/rosenbrock_tableau.hpp"
#include "schemes/splitting_scheme.hpp"

namespace fw::schemes {

/// What defines a scheme; std::monostate where it is not given by coefficients.
using SchemeData = std::variant<std::monostate, ButcherTableau, NystromTableau, SplittingScheme,
                                RosenbrockTableau, AdditiveTableau, MultistepFormula>;

/// The coefficients of a scheme that is a Nyström method: a Nyström tableau or a splitting scheme; empty for
/// all others.
std::optional<NystromValues<Float128>> nystrom_values(const SchemeData& data);

}  // namespace fw::schemes
