#include "study/linear_solver/linear_solver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>

#include "core/error.hpp"
#include "linalg/linear_solver.hpp"
#include "settings/identity_text.hpp"
#include "study/linear_solver/step_spectrum.hpp"
#include "study/linear_solver/step_systems.hpp"
#include "study/problem_spec.hpp"
#include "system/heap_usage.hpp"
#include "system/worker_process.hpp"

namespace fw::study {

namespace {

using settings::Archive;
using settings::setting;

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// The keys of [linear_solver].
struct Settings {
  std::vector<double> steps;
  double tolerance = 1e-8;
  std::int64_t repetitions = 5;
  std::int64_t sequence = 60;
  std::int64_t largest_spectrum = 1000;
};

void declare(Archive& a, Settings& s) {
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

struct Spec {
  std::vector<std::string> solvers;
  Settings settings;
  std::vector<ProblemSpec> problems;
  std::int64_t quick_largest_problem = 2000;
};

void declare(Archive& a, Spec& spec) {
  a(setting("solvers", spec.solvers)
        .required()
        .not_empty()
        .doc("`cg`, `cholesky`, `ldlt`, `lu`, `eigen_cg`, `eigen_lu`, `cholmod`, or `petsc` with options in "
             "PETSc's notation: `\"petsc -ksp_type cg -pc_type icc -mat_type sbaij\"`"));
  a.section({.name = "linear_solver", .doc = "The systems and how they are solved.", .is_required = true},
            spec.settings);
  a.sections(problem_sections, spec.problems);
  a.quick_section([&] {
    a(setting("largest_problem", spec.quick_largest_problem)
          .at_least(1)
          .doc("unknowns; larger problems are left out"));
  });
}

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
  std::string problem{};
  double step = none;
};

void declare(SummaryRow& a, const Figures& row) {
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

void add_summary(const SystemSpec& system, Figures figures, CaseResult& result) {
  figures.problem = system.problem.label;
  figures.step = system.step;
  result.summary = cells_of(figures);
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

/// With --quick, problems of more unknowns than [quick] largest_problem are left out.
std::vector<StudyProblem> step_problems(const Spec& spec, const StudyInput& input,
                                        std::vector<std::string>& warnings) {
  std::vector<StudyProblem> problems = make_problems(spec.problems, input, warnings);
  for (const StudyProblem& entry : problems) {
    if (entry.problem.ivp.system->second_order() == nullptr) {
      throw InputError(fmt::format("{}: problem \"{}\" is y' = f(t, y), expected M q'' = f(t, q, q')",
                                   input.file.source_name(), entry.label));
    }
  }
  if (!input.is_quick) return problems;
  const std::int64_t largest = spec.quick_largest_problem;
  std::erase_if(problems, [largest](const StudyProblem& entry) {
    return entry.problem.ivp.system->second_order()->degrees_of_freedom() > largest;
  });
  if (problems.empty()) {
    input.section("quick").fail("largest_problem", fmt::format("found {}, which leaves no problem", largest));
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

void check_solvers(const std::vector<std::string>& solvers, const CheckedTable& spec) {
  for (std::size_t i = 0; i < solvers.size(); ++i) {
    std::string message;
    try {
      message = probe(solvers[i]);
    } catch (const InputError& error) {
      message = error.what();
    }
    if (!message.empty()) spec.fail("solvers", {i}, message);
  }
}

void plan_linear_solvers(const Spec& spec, const StudyInput& input, Plan& plan) {
  const Settings& settings = spec.settings;
  const std::vector<std::string>& solvers = spec.solvers;
  check_solvers(solvers, input.file);
  for (StudyProblem& entry : step_problems(spec, input, plan.warnings)) {
    for (double step : settings.steps) {
      const auto system = std::make_shared<const SystemSpec>(SystemSpec{entry, step});
      const std::string name = fmt::format("{}-h{}", entry.label, step);
      const std::string identity = fmt::format("linear_solver\n{}step = {}\n{}", entry.identity, step,
                                               settings::identity_text(settings));
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
  return declared_kind<Spec>(
      {.name = "linear_solver",
       .title = "Linear solvers on the systems of implicit steps",
       .description =
           "assembly, set-up, solve, iterations, memory and true residual of every solver over size, "
           "stiffness and step; warm start and kept preconditioners; spectrum",
       .summary = columns_of<Figures>(),
       .verdict_meaning =
           "`holds`: every true residual is at most ten times the tolerance; of spectra: A is positive "
           "definite and conjugate gradients take no more iterations than the condition allows",
       .reason_meaning = ""},
      plan_linear_solvers);
}

}  // namespace fw::study
