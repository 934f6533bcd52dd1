#pragma once

#include <variant>

#include "schemes/scheme_data.hpp"
#include "schemes/stability_function.hpp"

namespace fw::schemes {

/// What a scheme is on linear systems: all families of coefficients come down to three forms.
///  - R(hJ) of Runge–Kutta and Rosenbrock methods [Hairer, Wanner 1996, IV.3],
///  - stages of a Nyström method, which splittings are as well [Hairer, Lubich, Wanner 2006, II.5],
///  - ρ(E)y = h σ(E)Jy of multistep formulas [Hairer, Wanner 1996, V.1].
/// std::monostate where there are no coefficients, and of additive schemes, which need a splitting of the
/// force.
using LinearForm = std::variant<std::monostate, StabilityFunction, NystromValues<Float128>, MultistepFormula>;

LinearForm linear_form(const SchemeData& data);

}  // namespace fw::schemes
