#include "linalg/rigid_body_modes.hpp"

#include <Eigen/Geometry>
#include <Eigen/QR>

namespace fw::linalg {

Matrix rigid_body_modes(const Vector& coordinates, const SparseMatrix& A) {
  const Index particles = coordinates.size() / 3;
  const Eigen::Map<const Eigen::Matrix3Xd> points(coordinates.data(), 3, particles);
  const Eigen::Vector3d centre = points.rowwise().mean();
  const double extent = (points.colwise() - centre).cwiseAbs().maxCoeff();
  const double scale = extent > 0.0 ? 1.0 / extent : 1.0;
  Matrix modes = Matrix::Zero(coordinates.size(), 6);
  for (Index i = 0; i < particles; ++i) {
    const Eigen::Vector3d r = scale * (points.col(i) - centre);
    for (Index axis = 0; axis < 3; ++axis) {
      modes(3 * i + axis, axis) = 1.0;
      modes.block<3, 1>(3 * i, 3 + axis) = Eigen::Vector3d::Unit(axis).cross(r);
    }
  }
  for (Index column = 0; column < A.cols(); ++column) {
    bool is_coupled = false;
    for (SparseMatrix::InnerIterator entry(A, column); entry; ++entry) {
      is_coupled = is_coupled || (entry.row() != column && entry.value() != 0.0);
    }
    if (!is_coupled) modes.row(column).setZero();
  }
  Eigen::ColPivHouseholderQR<Matrix> factorisation(modes);
  factorisation.setThreshold(1e-10);
  const Index rank = factorisation.rank();
  return factorisation.householderQ() * Matrix::Identity(coordinates.size(), rank);
}

}  // namespace fw::linalg
