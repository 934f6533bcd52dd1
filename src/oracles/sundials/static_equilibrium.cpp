#include "oracles/sundials/static_equilibrium.hpp"

#include <fmt/format.h>
#include <kinsol/kinsol.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <memory>
#include <string>

#include "core/error.hpp"
#include "core/run_clock.hpp"
#include "oracles/sundials/callback_guard.hpp"
#include "oracles/sundials/eigen_vector.hpp"
#include "oracles/sundials/sparse_direct_solver.hpp"

namespace fw::oracles {

namespace {

using namespace detail;

struct KinsolDeleter {
  void operator()(void* memory) const { KINFree(&memory); }
};

/// What KINSOL's callbacks need; one per search.
struct Search {
  const SecondOrderSystem& system;
  double time;
  const EquilibriumOptions& options;
  double extent;  ///< ℓ
  Work work{};
  CallbackGuard guard{};
  std::string message{};
  SparseMatrix matrix = system.tangent_pattern();
  SparseDirectSolver* klu = nullptr;                        ///< set before the search starts
  Vector rest = Vector::Zero(system.degrees_of_freedom());  ///< v = 0

  Index size() const { return rest.size(); }
  bool is_fixed(Index i) const { return system.fixed()[static_cast<std::size_t>(i)] != 0; }

  void force(ConstVectorRef x, VectorRef f) {
    system.force(time, x, rest, f);
    ++work.rhs_evaluations;
  }

  /// matrix = −K + μ I, fixed rows those of the identity.
  void assemble(ConstVectorRef x, double largest_force) {
    system.stiffness(time, x, rest, options.tangent, matrix);
    ++work.jacobian_evaluations;
    const double shift = options.regularisation * largest_force / extent;
    for (Index j = 0; j < size(); ++j) {
      for (SparseMatrix::InnerIterator entry(matrix, j); entry; ++entry) {
        const bool is_diagonal = entry.row() == j;
        if (is_fixed(entry.row())) {
          entry.valueRef() = is_diagonal ? 1.0 : 0.0;
        } else {
          entry.valueRef() = -entry.value() + (is_diagonal ? shift : 0.0);
        }
      }
    }
  }
};

int residual(N_Vector x, N_Vector out, void* user_data) {
  auto& search = *static_cast<Search*>(user_data);
  return search.guard.call([&] {
    // −f, whose derivative −K is positive definite where the equilibrium is stable.
    VectorMap value = mutable_view(out, search.size());
    search.force(view(x, search.size()), value);
    value = -value;
    return value.allFinite() ? 0 : 1;
  });
}

int jacobian(N_Vector x, N_Vector f, SUNMatrix J, void* user_data, N_Vector, N_Vector) {
  auto& search = *static_cast<Search*>(user_data);
  return search.guard.call([&] {
    search.assemble(view(x, search.size()), N_VMaxNorm(f));
    search.klu->copy(search.matrix, J);
    return search.matrix.coeffs().allFinite() ? 0 : 1;
  });
}

void keep_message(int error_code, const char*, const char*, char* text, void* user_data) {
  auto& search = *static_cast<Search*>(user_data);
  if (error_code > 0) return;  // a warning
  search.guard.call([&] {
    search.message = text;
    return 0;
  });
}

std::string name_of_flag(int flag) {
  char* allocated = KINGetReturnFlagName(flag);
  const std::string name = allocated;
  std::free(allocated);
  // The failures of the system function have no name in KINSOL's list.
  return name == "NONE" ? fmt::format("flag {}", flag) : name;
}

StatusCode code_of_flag(int flag) {
  switch (flag) {
    case KIN_LSETUP_FAIL:
      return StatusCode::matrix_singular;
    case KIN_LSOLVE_FAIL:
    case KIN_LINSOLV_NO_RECOVERY:
      return StatusCode::linear_solver_failed;
    case KIN_SYSFUNC_FAIL:
    case KIN_FIRST_SYSFUNC_ERR:
    case KIN_REPTD_SYSFUNC_ERR:
      return StatusCode::non_finite;
    case KIN_STEP_LT_STPTOL:
    case KIN_LINESEARCH_NONCONV:
    case KIN_LINESEARCH_BCFAIL:
    case KIN_MAXITER_REACHED:
    case KIN_MXNEWT_5X_EXCEEDED:
      return StatusCode::newton_failed;
    default:
      return StatusCode::library_failure;
  }
}

void check(const SecondOrderSystem& system, ConstVectorRef start, const EquilibriumOptions& options) {
  if (start.size() != system.degrees_of_freedom()) {
    throw InputError(fmt::format("equilibrium: found {} start positions, expected {}", start.size(),
                                 system.degrees_of_freedom()));
  }
  if (!start.allFinite()) throw InputError("equilibrium: found a start position that is not finite");
  if (!(options.residual_tolerance > 0.0) || options.maximum_iterations < 1 ||
      !(options.regularisation >= 0.0)) {
    throw InputError(
        fmt::format("equilibrium: found residual tolerance {}, maximum of iterations {}, regularisation {}, "
                    "expected > 0, >= 1 and >= 0",
                    options.residual_tolerance, options.maximum_iterations, options.regularisation));
  }
}

/// What rounding of x alone leaves of the forces: a few units in the last place of |K|·|x|.
double rounding_of_forces(Search& search, ConstVectorRef x) {
  search.assemble(x, 0.0);
  Vector size = Vector::Zero(search.size());
  for (Index j = 0; j < search.size(); ++j) {
    for (SparseMatrix::InnerIterator entry(search.matrix, j); entry; ++entry) {
      if (!search.is_fixed(entry.row())) size[entry.row()] += std::abs(entry.value() * x[j]);
    }
  }
  return 8.0 * std::numeric_limits<double>::epsilon() * size.maxCoeff();
}

StaticEquilibrium search_equilibrium(Search& search, ConstVectorRef start) {
  StaticEquilibrium result;
  result.position = start;
  Vector force(search.size());
  search.force(start, force);
  const double first_residual = force.lpNorm<Eigen::Infinity>();
  const double tolerance =
      std::max(search.options.residual_tolerance * first_residual, rounding_of_forces(search, start));

  const ContextPointer context = make_context();
  const VectorPointer x = wrap_vector(result.position, search.options.vector, context.get());
  const VectorPointer position_scale = new_vector(search.size(), search.options.vector, context.get());
  const VectorPointer force_scale = new_vector(search.size(), search.options.vector, context.get());
  N_VConst(1.0 / search.extent, position_scale.get());
  // Scaled by the first residual the numbers are of order one; KINSOL measures them by their maximum.
  const double unit = first_residual > 0.0 && std::isfinite(first_residual) ? first_residual : 1.0;
  N_VConst(1.0 / unit, force_scale.get());
  SparseDirectSolver klu(search.matrix, x.get(), context.get());
  search.klu = &klu;
  const std::unique_ptr<void, KinsolDeleter> kinsol(KINCreate(context.get()));
  if (kinsol == nullptr) throw SystemError("SUNDIALS: KINCreate returned nothing");
  void* memory = kinsol.get();
  require(KINSetErrHandlerFn(memory, keep_message, &search), "KINSetErrHandlerFn");
  require(KINSetUserData(memory, &search), "KINSetUserData");
  require(KINInit(memory, residual, x.get()), "KINInit");
  require(KINSetLinearSolver(memory, klu.solver(), klu.matrix()), "KINSetLinearSolver");
  require(KINSetJacFn(memory, jacobian), "KINSetJacFn");
  require(KINSetMaxSetupCalls(memory, 1), "KINSetMaxSetupCalls");
  require(KINSetNumMaxIters(memory, search.options.maximum_iterations), "KINSetNumMaxIters");
  require(KINSetFuncNormTol(memory, tolerance / unit), "KINSetFuncNormTol");
  // The residual decides. Near rounding the last steps are small.
  require(KINSetScaledStepTol(memory, std::numeric_limits<double>::epsilon()), "KINSetScaledStepTol");
  const double length_of_all = std::sqrt(static_cast<double>(search.size()));
  require(KINSetMaxNewtonStep(memory, length_of_all), "KINSetMaxNewtonStep");

  const int flag = KINSol(memory, x.get(), KIN_LINESEARCH, position_scale.get(), force_scale.get());
  search.guard.rethrow();
  long iterations = 0;
  require(KINGetNumNonlinSolvIters(memory, &iterations), "KINGetNumNonlinSolvIters");
  search.work.newton_iterations = search.work.linear_solves = search.work.factorisations =
      static_cast<std::uint64_t>(iterations);

  search.force(result.position, force);
  result.residual = force.lpNorm<Eigen::Infinity>();
  // Near rounding KINSOL may give up its last line search at a point that is good enough.
  if (result.residual <= tolerance) return result;
  result.status = {code_of_flag(flag),
                   fmt::format("KINSOL: {}{}{}; the largest force left is {:.3g} N, wanted is {:.3g} N",
                               name_of_flag(flag), search.message.empty() ? "" : ": ", search.message,
                               result.residual, tolerance)};
  return result;
}

}  // namespace

StaticEquilibrium find_static_equilibrium(const SecondOrderSystem& system, ConstVectorRef start, double time,
                                          const EquilibriumOptions& options) {
  check(system, start, options);
  const RunClock clock;
  double extent = 0.0;
  if (start.size() > 0) extent = start.maxCoeff() - start.minCoeff();
  Search search{system, time, options, extent > 0.0 ? extent : 1.0};
  StaticEquilibrium result = search_equilibrium(search, start);
  result.work = search.work;
  result.work.seconds = clock.seconds();
  return result;
}

}  // namespace fw::oracles
