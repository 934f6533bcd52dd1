#include "integrators/implicit/step_matrix.hpp"

#include <stdexcept>

#include "sparse/sparse_slots.hpp"

namespace fw::integrators {

ShiftedMatrix::ShiftedMatrix(const OdeSystem& system)
    : system_(system), watch_(system.pattern_revision()), matrix_(system.jacobian_pattern()) {}

const SparseMatrix& ShiftedMatrix::assemble(double t, ConstVectorRef y, double eta) {
  if (watch_.has_changed(system_.pattern_revision())) matrix_ = system_.jacobian_pattern();
  system_.jacobian(t, y, matrix_);
  matrix_.coeffs() *= -eta;
  sparse::add_to_diagonal(matrix_, 1.0);
  return matrix_;
}

StepMatrix::StepMatrix(const SecondOrderSystem& system) : StepMatrix(system, nullptr) {}

StepMatrix::StepMatrix(const SecondOrderSystem& system, const ForceSplitting* splitting)
    : system_(system), splitting_(splitting), watch_(system.pattern_revision()) {
  make_pattern();
}

void StepMatrix::make_pattern() {
  stiffness_ = system_.tangent_pattern();
  damping_ = stiffness_;
  matrix_ = stiffness_;
  diagonal_ = sparse::diagonal_slots(matrix_);
  transpose_ = sparse::transpose_slots(matrix_);
}

const SparseMatrix& StepMatrix::assemble(double t, ConstVectorRef q, ConstVectorRef v, double h,
                                         TangentModel model) {
  return assemble(t, q, v, {.damping = -h, .stiffness = -h * h}, model);
}

const SparseMatrix& StepMatrix::assemble(double t, ConstVectorRef q, ConstVectorRef v,
                                         const MatrixFactors& factors, TangentModel model) {
  if (watch_.has_changed(system_.pattern_revision())) make_pattern();
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
