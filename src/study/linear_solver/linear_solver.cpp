#include "study/linear_solver/linear_solver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>

#include "core/error.hpp"
#include "linalg/linear_solver.hpp"
#include "study/linear_solver/step_spectrum.hpp"
#include "study/linear_solver/step_systems.hpp"
#include "study/problem_spec.hpp"
#include "system/heap_usage.hpp"
#include "system/worker_process.hpp"

namespace fw::study {

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// The keys of [linear_solver].
struct Settings {
  std::vector<double> steps;             ///< h [s]
  double tolerance = 1e-8;               ///< ‖b − A x‖/‖b‖ asked of iterative solvers
  std::int64_t repetitions = 5;          ///< of each timing
  std::int64_t sequence = 60;            ///< systems of one simulation
  std::int64_t largest_spectrum = 1000;  ///< unknowns up to which all eigenvalues are computed

  std::string text() const {
    return fmt::format("tolerance = {}\nrepetitions = {}\nsequence = {}\n", tolerance, repetitions, sequence);
  }
};

/// A system, which all solvers share.
struct SystemSpec {
  StudyProblem problem;
  double step = 0.0;
};

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double smallest(const std::vector<double>& values) {
  return values.empty() ? none : *std::min_element(values.begin(), values.end());
}

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (double value : values) sum += value;
  return values.empty() ? none : sum / static_cast<double>(values.size());
}

/// What is known of a case for its row of the summary; NaN where it does not apply.
struct Figures {
  std::string solver;
  std::int64_t unknowns = 0;
  double assembly = none, first_setup = none, setup = none, solve = none, memory = none, residual = none;
  double iterations = none, iterations_warm = none, iterations_kept = none, difference = none;
  double smallest_eigenvalue = none, largest_eigenvalue = none, condition = none,
         condition_block_jacobi = none;
};

void add_summary(const SystemSpec& system, const Figures& figures, CaseResult& result) {
  result.summary = {{"problem", "", system.problem.label},
                    {"step", "s", system.step},
                    {"solver", "", figures.solver},
                    {"unknowns", "1", figures.unknowns},
                    {"assembly_seconds", "s", figures.assembly},
                    {"first_setup_seconds", "s", figures.first_setup},
                    {"setup_seconds", "s", figures.setup},
                    {"solve_seconds", "s", figures.solve},
                    {"iterations", "1", figures.iterations},
                    {"iterations_warm", "1", figures.iterations_warm},
                    {"iterations_kept", "1", figures.iterations_kept},
                    {"memory", "B", figures.memory},
                    {"residual", "1", figures.residual},
                    {"difference", "1", figures.difference},
                    {"smallest_eigenvalue", "kg", figures.smallest_eigenvalue},
                    {"largest_eigenvalue", "kg", figures.largest_eigenvalue},
                    {"condition", "1", figures.condition},
                    {"condition_block_jacobi", "1", figures.condition_block_jacobi},
                    {"verdict", "", std::string(to_string(result.verdict))},
                    {"reason", "", result.reason}};
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
  SolverCase(const SystemSpec& system, std::string call, const Settings& settings, const RunContext& context)
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
    CaseResult result;
    result.verdict = status.ok() ? Verdict::holds : Verdict::fails;
    result.reason = !status.ok() ? status.describe()
                    : most_iterations_ == 0
                        ? fmt::format("true residual at most {:.1e}", largest_residual_)
                        : fmt::format("true residual at most {:.1e}, at most {} iterations",
                                      largest_residual_, most_iterations_);
    add_columns(result);
    add_summary(system_, figures_, result);
    return result;
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
      figures_.memory = heap_after > heap_before ? static_cast<double>(heap_after - heap_before) : none;
      figures_.residual = solve.relative_residual;
      figures_.iterations =
          is_iterative() && solve.iterations > 0 ? static_cast<double>(solve.iterations) : none;
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

  void add_columns(CaseResult& result) const {
    result.columns = {{"assembly_seconds", "s", assembly_, {}, {}},
                      {"first_setup_seconds", "s", first_setup_, {}, {}},
                      {"setup_seconds", "s", setup_, {}, {}},
                      {"solve_seconds", "s", solve_, {}, {}}};
    const char* names[] = {"cold", "warm", "kept"};
    for (std::size_t k = 0; k < runs_.size(); ++k) {
      const std::string name = names[k];
      result.columns.push_back({"sequence_iterations_" + name, "1", runs_[k].iterations, {}, {}});
      result.columns.push_back({"sequence_seconds_" + name, "s", runs_[k].seconds, {}, {}});
      result.columns.push_back({"sequence_residual_" + name, "1", runs_[k].residuals, {}, {}});
    }
  }

  const SystemSpec& system_;
  const Settings& settings_;
  const RunContext& context_;
  StepSystems systems_;
  linalg::LinearSolverOptions options_;
  Figures figures_;
  std::vector<SequenceRun> runs_;
  std::vector<double> assembly_, first_setup_, setup_, solve_;
  double largest_residual_ = 0.0;
  std::int64_t most_iterations_ = 0;
};

/// All eigenvalues of the first system of a simulation, and what they promise conjugate gradients.
CaseResult run_spectrum(const SystemSpec& system, const Settings& settings) {
  const StepSystems systems(system.problem.problem.ivp, system.step);
  const StepSpectrum spectrum = spectrum_of(systems.matrix());
  const Index n = spectrum.eigenvalues.size();
  Figures figures{.solver = "spectrum", .unknowns = n};
  figures.smallest_eigenvalue = spectrum.eigenvalues[0];
  figures.largest_eigenvalue = spectrum.eigenvalues[n - 1];
  figures.condition = spectrum.condition();
  figures.condition_block_jacobi = spectrum.condition_block_jacobi();

  CaseResult result;
  const auto column = [n](const Vector& values) {
    return std::vector<double>(values.data(), values.data() + n);
  };
  result.columns = {{"eigenvalue", "kg", column(spectrum.eigenvalues), {}, {}},
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
  result.verdict = holds ? Verdict::holds : Verdict::fails;
  result.reason = status.ok()
                      ? fmt::format(
                            "condition {:.3g}, {:.3g} with block Jacobi: at most {:.0f} iterations of "
                            "conjugate gradients, {} taken",
                            figures.condition, figures.condition_block_jacobi, bound, solve.iterations)
                      : status.describe();
  add_summary(system, figures, result);
  return result;
}

Settings read_settings(const CheckedTable& spec, bool quick) {
  Settings settings;
  const CheckedTable table = spec.table("linear_solver");
  settings.steps = table.numbers("steps", NumberRule::positive);
  if (settings.steps.empty()) table.fail("steps", "found an empty list, expected at least one step");
  settings.tolerance = table.number_or("tolerance", settings.tolerance, NumberRule::positive);
  settings.repetitions = table.integer_or("repetitions", settings.repetitions, 1, 1000);
  settings.sequence = table.integer_or("sequence", settings.sequence, 0, 100'000);
  settings.largest_spectrum = table.integer_or("largest_spectrum", settings.largest_spectrum, 0, 5000);
  const CheckedTable shrunk = spec.table_or_empty("quick");
  const std::int64_t quick_repetitions =
      shrunk.integer_or("repetitions", std::min<std::int64_t>(settings.repetitions, 2), 1, 1000);
  const std::int64_t quick_sequence =
      shrunk.integer_or("sequence", std::min<std::int64_t>(settings.sequence, 5), 0, 100'000);
  if (quick) {
    settings.repetitions = quick_repetitions;
    settings.sequence = quick_sequence;
  }
  return settings;
}

/// With --quick, problems of more unknowns than [quick] largest_problem are left out.
std::vector<StudyProblem> read_step_problems(const CheckedTable& spec, const Catalog& catalog, bool quick,
                                             std::vector<std::string>& warnings) {
  std::vector<StudyProblem> problems = read_problems(spec, catalog, warnings);
  for (const StudyProblem& entry : problems) {
    if (entry.problem.ivp.system->second_order() == nullptr) {
      throw InputError(fmt::format("{}: problem \"{}\" is y' = f(t, y), expected M q'' = f(t, q, q')",
                                   spec.source_name(), entry.label));
    }
  }
  const CheckedTable shrunk = spec.table_or_empty("quick");
  const std::int64_t largest = shrunk.integer_or("largest_problem", 2000, 1);
  if (quick) {
    std::erase_if(problems, [largest](const StudyProblem& entry) {
      return entry.problem.ivp.system->second_order()->degrees_of_freedom() > largest;
    });
    if (problems.empty()) {
      shrunk.fail("largest_problem", fmt::format("found {}, which leaves no problem", largest));
    }
  }
  return problems;
}

/// Solves a small system. How that ends does not matter.
void solve_small_system(const linalg::LinearSolverOptions& options) {
  const Index n = 12;
  SparseMatrix A(n, n);
  for (Index i = 0; i < n; ++i) {
    A.insert(i, i) = 4.0;
    if (i > 0) A.insert(i - 1, i) = -1.0;
    if (i + 1 < n) A.insert(i + 1, i) = -1.0;
  }
  A.makeCompressed();
  Work work;
  const auto solver = linalg::make_linear_solver(options);
  Vector x = Vector::Zero(n);
  if (solver->factorise(A, work).ok()) solver->solve(Vector::Ones(n), x, work);
}

/// What is wrong with the options of a solver, or nothing. PETSc knows which ones nobody asks for only when
/// they were used, so they are, in a process of its own (see `linalg::petsc_is_running`).
std::string probe(const std::string& call) {
  const linalg::LinearSolverOptions options = linalg::read_linear_solver(call);
  if (options.petsc_options.empty()) return "";
  return answer_of_a_process([&]() -> std::string {
    try {
      solve_small_system(options);
      return "";
    } catch (const std::exception& error) {
      return error.what();
    }
  });
}

std::vector<std::string> read_solvers(const CheckedTable& spec) {
  std::vector<std::string> solvers = spec.strings("solvers");
  if (solvers.empty()) spec.fail("solvers", "found an empty list, expected at least one solver");
  for (std::size_t i = 0; i < solvers.size(); ++i) {
    std::string message;
    try {
      message = probe(solvers[i]);
    } catch (const InputError& error) {
      message = error.what();
    }
    if (!message.empty()) spec.fail("solvers", {i}, message);
  }
  return solvers;
}

void read_linear_solver_study(const CheckedTable& spec, const Catalog& catalog, bool quick, Plan& plan) {
  const Settings settings = read_settings(spec, quick);
  const std::vector<std::string> solvers = read_solvers(spec);
  for (StudyProblem& entry : read_step_problems(spec, catalog, quick, plan.warnings)) {
    for (double step : settings.steps) {
      const auto system = std::make_shared<const SystemSpec>(SystemSpec{entry, step});
      const std::string name = fmt::format("{}-h{}", entry.label, step);
      const std::string identity =
          fmt::format("linear_solver\n{}step = {}\n{}", entry.identity, step, settings.text());
      if (entry.problem.ivp.system->second_order()->degrees_of_freedom() <= settings.largest_spectrum) {
        plan.cases.push_back(
            {.id = group_name(name + "-spectrum"),
             .identity = identity + "spectrum\n",
             .run = [system, settings](const RunContext&) { return run_spectrum(*system, settings); }});
      }
      for (const std::string& call : solvers) {
        plan.cases.push_back({.id = group_name(name + "-" + call),
                              .identity = identity + "solver = " + call + "\n",
                              .run =
                                  [system, call, settings](const RunContext& context) {
                                    return SolverCase(*system, call, settings, context).run();
                                  },
                              .is_timed = true});
      }
    }
  }
}

}  // namespace

StudyKind linear_solver_kind() {
  return {.name = "linear_solver",
          .title = "Linear solvers on the systems of implicit steps",
          .description =
              "assembly, set-up, solve, iterations, memory and true residual of every solver over size, "
              "stiffness and step; warm start and kept preconditioners; spectrum",
          .read = read_linear_solver_study};
}

}  // namespace fw::study
