#pragma once

#include "core/state_archive.hpp"
#include "ode/ode_system.hpp"
#include "ode/pattern_watch.hpp"

namespace fw::integrators {

/// The matrix I − ηJ of an implicit step on a first-order system. Its pattern is made once, and anew when the
/// system's `pattern_revision` has changed.
class ShiftedMatrix {
 public:
  explicit ShiftedMatrix(const OdeSystem& system);

  /// I − ηJ(t, y).
  const SparseMatrix& assemble(double t, ConstVectorRef y, double eta);

 private:
  const OdeSystem& system_;
  PatternWatch watch_;
  SparseMatrix matrix_;
};

/// The factors of a combination of mass, damping and stiffness.
struct MatrixFactors {
  double mass = 1.0;
  double damping = 0.0;
  double stiffness = 0.0;
};

/// The matrix A = M − h D − h² K of an implicit step on a second-order system [Zachmann 2011, S26, extended
/// by D]. Its pattern is made once, and anew when the system's `pattern_revision` has changed.
class StepMatrix {
 public:
  explicit StepMatrix(const SecondOrderSystem& system);
  /// The same with the derivatives of the stiff forces only. `assemble` then takes the exact model only.
  StepMatrix(const SecondOrderSystem& system, const ForceSplitting* splitting);

  /// A at (t, q, v), with the tangent stiffness of `model`.
  const SparseMatrix& assemble(double t, ConstVectorRef q, ConstVectorRef v, double h, TangentModel model);

  /// The combination of M, D and K with other factors.
  const SparseMatrix& assemble(double t, ConstVectorRef q, ConstVectorRef v, const MatrixFactors& factors,
                               TangentModel model);

  /// M − h D − h² K restricted to the moving degrees of freedom and made symmetric, ½(A + Aᵀ): rows and
  /// columns of fixed ones hold their mass on the diagonal only. It differs from A by the skew part of the
  /// dampers' position derivative, of size O(h²). For solvers that need a symmetric matrix.
  const SparseMatrix& assemble_symmetric(double t, ConstVectorRef q, ConstVectorRef v, double h,
                                         TangentModel model);

  /// K as it was assembled last.
  const SparseMatrix& stiffness() const { return stiffness_; }

  /// Visits K.
  void serialise(StateArchive& archive) { archive.visit("stiffness", stiffness_); }

 private:
  void make_pattern();

  const SecondOrderSystem& system_;
  const ForceSplitting* splitting_;  ///< null: the whole force
  PatternWatch watch_;
  SparseMatrix stiffness_, damping_, matrix_;
  std::vector<int> diagonal_;   ///< position of each diagonal entry in the value array
  std::vector<int> transpose_;  ///< position of (j, i) for the entry (i, j)
};

}  // namespace fw::integrators
