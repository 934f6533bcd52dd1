#include "analysis/theory/linear_modes.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "dense/eigenvalues.hpp"
#include "linalg/extreme_eigenvalues.hpp"

namespace fw::analysis {

namespace {

/// Relative to the spectral radius: what is below is zero but for rounding.
constexpr double negligible = 1e-10;
/// The same for squares of frequencies.
constexpr double negligible_square = 1e-12;
/// Modes that are coupled less are not coupled but for rounding.
constexpr double negligible_coupling = 1e-9;

/// Keeps the eigenvalues that a scheme can be blamed for.
void keep_eigenvalues(const Eigen::Ref<const Eigen::VectorXcd>& found, LinearModes& modes) {
  for (const Complex& lambda : found)
    modes.spectral_radius = std::max(modes.spectral_radius, std::abs(lambda));
  const double zero = negligible * modes.spectral_radius;
  for (Complex lambda : found) {
    // A double eigenvalue such as 0 of a body at rest is known to the root of the rounding only.
    if (std::abs(lambda) <= 1e-7 * modes.spectral_radius) continue;
    if (lambda.real() > zero) {
      ++modes.growing;
      continue;
    }
    if (std::abs(lambda.real()) <= zero) {
      lambda.real(0.0);
      modes.is_undamped = true;
    }
    modes.eigenvalues.push_back(lambda);
  }
}

/// The roots of λ² + c λ + ω² = 0.
void add_roots(const VibrationMode& mode, std::vector<Complex>& roots) {
  const double half = 0.5 * mode.damping, discriminant = half * half - mode.omega_squared;
  if (discriminant < 0.0) {
    roots.emplace_back(-half, std::sqrt(-discriminant));
    roots.emplace_back(-half, -std::sqrt(-discriminant));
    return;
  }
  const double larger = -half - std::copysign(std::sqrt(discriminant), half);
  roots.emplace_back(larger, 0.0);
  roots.emplace_back(larger == 0.0 ? 0.0 : mode.omega_squared / larger, 0.0);
}

std::vector<Index> moving_indices(const SecondOrderSystem& system) {
  std::vector<Index> moving;
  for (Index i = 0; i < system.degrees_of_freedom(); ++i) {
    if (!system.fixed()[static_cast<std::size_t>(i)]) moving.push_back(i);
  }
  return moving;
}

/// −M^{−1/2} A M^{−1/2} of the moving degrees of freedom, symmetrised.
Matrix mass_scaled(const SparseMatrix& A, const Vector& mass, const std::vector<Index>& moving) {
  const Matrix dense(A);
  const auto n = static_cast<Index>(moving.size());
  Matrix scaled(n, n);
  for (Index j = 0; j < n; ++j) {
    for (Index i = 0; i < n; ++i) {
      const Index k = moving[static_cast<std::size_t>(i)], l = moving[static_cast<std::size_t>(j)];
      scaled(i, j) = -dense(k, l) / std::sqrt(mass[k] * mass[l]);
    }
  }
  return 0.5 * (scaled + scaled.transpose());
}

struct Tangents {
  SparseMatrix stiffness, damping;
};

Tangents tangents_of(const SecondOrderSystem& system, double t, ConstVectorRef y) {
  const Index n = system.degrees_of_freedom();
  Tangents tangents{system.tangent_pattern(), system.tangent_pattern()};
  system.stiffness(t, y.head(n), y.tail(n), TangentModel::exact, tangents.stiffness);
  if (system.force_class() == ForceClass::velocity) system.damping(t, y.head(n), y.tail(n), tangents.damping);
  return tangents;
}

LinearModes dense_modes(const SecondOrderSystem& system, double t, ConstVectorRef y) {
  LinearModes modes;
  const std::vector<Index> moving = moving_indices(system);
  const Tangents tangents = tangents_of(system, t, y);
  modes.stiffness = mass_scaled(tangents.stiffness, system.mass(), moving);
  modes.damping = mass_scaled(tangents.damping, system.mass(), moving);
  const auto n = static_cast<Index>(moving.size());
  if (n == 0) return modes;

  const dense::SymmetricEigen eigen = dense::symmetric_eigen(modes.stiffness);
  const Matrix modal = eigen.vectors.transpose() * modes.damping * eigen.vectors;
  const double most_damping = modal.cwiseAbs().maxCoeff();
  const double largest_square = eigen.values.cwiseAbs().maxCoeff();
  // Whatever C does inside an eigenspace of W is diagonal in the right basis of it, so only entries between
  // different frequencies couple; where the choice of basis matters the dense J below decides.
  if (most_damping > 0.0) {
    const Matrix off = modal - Matrix(modal.diagonal().asDiagonal());
    modes.coupling = off.cwiseAbs().maxCoeff() / most_damping;
    if (modes.coupling <= negligible_coupling) modes.coupling = 0.0;
  }
  std::vector<Complex> roots;
  for (Index i = 0; i < n; ++i) {
    VibrationMode mode{eigen.values[i], modal(i, i)};
    if (std::abs(mode.omega_squared) <= negligible_square * largest_square) mode.omega_squared = 0.0;
    if (std::abs(mode.damping) <= negligible * most_damping) mode.damping = 0.0;
    if (modes.coupling == 0.0) add_roots(mode, roots);
    const bool rests = mode.omega_squared == 0.0 && mode.damping == 0.0;
    if (!(mode.omega_squared >= 0.0) || !(mode.damping >= 0.0) || rests) continue;
    modes.vibrations.push_back(mode);
    Vector& shape = modes.shapes.emplace_back(Vector::Zero(system.degrees_of_freedom()));
    for (Index k = 0; k < n; ++k) {
      const Index place = moving[static_cast<std::size_t>(k)];
      shape[place] = eigen.vectors(k, i) / std::sqrt(system.mass()[place]);
    }
  }
  if (modes.coupling == 0.0) {
    keep_eigenvalues(Eigen::Map<const Eigen::VectorXcd>(roots.data(), static_cast<Index>(roots.size())),
                     modes);
  } else {
    Matrix J = Matrix::Zero(2 * n, 2 * n);
    J.topRightCorner(n, n).setIdentity();
    J.bottomLeftCorner(n, n) = -modes.stiffness;
    J.bottomRightCorner(n, n) = -modes.damping;
    keep_eigenvalues(dense::eigenvalues(J), modes);
  }
  return modes;
}

/// The rows and columns of the moving degrees of freedom.
SparseMatrix reduced(const SparseMatrix& A, const std::vector<Index>& moving) {
  std::vector<int> place(static_cast<std::size_t>(A.rows()), -1);
  for (std::size_t k = 0; k < moving.size(); ++k)
    place[static_cast<std::size_t>(moving[k])] = static_cast<int>(k);
  std::vector<Eigen::Triplet<double, int>> entries;
  for (int j = 0; j < A.outerSize(); ++j) {
    for (SparseMatrix::InnerIterator entry(A, j); entry; ++entry) {
      const int row = place[static_cast<std::size_t>(entry.row())],
                column = place[static_cast<std::size_t>(j)];
      if (row >= 0 && column >= 0) entries.emplace_back(row, column, entry.value());
    }
  }
  const auto n = static_cast<Index>(moving.size());
  SparseMatrix result(n, n);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

LinearModes from_extreme(const linalg::ExtremeEigenvalues& found) {
  LinearModes modes;
  modes.is_complete = false;
  modes.status = found.status;
  if (found.values.empty()) return modes;
  modes.status = {};
  keep_eigenvalues(
      Eigen::Map<const Eigen::VectorXcd>(found.values.data(), static_cast<Index>(found.values.size())),
      modes);
  return modes;
}

constexpr int most_extreme_eigenvalues = 6;

LinearModes large_modes(const SecondOrderSystem& system, double t, ConstVectorRef y) {
  const std::vector<Index> moving = moving_indices(system);
  const Tangents tangents = tangents_of(system, t, y);
  const auto n = static_cast<Index>(moving.size());
  Vector mass(n);
  for (Index i = 0; i < n; ++i) mass[i] = system.mass()[moving[static_cast<std::size_t>(i)]];
  const SparseMatrix K = reduced(tangents.stiffness, moving);
  if (system.force_class() == ForceClass::position) {
    const SparseMatrix symmetric = -0.5 * (K + SparseMatrix(K.transpose()));
    const linalg::ExtremeEigenvalues found =
        linalg::extreme_eigenvalues_symmetric(symmetric, mass, {.end = linalg::SpectrumEnd::largest_real});
    LinearModes modes;
    modes.is_complete = false;
    modes.status = found.status;
    if (found.values.empty() || !(found.values.front().real() > 0.0)) return modes;
    const double square = found.values.front().real();
    modes.spectral_radius = std::sqrt(square);
    modes.eigenvalues = {{0.0, modes.spectral_radius}, {0.0, -modes.spectral_radius}};
    modes.vibrations = {{square, 0.0}};
    modes.is_undamped = true;
    return modes;
  }
  const SparseMatrix D = reduced(tangents.damping, moving);
  std::vector<Eigen::Triplet<double, int>> entries;
  const auto rows = static_cast<int>(n);
  for (int i = 0; i < rows; ++i) entries.emplace_back(i, rows + i, 1.0);
  for (int j = 0; j < rows; ++j) {
    for (SparseMatrix::InnerIterator entry(K, j); entry; ++entry)
      entries.emplace_back(rows + static_cast<int>(entry.row()), j, entry.value() / mass[entry.row()]);
    for (SparseMatrix::InnerIterator entry(D, j); entry; ++entry)
      entries.emplace_back(rows + static_cast<int>(entry.row()), rows + j, entry.value() / mass[entry.row()]);
  }
  SparseMatrix J(2 * rows, 2 * rows);
  J.setFromTriplets(entries.begin(), entries.end());
  LinearModes modes =
      from_extreme(linalg::extreme_eigenvalues(J, {.count = most_extreme_eigenvalues, .tolerance = 1e-8}));
  for (const Complex& lambda : modes.eigenvalues) {
    if (lambda.imag() > 0.0) {
      modes.vibrations.push_back({std::norm(lambda), -2.0 * lambda.real()});
    } else if (lambda.imag() == 0.0) {
      // Far more damped than its spring could undo: the partner of the root is near 0.
      modes.vibrations.push_back({0.0, -lambda.real()});
    }
  }
  modes.coupling = 1.0;
  return modes;
}

}  // namespace

LinearModes linear_modes(const OdeSystem& system, double t, ConstVectorRef y, Index largest_dense) {
  const SecondOrderSystem* second_order = system.second_order();
  const bool is_large = system.size() > largest_dense;
  if (second_order != nullptr)
    return is_large ? large_modes(*second_order, t, y) : dense_modes(*second_order, t, y);
  SparseMatrix J = system.jacobian_pattern();
  system.jacobian(t, y, J);
  if (is_large)
    return from_extreme(
        linalg::extreme_eigenvalues(J, {.count = most_extreme_eigenvalues, .tolerance = 1e-8}));
  LinearModes modes;
  keep_eigenvalues(dense::eigenvalues(Matrix(J)), modes);
  return modes;
}

LinearModes stiffest_modes(const SecondOrderSystem& system, double t, ConstVectorRef y) {
  const Index n = system.degrees_of_freedom();
  Vector inverse_root(n), scaled(n), product(n);
  for (Index i = 0; i < n; ++i) {
    inverse_root[i] = system.fixed()[static_cast<std::size_t>(i)] ? 0.0 : 1.0 / std::sqrt(system.mass()[i]);
  }
  const Vector zero = Vector::Zero(n);
  const auto stiffness = [&](ConstVectorRef x, VectorRef out) {
    scaled = inverse_root.cwiseProduct(x);
    system.tangent_product(t, y.head(n), y.tail(n), scaled, zero, product);
    out = -inverse_root.cwiseProduct(product);
  };
  const auto damping = [&](ConstVectorRef x, VectorRef out) {
    scaled = inverse_root.cwiseProduct(x);
    system.tangent_product(t, y.head(n), y.tail(n), zero, scaled, product);
    out = -inverse_root.cwiseProduct(product);
  };
  LinearModes modes;
  modes.is_complete = false;
  modes.is_rough = true;
  const linalg::EigenvalueOptions options{
      .end = linalg::SpectrumEnd::largest_real, .tolerance = 1e-2, .max_iterations = 20, .vectors = true};
  const auto add_mode = [&](const linalg::MatrixProduct& largest, const linalg::MatrixProduct& other,
                            bool is_damping) {
    const linalg::ExtremeEigenvalues found = linalg::extreme_eigenvalues_symmetric(n, largest, options);
    if (!found.status.ok()) modes.status = found.status;
    if (found.values.empty() || !(found.values.front().real() > 0.0)) return;
    Vector image(n);
    other(found.vectors.front(), image);
    const double quotient = std::max(0.0, found.vectors.front().dot(image));
    const double value = found.values.front().real();
    modes.vibrations.push_back(is_damping ? VibrationMode{quotient, value} : VibrationMode{value, quotient});
  };
  add_mode(stiffness, damping, false);
  if (system.force_class() == ForceClass::velocity) add_mode(damping, stiffness, true);
  std::vector<Complex> roots;
  for (const VibrationMode& mode : modes.vibrations) add_roots(mode, roots);
  keep_eigenvalues(Eigen::Map<const Eigen::VectorXcd>(roots.data(), static_cast<Index>(roots.size())), modes);
  return modes;
}

bool is_linear(const OdeSystem& system, double t, ConstVectorRef y) {
  SparseMatrix J = system.jacobian_pattern();
  system.jacobian(t, y, J);
  const Vector first = J.coeffs();
  const double largest = first.size() == 0 ? 0.0 : first.cwiseAbs().maxCoeff();
  constexpr std::uint64_t seed = 5;
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const double scale = 1.0 + y.cwiseAbs().maxCoeff();
  for (int sample = 0; sample < 3; ++sample) {
    Vector other = y;
    for (Index i = 0; i < other.size(); ++i) other[i] += 0.3 * scale * uniform(random);
    J.coeffs().setZero();
    system.jacobian(t + 0.37 * sample, other, J);
    if (!((Vector(J.coeffs()) - first).cwiseAbs().maxCoeff() <= 1e-10 * largest)) return false;
  }
  return true;
}

}  // namespace fw::analysis
