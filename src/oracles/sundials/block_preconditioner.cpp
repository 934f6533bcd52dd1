#include "oracles/sundials/block_preconditioner.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "sparse/sparse_slots.hpp"

namespace fw::oracles {

namespace {

template <int Size>
using Block = Eigen::Matrix<double, Size, Size>;
template <int Size>
using Part = Eigen::Matrix<double, Size, 1>;

template <int Size>
auto block(std::vector<double>& values, Index i) {
  return Eigen::Map<Block<Size>>(values.data() + i * Size * Size);
}
template <int Size>
auto block(const std::vector<double>& values, Index i) {
  return Eigen::Map<const Block<Size>>(values.data() + i * Size * Size);
}

/// Positions of the entries of the diagonal blocks, column by column, in the values of `matrix`.
std::vector<int> find_blocks(const SparseMatrix& matrix, Index size) {
  std::vector<int> places;
  for (Index j = 0; j < matrix.cols(); ++j) {
    for (Index i = j / size * size; i < (j / size + 1) * size; ++i) {
      places.push_back(sparse::find_slot(matrix, i, j));
    }
  }
  return places;
}

Index block_size_for(const SecondOrderSystem* system) {
  return system != nullptr && system->degrees_of_freedom() % 3 == 0 ? 3 : 1;
}

}  // namespace

BlockPreconditioner::BlockPreconditioner(const OdeSystem& system)
    : system_(system),
      second_order_(system.second_order()),
      block_size_(block_size_for(second_order_)),
      watch_(revision()) {
  make_pattern();
  stiffness_.resize(places_.size());
  damping_.resize(second_order_ != nullptr ? places_.size() : 0);
  inverses_.resize(places_.size());
}

std::uint64_t BlockPreconditioner::revision() const {
  return second_order_ != nullptr ? second_order_->pattern_revision() : system_.pattern_revision();
}

void BlockPreconditioner::make_pattern() {
  matrix_ = second_order_ != nullptr ? second_order_->tangent_pattern() : system_.jacobian_pattern();
  places_ = find_blocks(matrix_, block_size_);
}

Index BlockPreconditioner::block_count() const {
  return matrix_.cols() / block_size_;
}

void BlockPreconditioner::take_blocks(const SparseMatrix& matrix, std::vector<double>& blocks) const {
  std::ranges::transform(places_, blocks.begin(),
                         [&](int place) { return place < 0 ? 0.0 : matrix.valuePtr()[place]; });
  if (second_order_ == nullptr) return;
  // M⁻¹ row by row; blocks lie column by column.
  const Vector& mass = second_order_->mass();
  const Index size = block_size_;
  for (Index k = 0; k < static_cast<Index>(blocks.size()); ++k) {
    blocks[static_cast<std::size_t>(k)] /= mass[k / (size * size) * size + k % size];
  }
}

void BlockPreconditioner::evaluate(double t, ConstVectorRef y, Work& work) {
  ++work.jacobian_evaluations;
  if (watch_.has_changed(revision())) make_pattern();
  if (second_order_ == nullptr) {
    system_.jacobian(t, y, matrix_);
    take_blocks(matrix_, stiffness_);
    return;
  }
  const Index n = second_order_->degrees_of_freedom();
  second_order_->stiffness(t, y.head(n), y.tail(n), TangentModel::exact, matrix_);
  take_blocks(matrix_, stiffness_);
  second_order_->damping(t, y.head(n), y.tail(n), matrix_);
  take_blocks(matrix_, damping_);
}

template <int Size>
bool BlockPreconditioner::factorise_blocks() {
  for (Index i = 0; i < block_count(); ++i) {
    const Block<Size> s = Block<Size>::Identity() - gamma_ * block<Size>(damping_, i) -
                          gamma_ * gamma_ * block<Size>(stiffness_, i);
    auto inverse = block<Size>(inverses_, i);
    inverse = s.inverse();
    // The inverse of what is infinite is zero, which would pass for a preconditioner.
    if (!s.allFinite() || !inverse.allFinite()) return false;
  }
  return true;
}

bool BlockPreconditioner::factorise(double gamma) {
  gamma_ = gamma;
  if (second_order_ != nullptr) return block_size_ == 3 ? factorise_blocks<3>() : factorise_blocks<1>();
  std::ranges::transform(stiffness_, inverses_.begin(), [&](double d) { return 1.0 / (1.0 - gamma * d); });
  return std::ranges::all_of(inverses_, [](double inverse) { return std::isnormal(inverse); });
}

template <int Size>
void BlockPreconditioner::solve_blocks(ConstVectorRef r, VectorRef z) const {
  const Index n = second_order_->degrees_of_freedom();
  const std::vector<char>& fixed = second_order_->fixed();
  for (Index i = 0; i < block_count(); ++i) {
    const Part<Size> position = r.segment<Size>(Size * i), velocity = r.segment<Size>(n + Size * i);
    const Part<Size> v =
        block<Size>(inverses_, i) * (velocity + gamma_ * (block<Size>(stiffness_, i) * position));
    z.segment<Size>(n + Size * i) = v;
    // A fixed degree of freedom has q̇ = 0, not q̇ = v.
    for (Index a = Size * i; a < Size * (i + 1); ++a) {
      z[a] = fixed[static_cast<std::size_t>(a)] != 0 ? r[a] : r[a] + gamma_ * v[a - Size * i];
    }
  }
}

void BlockPreconditioner::solve(ConstVectorRef r, VectorRef z) const {
  if (second_order_ == nullptr) {
    z = r.cwiseProduct(ConstVectorMap(inverses_.data(), r.size()));
  } else if (block_size_ == 3) {
    solve_blocks<3>(r, z);
  } else {
    solve_blocks<1>(r, z);
  }
}

}  // namespace fw::oracles
