#include "integrators/implicit/stage_matrix.hpp"

#include <stdexcept>

namespace fw::integrators {

StageMatrix::StageMatrix(const SparseMatrix& pattern, int stages, const std::vector<char>& is_present)
    : stages_(stages), is_present_(is_present) {
  const int n = static_cast<int>(pattern.cols());
  for (int i = 0; i < stages; ++i) is_present_[static_cast<std::size_t>(i * stages + i)] = 1;
  Index blocks = 0;
  for (const char present : is_present_) blocks += present != 0 ? 1 : 0;
  matrix_.resize(static_cast<Index>(stages) * n, static_cast<Index>(stages) * n);
  matrix_.resizeNonZeros(blocks * pattern.nonZeros());
  int* outer = matrix_.outerIndexPtr();
  int* inner = matrix_.innerIndexPtr();
  int count = 0;
  *outer++ = 0;
  for (int j = 0; j < stages; ++j) {
    for (int column = 0; column < n; ++column) {
      for (int i = 0; i < stages; ++i) {
        if (is_present_[static_cast<std::size_t>(i * stages + j)] == 0) continue;
        for (int k = pattern.outerIndexPtr()[column]; k < pattern.outerIndexPtr()[column + 1]; ++k) {
          const int row = pattern.innerIndexPtr()[k];
          if (i == j && row == column) diagonal_.push_back(count);
          inner[count++] = i * n + row;
        }
      }
      *outer++ = count;
    }
  }
  matrix_.coeffs().setZero();
  if (static_cast<Index>(diagonal_.size()) != matrix_.cols()) {
    throw std::logic_error("the pattern of a stage matrix must have a full diagonal");
  }
}

const SparseMatrix& StageMatrix::assemble(ConstVectorRef diagonal, const std::vector<Part>& parts) {
  const auto s = static_cast<std::size_t>(stages_);
  const SparseMatrix& pattern = parts.front().matrix;
  double* value = matrix_.valuePtr();
  for (std::size_t j = 0; j < s; ++j) {
    for (Index column = 0; column < pattern.cols(); ++column) {
      const int begin = pattern.outerIndexPtr()[column], end = pattern.outerIndexPtr()[column + 1];
      for (std::size_t i = 0; i < s; ++i) {
        if (is_present_[i * s + j] == 0) continue;
        for (int k = begin; k < end; ++k) {
          double sum = 0.0;
          for (const Part& part : parts)
            sum += part.factor * part.weights[i * s + j] * part.matrix.valuePtr()[k];
          *value++ = sum;
        }
      }
    }
  }
  for (std::size_t k = 0; k < diagonal_.size(); ++k) {
    matrix_.valuePtr()[diagonal_[k]] += diagonal[static_cast<Index>(k) % diagonal.size()];
  }
  return matrix_;
}

}  // namespace fw::integrators
