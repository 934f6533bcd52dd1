#pragma once

#include <optional>

#include "schemes/scheme_data.hpp"
#include "schemes/stability_function.hpp"

namespace fw::schemes {

/// A scheme on the oscillator q̈ = −ω²q, as the 2×2 matrix by which it multiplies (q, hv), z = hω.
struct OscillatorStability {
  double interval = 0.0;      ///< largest z up to which the matrix stays power-bounded
  int dispersion_order = 0;   ///< phase per step = z + O(z^{order+1})
  int dissipation_order = 0;  ///< √det = 1 + O(z^{order+1}); −1: det = 1, nothing is dissipated
};

/// What follows from the coefficients of a scheme; empty where a notion does not apply.
struct DerivedProperties {
  std::optional<int> order{};
  std::optional<int> order_with_velocity_forces{};
  std::optional<int> embedded_order{};  ///< only where there is an embedded solution
  std::optional<int> stage_order{};
  std::optional<int> quadrature_order{};  ///< ẏ = g(t) is integrated with this order
  std::optional<double> principal_error{};
  std::optional<bool>
      first_same_as_last{};                ///< the last stage is the new state: one evaluation less per step
  std::optional<bool> stiffly_accurate{};  ///< a_sj = b_j
  std::optional<bool> algebraically_stable{};  ///< b ≥ 0 and BA + AᵀB − bbᵀ ≥ 0: B-stable [HW 1996, IV.12]
  std::optional<bool> symplectic{};            ///< for forces f(t, q) of Nyström type [HLW 2006, VI.4]
  std::optional<bool> symmetric{};             ///< equal to its adjoint [HLW 2006, V.2]
  std::optional<StabilityFunction> stability_function{};
  std::optional<LinearStability> stability{};
  std::optional<OscillatorStability> oscillator{};
  std::optional<bool> zero_stable{};        ///< of multistep formulas: the root condition
  std::optional<double> stability_angle{};  ///< of multistep formulas: A(α) in degrees
  std::optional<double> error_constant{};   ///< of multistep formulas: C_{p+1}/σ(1)
};

DerivedProperties derive(const SchemeData& data);

/// Spectral radius of the oscillator matrix at z = hω.
double oscillator_growth(const NystromValues<Float128>& tableau, double z);

/// Single properties, for the facts of a scheme that are listed.
bool is_symplectic(const ButcherTableau& tableau);
bool is_symplectic(const NystromValues<Float128>& tableau);
bool is_symmetric(const ButcherTableau& tableau);
bool is_symmetric(const NystromValues<Float128>& tableau);
bool is_algebraically_stable(const ButcherTableau& tableau);
bool is_first_same_as_last(const ButcherTableau& tableau);
bool is_stiffly_accurate(const ButcherTableau& tableau);
OscillatorStability oscillator_stability(const NystromValues<Float128>& tableau);

}  // namespace fw::schemes
