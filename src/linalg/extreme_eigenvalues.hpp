#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/status.hpp"
#include "core/types.hpp"

namespace fw::linalg {

/// Which end of the spectrum.
enum class SpectrumEnd {
  largest_magnitude,
  smallest_magnitude,  ///< by factorising A (shift and invert at 0): A has to be regular
  largest_real,
  smallest_real,
};

struct EigenvalueOptions {
  SpectrumEnd end = SpectrumEnd::largest_magnitude;
  int count = 1;             ///< how many, from the end inwards
  double tolerance = 1e-10;  ///< ‖A x − λ B x‖₂/(|λ| ‖x‖₂)
  int max_iterations = 0;    ///< restarts of the Krylov space; 0: SLEPc's own limit
  std::string petsc{};       ///< further options in PETSc's notation, such as "-eps_ncv 60"
  bool vectors = false;      ///< whether eigenvectors are wanted
};

struct ExtremeEigenvalues {
  std::vector<Complex> values;    ///< converged ones, from the end inwards
  std::vector<double> residuals;  ///< ‖A x − λ B x‖₂/(|λ| ‖x‖₂) of each, recomputed
  std::vector<Vector> vectors;    ///< of length 1, where they are asked for: their real parts
  Status status;                  ///< fewer than asked for: linear_solver_failed, with SLEPc's own reason
  int iterations = 0;
};

/// Eigenvalues of a symmetric matrix, A x = λ x, by SLEPc's Krylov-Schur iteration [Stewart 2001; Hernandez,
/// Roman, Vidal 2005]. The start vector comes from a fixed seed. Throws InputError for sizes or options that
/// make no sense.
ExtremeEigenvalues extreme_eigenvalues_symmetric(const SparseMatrix& A,
                                                 const EigenvalueOptions& options = {});

/// K x = λ M x for symmetric K and a diagonal M > 0: λ = ω² of an undamped vibration with ∂f/∂q = −K.
ExtremeEigenvalues extreme_eigenvalues_symmetric(const SparseMatrix& K, const Vector& mass,
                                                 const EigenvalueOptions& options = {});

/// out = A x.
using MatrixProduct = std::function<void(ConstVectorRef x, VectorRef out)>;

/// The same for a symmetric matrix of `size` rows that is known by its products alone. `smallest_magnitude`
/// needs the matrix: InputError. What `product` throws is thrown on.
ExtremeEigenvalues extreme_eigenvalues_symmetric(Index size, const MatrixProduct& product,
                                                 const EigenvalueOptions& options = {});

/// Eigenvalues of any real matrix; of a conjugate pair both count.
ExtremeEigenvalues extreme_eigenvalues(const SparseMatrix& A, const EigenvalueOptions& options = {});

}  // namespace fw::linalg
