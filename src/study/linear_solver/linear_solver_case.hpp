#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "core/special_values.hpp"
#include "study/problem_spec.hpp"

namespace fw::study {

/// The keys of [linear_solver].
struct LinearSolverSettings {
  std::vector<double> steps;
  double tolerance = 1e-8;
  std::int64_t repetitions = 5;
  std::int64_t sequence = 60;
  std::int64_t largest_spectrum = 1000;
};
void declare(settings::Archive& a, LinearSolverSettings& s);

/// A system, which all solvers share.
struct SystemSpec {
  StudyProblem problem;
  double step = 0.0;
};

/// What is known of a case for its row of the summary; NaN where it does not apply.
struct LinearSolverRow {
  std::string solver;
  std::int64_t unknowns = 0;
  double assembly = no_value, first_setup = no_value, setup = no_value, solve = no_value, memory = no_value,
         residual = no_value;
  double iterations = no_value, iterations_warm = no_value, iterations_kept = no_value, difference = no_value;
  double smallest_eigenvalue = no_value, largest_eigenvalue = no_value, condition = no_value,
         condition_block_jacobi = no_value;
  std::string problem{};
  double step = no_value;
};
void declare(SummaryRow& a, const LinearSolverRow& row);

/// One solver through the systems of one simulation, and timed on the last of them. Verdict: every true
/// residual is at most ten times the tolerance.
CaseResult run_solver(const SystemSpec& system, const std::string& call, const LinearSolverSettings& settings,
                      const RunContext& context);

/// All eigenvalues of the first system of a simulation, and what they promise conjugate gradients. Verdict:
/// the matrix is positive definite, and conjugate gradients take no more iterations than promised.
CaseResult run_spectrum(const SystemSpec& system, const LinearSolverSettings& settings);

}  // namespace fw::study
