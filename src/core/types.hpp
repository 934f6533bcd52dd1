#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <complex>
#include <cstdint>
#include <span>

namespace fw {

using Index = Eigen::Index;
using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

/// Column vector argument without a copy: accepts vectors, segments and maps of foreign arrays
/// (SUNDIALS, PETSc, GSL).
using ConstVectorRef = const Eigen::Ref<const Eigen::VectorXd>&;
using VectorRef = Eigen::Ref<Eigen::VectorXd>;
using VectorMap = Eigen::Map<Eigen::VectorXd>;
using ConstVectorMap = Eigen::Map<const Eigen::VectorXd>;

/// Compressed sparse columns with 32-bit indices, the layout that KLU, CHOLMOD and SUNDIALS share.
using SparseMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

using Complex = std::complex<double>;

}  // namespace fw
