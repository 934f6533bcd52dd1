#include "study/linear_solver/linear_solver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "core/error.hpp"
#include "linalg/linear_solver.hpp"
#include "settings/identity_text.hpp"
#include "study/linear_solver/linear_solver_case.hpp"
#include "system/worker_process.hpp"

namespace fw::study {

namespace {

using settings::Archive;
using settings::setting;

struct Spec {
  std::vector<std::string> solvers;
  LinearSolverSettings settings;
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
  const auto unknowns = [](const StudyProblem& entry) -> std::int64_t {
    return entry.problem.ivp.system->second_order()->degrees_of_freedom();
  };
  std::int64_t smallest = std::numeric_limits<std::int64_t>::max();
  for (const StudyProblem& entry : problems) smallest = std::min(smallest, unknowns(entry));
  std::erase_if(problems, [&](const StudyProblem& entry) { return unknowns(entry) > largest; });
  if (problems.empty()) {
    input.section("quick").fail(
        "largest_problem", fmt::format("found {}, expected at least {}, the unknowns of the smallest problem",
                                       largest, smallest));
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

/// What is wrong with the options of a solver, or nothing. PETSc knows which ones it did not use only when
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
  const LinearSolverSettings& settings = spec.settings;
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
             .run = [system, settings](const RunContext&) { return run_spectrum(*system, settings); },
             .known = {{"problem", entry.label}, {"step", step}, {"solver", "spectrum"}}});
      }
      for (const std::string& call : solvers) {
        plan.cases.push_back(
            {.id = group_name(name + "-" + call),
             .identity = identity + "solver = " + call + "\n",
             .run = [system, call, settings](
                        const RunContext& context) { return run_solver(*system, call, settings, context); },
             .is_timed = true,
             .known = {{"problem", entry.label}, {"step", step}, {"solver", call}}});
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
       .summary = columns_of<LinearSolverRow>(),
       .verdict_meaning =
           "`holds`: every true residual is at most ten times the tolerance; of spectra: A is positive "
           "definite and conjugate gradients take no more iterations than the condition allows",
       .reason_meaning = ""},
      plan_linear_solvers);
}

}  // namespace fw::study
