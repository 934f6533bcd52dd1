#include "catalog/equilibrium.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "dense/eigenvalues.hpp"
#include "linalg/extreme_eigenvalues.hpp"
#include "oracles/petsc/static_equilibrium.hpp"
#include "oracles/sundials/static_equilibrium.hpp"
#include "text/closest_name.hpp"

namespace fw::catalog {

namespace {

constexpr Index largest_dense_spectrum = 600;

Equilibrium attempt(const SecondOrderSystem& system, ConstVectorRef start, double time,
                    std::string_view solver, TangentModel tangent) {
  const auto outcome = [](auto found) {
    Equilibrium result;
    result.position = std::move(found.position);
    result.residual = found.residual;
    result.status = std::move(found.status);
    result.iterations = found.work.newton_iterations;
    result.force_evaluations = found.work.rhs_evaluations;
    return result;
  };
  if (solver == "snes") {
    return outcome(oracles::snes::find_static_equilibrium(system, start, time, {.tangent = tangent}));
  }
  return outcome(oracles::find_static_equilibrium(system, start, time, {.tangent = tangent}));
}

/// −M^{−1/2} K M^{−1/2} over the degrees of freedom that move.
SparseMatrix scaled_stiffness(const SecondOrderSystem& system, ConstVectorRef position, double time) {
  const Index n = system.degrees_of_freedom();
  SparseMatrix K = system.tangent_pattern();
  const Vector rest = Vector::Zero(n);
  system.stiffness(time, position, rest, TangentModel::exact, K);
  std::vector<Index> place(static_cast<std::size_t>(n), -1);
  Index moving = 0;
  for (Index i = 0; i < n; ++i) {
    if (!system.fixed()[static_cast<std::size_t>(i)]) place[static_cast<std::size_t>(i)] = moving++;
  }
  std::vector<Eigen::Triplet<double>> entries;
  for (Index column = 0; column < n; ++column) {
    const Index j = place[static_cast<std::size_t>(column)];
    if (j < 0) continue;
    for (SparseMatrix::InnerIterator entry(K, column); entry; ++entry) {
      const Index i = place[static_cast<std::size_t>(entry.row())];
      if (i < 0) continue;
      const double scale = std::sqrt(system.mass()[entry.row()] * system.mass()[column]);
      entries.emplace_back(static_cast<int>(i), static_cast<int>(j), -entry.value() / scale);
    }
  }
  SparseMatrix scaled(moving, moving);
  scaled.setFromTriplets(entries.begin(), entries.end());
  return scaled;
}

}  // namespace

const std::vector<EquilibriumSolver>& equilibrium_solvers() {
  static const std::vector<EquilibriumSolver> solvers = {
      {"kinsol", "SUNDIALS KINSOL, Newton's iteration with line search"},
      {"snes", "PETSc SNES, Newton's iteration with line search"}};
  return solvers;
}

Equilibrium find_equilibrium(const SecondOrderSystem& system, ConstVectorRef start, double time,
                             std::string_view solver) {
  std::vector<std::string> names;
  for (const EquilibriumSolver& known : equilibrium_solvers()) names.emplace_back(known.name);
  if (std::find(names.begin(), names.end(), solver) == names.end()) {
    throw InputError(fmt::format("solver: found \"{}\", expected \"kinsol\" or \"snes\"{}", solver,
                                 did_you_mean(std::string(solver), names)));
  }
  if (std::all_of(system.fixed().begin(), system.fixed().end(), [](char flag) { return flag != 0; })) {
    throw InputError("static equilibrium: no particle can move");
  }
  const Index n = system.degrees_of_freedom();
  Vector force(n);
  system.force(time, start, Vector::Zero(n), force);
  Equilibrium found;
  std::string failures;
  std::uint64_t iterations = 0, evaluations = 0;
  for (const auto& [tangent, name] :
       {std::pair{TangentModel::exact, "exact"}, std::pair{TangentModel::psd_projection, "psd_projection"}}) {
    found = attempt(system, start, time, solver, tangent);
    found.tangent = name;
    iterations += found.iterations;
    evaluations += found.force_evaluations;
    if (found.status.ok()) break;
    failures +=
        fmt::format("{}with the tangent \"{}\" {}", failures.empty() ? "" : "; ", name, found.status.message);
  }
  if (!found.status.ok()) found.status.message = failures;
  found.iterations = iterations;
  found.force_evaluations = evaluations;
  found.first_force = force.lpNorm<Eigen::Infinity>();
  return found;
}

Vector require_equilibrium(const SecondOrderSystem& system, ConstVectorRef start) {
  Equilibrium found = find_equilibrium(system, start);
  if (found.status.ok()) return std::move(found.position);
  throw InputError(fmt::format(
      "start = \"equilibrium\": none was found, largest force {:.3g} N: {}; expected a system that is held "
      "against its weight, or positions closer to rest",
      found.residual, found.status.message));
}

LowestMode lowest_mode(const SecondOrderSystem& system, ConstVectorRef position, double time) {
  const SparseMatrix scaled = scaled_stiffness(system, position, time);
  LowestMode mode;
  if (scaled.rows() <= largest_dense_spectrum) {
    const Vector values = dense::symmetric_eigenvalues(Matrix(scaled));
    mode.lambda = values[0];
    mode.largest = values[values.size() - 1];
    return mode;
  }
  for (const auto& [end, value] : {std::pair{linalg::SpectrumEnd::largest_real, &mode.largest},
                                   std::pair{linalg::SpectrumEnd::smallest_real, &mode.lambda}}) {
    const linalg::ExtremeEigenvalues found = linalg::extreme_eigenvalues_symmetric(
        scaled, linalg::EigenvalueOptions{.end = end, .tolerance = 1e-8});
    if (!found.status.ok()) mode.status = found.status;
    if (!found.values.empty()) *value = found.values.front().real();
  }
  return mode;
}

}  // namespace fw::catalog
