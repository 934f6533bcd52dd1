#include "study/linear_solver/linear_solver_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>

#include "core/special_values.hpp"
#include "linalg/linear_solver.hpp"
#include "study/linear_solver/step_spectrum.hpp"
#include "study/linear_solver/step_systems.hpp"
#include "system/heap_usage.hpp"

namespace fw::study {

namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double smallest(const std::vector<double>& values) {
  return values.empty() ? no_value : *std::min_element(values.begin(), values.end());
}

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (double value : values) sum += value;
  return values.empty() ? no_value : sum / static_cast<double>(values.size());
}

LinearSolverRow row_of(const SystemSpec& system, LinearSolverRow figures) {
  figures.problem = system.problem.label;
  figures.step = system.step;
  return figures;
}

/// How a system of a simulation is started.
enum class Start {
  cold,  ///< set-up anew, guess zero
  warm,  ///< set-up anew, guess from the system before
  kept,  ///< preconditioner of the first system, guess from the system before
};

/// One solver through the systems of one simulation.
class SequenceRun {
 public:
  SequenceRun(const linalg::LinearSolverOptions& options, Start start, Index size)
      : solver_(linalg::make_linear_solver(options)), start_(start), solution_(Vector::Zero(size)) {}

  Status solve(const StepSystems& systems) {
    if (start_ == Start::cold) solution_.setZero();
    const auto begin = std::chrono::steady_clock::now();
    const bool keeps = start_ == Start::kept && !seconds.empty();
    Status status = keeps ? solver_->replace_matrix(systems.matrix(), work_)
                          : solver_->factorise(systems.matrix(), work_);
    linalg::LinearSolve solve;
    if (status.ok()) {
      solve = solver_->solve(systems.right_hand_side(), solution_, work_);
      status = solve.status;
    }
    seconds.push_back(seconds_since(begin));
    iterations.push_back(static_cast<std::int64_t>(solve.iterations));
    residuals.push_back(solve.relative_residual);
    return status;
  }

  double mean_iterations() const { return mean(std::vector<double>(iterations.begin(), iterations.end())); }

  std::vector<double> seconds, residuals;
  std::vector<std::int64_t> iterations;

 private:
  std::unique_ptr<linalg::LinearSolver> solver_;
  Start start_;
  Vector solution_;
  Work work_;
};

class SolverCase {
 public:
  SolverCase(const SystemSpec& system, std::string call, const LinearSolverSettings& settings,
             const RunContext& context)
      : system_(system),
        settings_(settings),
        context_(context),
        systems_(system.problem.problem.ivp, system.step) {
    options_ = linalg::read_linear_solver(call);
    options_.relative_tolerance = settings.tolerance;
    const SecondOrderSystem& mechanics = *system.problem.problem.ivp.system->second_order();
    if (mechanics.has_springs()) options_.coordinates = systems_.positions();
    figures_.solver = std::move(call);
    figures_.unknowns = systems_.right_hand_side().size();
  }

  CaseResult run() {
    Status status = follow_simulation();
    if (status.ok()) status = measure();
    std::string reason = !status.ok() ? status.describe()
                         : most_iterations_ == 0
                             ? fmt::format("true residual at most {:.1e}", largest_residual_)
                             : fmt::format("true residual at most {:.1e}, at most {} iterations",
                                           largest_residual_, most_iterations_);
    return case_result(status.ok() ? Verdict::holds : Verdict::fails, std::move(reason), columns(),
                       row_of(system_, figures_));
  }

 private:
  bool is_iterative() const { return linalg::find_linear_solver(options_.kind).is_iterative; }

  /// The systems of a simulation, which a direct solver takes along for all to see the same state.
  Status follow_simulation() {
    const Index n = systems_.right_hand_side().size();
    runs_.emplace_back(options_, Start::cold, n);
    if (is_iterative()) {
      runs_.emplace_back(options_, Start::warm, n);
      runs_.emplace_back(options_, Start::kept, n);
    }
    for (std::int64_t k = 0; k < settings_.sequence; ++k) {
      context_.check();
      for (SequenceRun& run : runs_) {
        Status status = run.solve(systems_);
        if (status.ok()) status = check(run.residuals.back());
        if (!status.ok()) {
          status.message = fmt::format("system {} of the simulation: {}", k, status.message);
          return status;
        }
        most_iterations_ = std::max(most_iterations_, run.iterations.back());
      }
      if (Status status = systems_.advance(); !status.ok()) return status;
    }
    if (is_iterative() && most_iterations_ > 0) {
      figures_.iterations_warm = runs_[1].mean_iterations();
      figures_.iterations_kept = runs_[2].mean_iterations();
    }
    return {};
  }

  Status check(double residual) {
    largest_residual_ = std::max(largest_residual_, residual);
    const double allowed = 10.0 * settings_.tolerance;
    if (residual <= allowed) return {};
    return {StatusCode::linear_solver_failed,
            fmt::format("true residual {:.2e}, expected at most {:.2e}", residual, allowed)};
  }

  /// The last system, a few times over.
  Status measure() {
    const Index n = systems_.right_hand_side().size();
    const SparseMatrix A = systems_.matrix();
    const Vector b = systems_.right_hand_side();
    Vector x(n);
    for (std::int64_t k = 0; k < settings_.repetitions; ++k) {
      context_.check();
      auto begin = std::chrono::steady_clock::now();
      systems_.assemble();
      assembly_.push_back(seconds_since(begin));

      const std::size_t heap_before = heap_usage();
      Work work;
      begin = std::chrono::steady_clock::now();
      const auto solver = linalg::make_linear_solver(options_);
      if (Status status = solver->factorise(A, work); !status.ok()) return status;
      first_setup_.push_back(seconds_since(begin));
      begin = std::chrono::steady_clock::now();
      if (Status status = solver->factorise(A, work); !status.ok()) return status;
      setup_.push_back(seconds_since(begin));
      x.setZero();
      begin = std::chrono::steady_clock::now();
      const linalg::LinearSolve solve = solver->solve(b, x, work);
      solve_.push_back(seconds_since(begin));
      if (!solve.status.ok()) return solve.status;
      if (Status status = check(solve.relative_residual); !status.ok()) return status;
      const std::size_t heap_after = heap_usage();
      figures_.memory = heap_after > heap_before ? static_cast<double>(heap_after - heap_before) : no_value;
      figures_.residual = solve.relative_residual;
      figures_.iterations =
          is_iterative() && solve.iterations > 0 ? static_cast<double>(solve.iterations) : no_value;
      most_iterations_ = std::max(most_iterations_, static_cast<std::int64_t>(solve.iterations));
    }
    figures_.assembly = smallest(assembly_);
    figures_.first_setup = smallest(first_setup_);
    figures_.setup = smallest(setup_);
    figures_.solve = smallest(solve_);
    Vector direct;
    if (linalg::LinearSolve solve = systems_.solve_directly(direct); !solve.status.ok()) return solve.status;
    figures_.difference = (x - direct).norm() / direct.norm();
    return {};
  }

  std::vector<Column> columns() const {
    std::vector<Column> columns = {{"assembly_seconds", "s", assembly_, {}, {}},
                                   {"first_setup_seconds", "s", first_setup_, {}, {}},
                                   {"setup_seconds", "s", setup_, {}, {}},
                                   {"solve_seconds", "s", solve_, {}, {}}};
    const char* names[] = {"cold", "warm", "kept"};
    for (std::size_t k = 0; k < runs_.size(); ++k) {
      const std::string name = names[k];
      columns.push_back({"sequence_iterations_" + name, "1", runs_[k].iterations, {}, {}});
      columns.push_back({"sequence_seconds_" + name, "s", runs_[k].seconds, {}, {}});
      columns.push_back({"sequence_residual_" + name, "1", runs_[k].residuals, {}, {}});
    }
    return columns;
  }

  const SystemSpec& system_;
  const LinearSolverSettings& settings_;
  const RunContext& context_;
  StepSystems systems_;
  linalg::LinearSolverOptions options_;
  LinearSolverRow figures_;
  std::vector<SequenceRun> runs_;
  std::vector<double> assembly_, first_setup_, setup_, solve_;
  double largest_residual_ = 0.0;
  std::int64_t most_iterations_ = 0;
};

}  // namespace

void declare(settings::Archive& a, LinearSolverSettings& s) {
  using settings::setting;
  a(setting("steps", s.steps).unit("s").required().not_empty().positive().selects_cases().doc("h"));
  a(setting("tolerance", s.tolerance)
        .unit("1")
        .positive()
        .doc("relative residual ‖b − A x‖/‖b‖ asked of iterative solvers"));
  a(setting("repetitions", s.repetitions).integers(1, 1000).quick_at_most(2).doc("of each timing"));
  a(setting("sequence", s.sequence).integers(0, 100'000).quick_at_most(5).doc("systems of one simulation"));
  a(setting("largest_spectrum", s.largest_spectrum)
        .integers(0, 5000)
        .selects_cases()
        .doc("unknowns up to which all eigenvalues are computed"));
}

void declare(SummaryRow& a, const LinearSolverRow& row) {
  a("problem", "", row.problem, "its label");
  a("step", "s", row.step, "h of the implicit step");
  a("solver", "", row.solver, "as in the study; `spectrum`");
  a("unknowns", "1", row.unknowns, "n");
  a("assembly_seconds", "s", row.assembly,
    "the smallest of the repetitions, like all seconds here; NaN of spectra");
  a("first_setup_seconds", "s", row.first_setup, "");
  a("setup_seconds", "s", row.setup, "");
  a("solve_seconds", "s", row.solve, "");
  a("iterations", "1", row.iterations,
    "of the timed system; NaN of direct solvers, PETSc's `preonly` among them");
  a("iterations_warm", "1", row.iterations_warm, "mean over the simulation; NaN of direct solvers");
  a("iterations_kept", "1", row.iterations_kept, "likewise");
  a("memory", "B", row.memory, "heap that the solver holds after a solve; NaN where the heap has shrunk");
  a("residual", "1", row.residual, "true relative residual of the timed solve");
  a("difference", "1", row.difference, "‖x − x_direct‖₂/‖x_direct‖₂ with CHOLMOD's solution");
  a("smallest_eigenvalue", "kg", row.smallest_eigenvalue, "of spectra, else NaN, like all that follows");
  a("largest_eigenvalue", "kg", row.largest_eigenvalue, "");
  a("condition", "1", row.condition, "of A");
  a("condition_block_jacobi", "1", row.condition_block_jacobi, "with the preconditioner");
}

CaseResult run_solver(const SystemSpec& system, const std::string& call, const LinearSolverSettings& settings,
                      const RunContext& context) {
  return SolverCase(system, call, settings, context).run();
}

CaseResult run_spectrum(const SystemSpec& system, const LinearSolverSettings& settings) {
  const StepSystems systems(system.problem.problem.ivp, system.step);
  const StepSpectrum spectrum = spectrum_of(systems.matrix());
  const Index n = spectrum.eigenvalues.size();
  LinearSolverRow figures{.solver = "spectrum", .unknowns = n};
  figures.smallest_eigenvalue = spectrum.eigenvalues[0];
  figures.largest_eigenvalue = spectrum.eigenvalues[n - 1];
  figures.condition = spectrum.condition();
  figures.condition_block_jacobi = spectrum.condition_block_jacobi();

  const auto column = [n](const Vector& values) {
    return std::vector<double>(values.data(), values.data() + n);
  };
  std::vector<Column> columns = {
      {"eigenvalue", "kg", column(spectrum.eigenvalues), {}, {}},
      {"eigenvalue_block_jacobi", "1", column(spectrum.eigenvalues_block_jacobi), {}, {}}};
  Work work;
  const auto solver = linalg::make_linear_solver({.relative_tolerance = settings.tolerance});
  Status status = solver->factorise(systems.matrix(), work);
  linalg::LinearSolve solve;
  if (status.ok()) {
    Vector x = Vector::Zero(n);
    solve = solver->solve(systems.right_hand_side(), x, work);
    status = solve.status;
  }
  figures.iterations = static_cast<double>(solve.iterations);
  figures.residual = solve.relative_residual;
  const double bound = spectrum.iteration_bound(settings.tolerance);
  const bool holds = status.ok() && spectrum.eigenvalues[0] > 0.0 && figures.iterations <= bound;
  std::string reason = status.ok()
                           ? fmt::format(
                                 "condition {:.3g}, {:.3g} with block Jacobi: at most {:.0f} iterations of "
                                 "conjugate gradients, {} taken",
                                 figures.condition, figures.condition_block_jacobi, bound, solve.iterations)
                           : status.describe();
  return case_result(holds ? Verdict::holds : Verdict::fails, std::move(reason), std::move(columns),
                     row_of(system, figures));
}

}  // namespace fw::study
