#include "integrators/implicit/step_matrix.hpp"

#include <algorithm>
#include <stdexcept>

namespace fw::integrators {

namespace {

/// Position of entry (row, column) in the value array of a compressed matrix with sorted rows.
int find_entry(const SparseMatrix& matrix, int row, int column) {
  const int* begin = matrix.innerIndexPtr() + matrix.outerIndexPtr()[column];
  const int* end = matrix.innerIndexPtr() + matrix.outerIndexPtr()[column + 1];
  const int* entry = std::lower_bound(begin, end, row);
  if (entry == end || *entry != row) {
    throw std::logic_error("the pattern of a tangent matrix must be symmetric with a full diagonal");
  }
  return static_cast<int>(entry - matrix.innerIndexPtr());
}

}  // namespace

void add_to_diagonal(SparseMatrix& matrix, double value) {
  for (int column = 0; column < static_cast<int>(matrix.cols()); ++column) {
    matrix.valuePtr()[find_entry(matrix, column, column)] += value;
  }
}

StepMatrix::StepMatrix(const SecondOrderSystem& system) : StepMatrix(system, nullptr) {}

StepMatrix::StepMatrix(const SecondOrderSystem& system, const ForceSplitting* splitting)
    : system_(system),
      splitting_(splitting),
      stiffness_(system.tangent_pattern()),
      damping_(stiffness_),
      matrix_(stiffness_) {
  const int n = static_cast<int>(matrix_.cols());
  diagonal_.resize(static_cast<std::size_t>(n));
  transpose_.resize(static_cast<std::size_t>(matrix_.nonZeros()));
  for (int column = 0; column < n; ++column) {
    diagonal_[static_cast<std::size_t>(column)] = find_entry(matrix_, column, column);
    for (int k = matrix_.outerIndexPtr()[column]; k < matrix_.outerIndexPtr()[column + 1]; ++k) {
      transpose_[static_cast<std::size_t>(k)] = find_entry(matrix_, column, matrix_.innerIndexPtr()[k]);
    }
  }
}

const SparseMatrix& StepMatrix::assemble(double t, ConstVectorRef q, ConstVectorRef v, double h,
                                         TangentModel model) {
  return assemble(t, q, v, {.damping = -h, .stiffness = -h * h}, model);
}

const SparseMatrix& StepMatrix::assemble(double t, ConstVectorRef q, ConstVectorRef v,
                                         const MatrixFactors& factors, TangentModel model) {
  if (splitting_ != nullptr) {
    if (model != TangentModel::exact)
      throw std::logic_error("the stiff tangent is available as \"exact\" only");
    splitting_->stiff_stiffness(t, q, v, stiffness_);
    splitting_->stiff_damping(t, q, v, damping_);
  } else {
    system_.stiffness(t, q, v, model, stiffness_);
    system_.damping(t, q, v, damping_);
  }
  matrix_.coeffs() = factors.damping * damping_.coeffs() + factors.stiffness * stiffness_.coeffs();
  for (std::size_t i = 0; i < diagonal_.size(); ++i) {
    matrix_.valuePtr()[diagonal_[i]] += factors.mass * system_.mass()[static_cast<Index>(i)];
  }
  return matrix_;
}

const SparseMatrix& StepMatrix::assemble_symmetric(double t, ConstVectorRef q, ConstVectorRef v, double h,
                                                   TangentModel model) {
  assemble(t, q, v, h, model);
  const std::vector<char>& fixed = system_.fixed();
  double* values = matrix_.valuePtr();
  for (int column = 0; column < static_cast<int>(matrix_.cols()); ++column) {
    for (int k = matrix_.outerIndexPtr()[column]; k < matrix_.outerIndexPtr()[column + 1]; ++k) {
      const int row = matrix_.innerIndexPtr()[k];
      if (row <= column) continue;
      const int mirror = transpose_[static_cast<std::size_t>(k)];
      const bool is_fixed = fixed[static_cast<std::size_t>(row)] || fixed[static_cast<std::size_t>(column)];
      values[k] = values[mirror] = is_fixed ? 0.0 : 0.5 * (values[k] + values[mirror]);
    }
  }
  return matrix_;
}

}  // namespace fw::integrators
