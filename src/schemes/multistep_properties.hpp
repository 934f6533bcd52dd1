#pragma once

#include <complex>
#include <vector>

#include "schemes/multistep_formula.hpp"

namespace fw::schemes {

/// What follows from the coefficients of a linear multistep method, with its generating polynomials
/// ρ(ζ) = Σ α_j ζ^j and σ(ζ) = Σ β_j ζ^j [Hairer, Nørsett, Wanner 1993, III.2–III.3; Hairer, Wanner 1996,
/// V.1]. Coefficients have to be rational; all functions throw std::logic_error otherwise, and where shapes
/// do not agree or α_k ≠ 1.

/// p, the largest number with C_0 = … = C_p = 0, where C_q = Σ_j (j^q α_j − q j^{q−1} β_j)/q!; exact. −1
/// where C_0 ≠ 0.
int order_of_accuracy(const MultistepFormula& formula);

/// C_{p+1}/σ(1), which belongs to the method and not to its scaling; exact.
Rational error_constant(const MultistepFormula& formula);

/// The root condition: no root of ρ outside the unit circle, and only simple ones on it. Roots are computed
/// in double; one counts as lying on the circle within 1e-6, and as double if another one is nearer than
/// 1e-4.
bool is_zero_stable(const MultistepFormula& formula);

/// The roots of ρ(ζ) − μ σ(ζ), by which the formula's solutions of y' = λy with hλ = μ grow per step; fewer
/// than k where leading coefficients vanish.
std::vector<std::complex<double>> characteristic_roots(const MultistepFormula& formula,
                                                       std::complex<double> mu);

/// The largest root of ρ(ζ) − μ σ(ζ) in modulus: the growth per step on y' = λy with hλ = μ; infinite where
/// α_k = μ β_k.
double amplification(const MultistepFormula& formula, double real, double imaginary);

/// The largest α in degrees, 0 to 90, such that the scheme is stable for all hλ with |arg(−hλ)| < α, by the
/// root locus μ(θ) = ρ(e^{iθ})/σ(e^{iθ}). 90 if and only if it is A-stable. 0 where infinity is not in the
/// region of stability.
double stability_angle(const MultistepFormula& formula);

/// Whether the stability angle is 90 degrees.
bool is_a_stable(const MultistepFormula& formula);

/// Whether α_j = −α_{k−j} and β_j = β_{k−j}: equal to its adjoint [Hairer, Lubich, Wanner 2006, XV.1].
bool is_symmetric(const MultistepFormula& formula);

/// A-stable, and all roots of σ are zero: hλ → −∞ is damped at once.
bool is_l_stable(const MultistepFormula& formula);

}  // namespace fw::schemes
