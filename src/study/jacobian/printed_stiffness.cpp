#include "study/jacobian/printed_stiffness.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace fw::study {

Matrix printed_stiffness(const mechanics::MassSpringModel& model, ConstVectorRef q, Erratum erratum) {
  const mechanics::Springs& springs = model.springs;
  Matrix K = Matrix::Zero(q.size(), q.size());
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  for (std::size_t e = 0; e < springs.size(); ++e) {
    const Index i = 3 * springs.first[e], j = 3 * springs.second[e];
    const Eigen::Vector3d d = q.segment<3>(j) - q.segment<3>(i);
    const double L = d.norm(), l0 = springs.rest_length[e];
    const double factor = erratum == Erratum::e1 ? 2.0 : -1.0;
    const Eigen::Matrix3d block =
        springs.stiffness[e] * (-I + l0 / L * I + factor * l0 / (L * L * L) * d * d.transpose());
    K.block<3, 3>(i, i) += block;
    K.block<3, 3>(j, j) += block;
    K.block<3, 3>(i, j) -= block;
    K.block<3, 3>(j, i) += erratum == Erratum::e2 ? block : Eigen::Matrix3d(-block);
  }
  return K;
}

double printed_error(double stiffness, double rest_length, double length, Erratum erratum) {
  const double ratio = rest_length / length;
  return erratum == Erratum::e1 ? 3.0 * stiffness * ratio
                                : 2.0 * stiffness * std::max(1.0, std::abs(1.0 - ratio));
}

}  // namespace fw::study
