#pragma once

#include <string>
#include <vector>

#include "core/verdict.hpp"
#include "ode/integrator.hpp"
#include "schemes/derived_properties.hpp"

namespace fw::analysis {

/// One property of one scheme: what is claimed (MethodInfo), what follows from the coefficients, what the
/// running code shows.
struct PropertyCheck {
  std::string property{};
  std::string claimed{};
  std::string derived{};
  std::string measured{};
  Verdict verdict = Verdict::not_applicable;
  std::string reason{};  ///< what was measured on what, and why it fails
};

/// A scheme and everything that is said of it.
struct SchemeUnderTest {
  const Integrator& integrator;
  const schemes::SchemeData& data;
  /// An independent solver that takes tolerances; null: agreement is not checked.
  const Integrator* oracle = nullptr;
};

/// A part of the verification: it appends what it finds. The functions are pure: the same scheme gives the
/// same verdicts.
struct VerificationPart {
  std::string name;
  void (*check)(const SchemeUnderTest& scheme, std::vector<PropertyCheck>& checks);
};

/// Every part, in the order in which properties are reported. The only place where one is registered.
const std::vector<VerificationPart>& verification_parts();

/// Appends what a part finds. A scheme that throws where it should return a Status fails a
/// property with the name of the part; other parts can go on.
void run_part(const VerificationPart& part, const SchemeUnderTest& scheme,
              std::vector<PropertyCheck>& checks);

/// Checks every property.
std::vector<PropertyCheck> verify(const SchemeUnderTest& scheme);

/// Order for f(t, q), for f(t, q, v) and for ẏ = f(t, y), observed on nonlinear non-autonomous problems with
/// masses other than 1, positions and velocities apart; in binary128 for orders that double cannot show.
/// Where there is a run in binary128, that it is the same scheme as the one in double.
void verify_order(const SchemeUnderTest& scheme, std::vector<PropertyCheck>& checks);
/// Orders of the error estimate and of dense output, from single steps against certified solutions; of dense
/// output also the size of its error against that of the step.
void verify_error_estimate(const SchemeUnderTest& scheme, std::vector<PropertyCheck>& checks);
void verify_dense_output(const SchemeUnderTest& scheme, std::vector<PropertyCheck>& checks);
/// Of every method that chooses its steps, foreign ones too: the largest error of 200 frames inside the steps
/// against the error at the end of the run, on three problems at three tolerances.
void verify_frames(const SchemeUnderTest& scheme, std::vector<PropertyCheck>& checks);
/// The shorter last step where the interval is no whole number of steps (multistep schemes have to refuse
/// it), steps that are rejected and tried again, and that an attempt makes the same step as a constant step.
void verify_step_control(const SchemeUnderTest& scheme, std::vector<PropertyCheck>& checks);
/// Measured error against tolerance over 1e-3 … 1e-10 on three problems.
void verify_tolerance_proportionality(const SchemeUnderTest& scheme, std::vector<PropertyCheck>& checks);
/// R(hJ) from the coefficients against one black-box step, as first-order and as second-order system; for
/// multistep formulas the recurrence, for splitting and Nyström schemes the matrix of the oscillator.
void verify_stability_function(const SchemeUnderTest& scheme, std::vector<PropertyCheck>& checks);
/// A- and L-stability and the real and imaginary intervals, by black-box steps on both sides of each limit.
void verify_stability_limits(const SchemeUnderTest& scheme, std::vector<PropertyCheck>& checks);
/// ẏ = g(t) with polynomials g: exact up to the quadrature order, not beyond.
void verify_polynomial_exactness(const SchemeUnderTest& scheme, std::vector<PropertyCheck>& checks);
/// Right-hand sides per step of explicit schemes.
void verify_evaluation_count(const SchemeUnderTest& scheme, std::vector<PropertyCheck>& checks);
/// A, b, c recovered from the running code by right-hand sides made for it.
void verify_tableau(const SchemeUnderTest& scheme, std::vector<PropertyCheck>& checks);
/// The defect of the derivative of the step map from symplecticity.
void verify_symplecticity(const SchemeUnderTest& scheme, std::vector<PropertyCheck>& checks);
/// n steps, reversed velocities, n steps: the distance from the start in units in the last place.
void verify_reversibility(const SchemeUnderTest& scheme, std::vector<PropertyCheck>& checks);
/// Linear momentum of a free spring network, fixed particles at rest, energy of symplectic and of
/// energy-conserving schemes.
void verify_conservation(const SchemeUnderTest& scheme, std::vector<PropertyCheck>& checks);
/// The end state against the oracle's, within both error estimates.
void verify_agreement(const SchemeUnderTest& scheme, std::vector<PropertyCheck>& checks);

}  // namespace fw::analysis
