#pragma once

#include <string>

#include "analysis/theory/oscillator_amplification.hpp"
#include "analysis/theory/scheme_growth.hpp"

namespace fw::catalog {

/// The coefficients of the method of a call with its options, or of the scheme that it is on forces f(q);
/// std::monostate where it is not given by coefficients. Throws InputError for an unknown method.
schemes::SchemeData equivalent_scheme(const std::string& call);

/// See `study::Catalog::linear_scheme`.
analysis::LinearScheme linear_scheme(const std::string& call);

/// What the coefficients of a method say of linear oscillators, for a call such as "newmark[gamma=0.6]". A
/// method that is not a list of coefficients has the factors of the scheme that it coincides with on linear
/// systems. Empty where nothing is known. Throws InputError for an unknown method or option.
analysis::AmplificationFactors oscillator_theory(const std::string& call);

}  // namespace fw::catalog
