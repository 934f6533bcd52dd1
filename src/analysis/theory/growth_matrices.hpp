#pragma once

#include <Eigen/Core>

#include "analysis/theory/linear_scheme.hpp"
#include "core/types.hpp"
#include "schemes/nystrom_tableau.hpp"

namespace fw::analysis {

/// The largest eigenvalue in modulus of a real 2×2 matrix, by trace and determinant. What touches the unit
/// circle within rounding (1e-12) lies on it. Infinite where the matrix has an entry that is not finite.
double spectral_radius(const Eigen::Matrix2d& m);
/// The same of any real square matrix, by its eigenvalues as they are computed.
double spectral_radius(const Matrix& m);

/// The matrices by which schemes multiply the state of z̈ = −Wz − Cż in a step h, with a = h²W, b = hC (n ×
/// n).
///
/// Verlet's two-step recurrence of `rule` on (x_n, x_{n−1}), 2n × 2n.
Matrix verlet_recurrence(LinearRule rule, const Matrix& a, const Matrix& b);

/// The alpha family's step on (z, h ż, h² z̈), 3n × 3n [Hughes 1987, 9.3; Chung, Hulbert 1993].
Matrix alpha_step_matrix(const integrators::AlphaParameters& parameters, const Matrix& a, const Matrix& b);

/// The largest root in modulus of that step's characteristic polynomial on one vibration,
///   (λ−1) ((λ−1) M + b A G) + a A (G + (λ−1) B)   with   A = (1−α_f)λ + α_f,  M = (1−α_m)λ + α_m,
///   B = βλ + ½ − β,  G = γλ + 1 − γ.
/// By the Jury criterion [Jury 1964] a polynomial whose roots touch the unit circle within rounding (1e-12)
/// has the radius 1 at most.
double alpha_growth(const integrators::AlphaParameters& parameters, double a, double b);

/// The stages of a Nyström method in double.
class NystromStages {
 public:
  explicit NystromStages(const schemes::NystromValues<Float128>& values);

  /// Whether it has coefficients for forces that depend on velocity.
  bool has_velocity() const { return has_velocity_; }
  /// On (q, hv) of q̈ = −ω²q − cq̇ with a = h²ω², b = hc.
  Eigen::Matrix2d of_vibration(double a, double b) const;
  /// On (z, h ż) of z̈ = −Wz − Cż, 2n × 2n.
  Matrix of_system(const Matrix& W, const Matrix& C, double h) const;

 private:
  Index count_;
  Matrix a_position_, a_velocity_;
  Vector c_, b_position_, b_velocity_;
  bool has_velocity_;
  bool is_diagonal_;  ///< no stage needs a later one
};

}  // namespace fw::analysis
