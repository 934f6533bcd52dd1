#include "oracles/petsc/static_equilibrium.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <utility>

#include "core/error.hpp"
#include "linalg/petsc_matrix.hpp"
#include "oracles/petsc/vector_view.hpp"

namespace fw::oracles::snes {

using linalg::petsc_check;

namespace {

/// −f(t, x, 0) = 0 on the moving degrees of freedom, x = start on the others, as callbacks of SNES.
class ForceBalance {
 public:
  ForceBalance(const SecondOrderSystem& system, ConstVectorRef start, double time,
               const EquilibriumOptions& options, Work& work)
      : system_(system),
        start_(start),
        time_(time),
        options_(options),
        work_(work),
        rest_(Vector::Zero(start.size())),
        force_(start.size()),
        tangent_(system.tangent_pattern()),
        matrix_(tangent_, linalg::PetscMatrixType::aij) {
    double extent = 0.0;
    for (Index axis = 0; axis < 3 && axis < start.size(); ++axis) {
      const auto every_third = start(Eigen::seq(axis, start.size() - 1, 3));
      extent = std::max(extent, every_third.maxCoeff() - every_third.minCoeff());
    }
    extent_ = extent > 0.0 ? extent : 1.0;
  }

  void attach(SNES solver, Vec residual) {
    petsc_check(SNESSetFunction(solver, residual, evaluate, this));
    petsc_check(SNESSetJacobian(solver, matrix_.get(), matrix_.get(), assemble, this));
  }

  double residual(ConstVectorRef x) {
    system_.force(time_, x, rest_, force_);
    ++work_.rhs_evaluations;
    return force_.lpNorm<Eigen::Infinity>();
  }

  void rethrow() {
    if (exception_) std::rethrow_exception(std::exchange(exception_, nullptr));
  }

 private:
  static PetscErrorCode evaluate(SNES solver, Vec x, Vec F, void* context) {
    auto& self = *static_cast<ForceBalance*>(context);
    return self.guarded([&] {
      const VectorView position(x);
      const WritableVectorView out(F);
      self.system_.force(self.time_, *position, self.rest_, *out);
      ++self.work_.rhs_evaluations;
      *out = -*out;
      for (Index i = 0; i < self.start_.size(); ++i) {
        if (self.is_fixed(i)) (*out)[i] = (*position)[i] - self.start_[i];
      }
      if (!(*out).allFinite()) petsc_check(SNESSetFunctionDomainError(solver));
    });
  }

  static PetscErrorCode assemble(SNES, Vec x, Mat A, Mat P, void* context) {
    auto& self = *static_cast<ForceBalance*>(context);
    return self.guarded([&] {
      const VectorView position(x);
      ++self.work_.jacobian_evaluations;
      ++self.work_.factorisations;
      self.system_.stiffness(self.time_, *position, self.rest_, self.options_.tangent, self.tangent_);
      const double shift = self.options_.regularisation * self.residual(*position) / self.extent_;
      for (int column = 0; column < self.tangent_.cols(); ++column) {
        for (SparseMatrix::InnerIterator entry(self.tangent_, column); entry; ++entry) {
          const bool is_diagonal = entry.row() == column;
          entry.valueRef() = -entry.value() + (is_diagonal ? shift : 0.0);
          if (self.is_fixed(entry.row()) || self.is_fixed(column)) entry.valueRef() = is_diagonal ? 1.0 : 0.0;
        }
      }
      self.matrix_.set_values(self.tangent_);
      if (A == P) return;
      petsc_check(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY));
      petsc_check(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
    });
  }

  bool is_fixed(Index i) const { return system_.fixed()[static_cast<std::size_t>(i)] != 0; }

  template <class Body>
  PetscErrorCode guarded(Body body) {
    try {
      body();
      return 0;
    } catch (...) {
      exception_ = std::current_exception();
      return PETSC_ERR_USER;
    }
  }

  const SecondOrderSystem& system_;
  const Vector start_;
  double time_;
  const EquilibriumOptions& options_;
  Work& work_;
  Vector rest_, force_;
  SparseMatrix tangent_;
  linalg::PetscMatrix matrix_;
  double extent_ = 1.0;
  std::exception_ptr exception_;
};

Status status_of(SNESConvergedReason reason, KSPConvergedReason linear, double residual, double target) {
  const std::string name = fmt::format("SNES_{}", SNESConvergedReasons[reason]);
  if (residual <= target) return {};
  const std::string found =
      fmt::format("{}: the largest force is {:.3g} N, expected at most {:.3g} N", name, residual, target);
  switch (reason) {
    case SNES_DIVERGED_FNORM_NAN:
    case SNES_DIVERGED_FUNCTION_DOMAIN:
      return {StatusCode::non_finite, found};
    case SNES_DIVERGED_LINEAR_SOLVE:
      return {
          linear == KSP_DIVERGED_PC_FAILED ? StatusCode::matrix_singular : StatusCode::linear_solver_failed,
          fmt::format("{}, KSP_{}", found, KSPConvergedReasons[linear])};
    default:
      return {StatusCode::newton_failed, found};
  }
}

void check(const SecondOrderSystem& system, ConstVectorRef start, const EquilibriumOptions& options) {
  if (start.size() != system.degrees_of_freedom()) {
    throw InputError(fmt::format("start of the equilibrium: found {} values, expected {}", start.size(),
                                 system.degrees_of_freedom()));
  }
  if (!start.allFinite()) throw InputError("start of the equilibrium: found a value that is not finite");
  if (!(options.residual_tolerance > 0.0) || options.maximum_iterations < 1 ||
      !(options.regularisation >= 0.0)) {
    throw InputError(
        fmt::format("equilibrium: found residual tolerance {}, {} iterations and regularisation {}, expected "
                    "> 0, >= 1 and >= 0",
                    options.residual_tolerance, options.maximum_iterations, options.regularisation));
  }
}

void configure(SNES solver, const EquilibriumOptions& options, double target,
               const linalg::PetscOptionText& text) {
  KSP linear = nullptr;
  PC factorisation = nullptr;
  petsc_check(SNESSetType(solver, options.kind == NewtonKind::trust_region ? SNESNEWTONTR : SNESNEWTONLS));
  // PETSc measures ‖F‖₂ >= ‖f‖∞; a correction near rounding ends the search as well, and the force decides.
  petsc_check(SNESSetTolerances(solver, target, 0.0, 1e-15, options.maximum_iterations, PETSC_MAX_INT));
  petsc_check(SNESGetKSP(solver, &linear));
  petsc_check(KSPSetType(linear, KSPPREONLY));
  petsc_check(KSPGetPC(linear, &factorisation));
  petsc_check(PCSetType(factorisation, PCLU));
  petsc_check(PCFactorSetMatSolverType(factorisation, MATSOLVERKLU));
  if (options.kind == NewtonKind::trust_region) {
    // The trust region's test sits in the linear solver, which has to iterate for it.
    petsc_check(KSPSetType(linear, KSPGMRES));
  }
  linalg::with_options_to_blame(text, [&] { petsc_check(SNESSetFromOptions(solver)); });
}

}  // namespace

StaticEquilibrium find_static_equilibrium(const SecondOrderSystem& system, ConstVectorRef start, double time,
                                          const EquilibriumOptions& options) {
  check(system, start, options);
  StaticEquilibrium result;
  result.position = start;
  const linalg::PetscOptionText text(options.petsc);
  ForceBalance balance(system, start, time, options, result.work);
  const double first = balance.residual(start);
  // Rounding of the spring forces: K x ε.
  const double rounding =
      64.0 * std::numeric_limits<double>::epsilon() * start.lpNorm<Eigen::Infinity>() * [&] {
        SparseMatrix K = system.tangent_pattern();
        system.stiffness(time, start, Vector::Zero(start.size()), TangentModel::exact, K);
        return K.nonZeros() > 0 ? K.coeffs().abs().maxCoeff() : 0.0;
      }();
  const double target = std::max(options.residual_tolerance * first, rounding);
  if (!std::isfinite(first)) {
    result.residual = first;
    result.status = {StatusCode::non_finite, "the force at the start is not finite"};
    return result;
  }
  SNESConvergedReason reason = SNES_CONVERGED_ITERATING;
  KSPConvergedReason linear_reason = KSP_CONVERGED_ITERATING;
  try {
    const linalg::PetscSession session(&text);
    linalg::PetscVec position, residual;
    linalg::PetscSnes solver;
    petsc_check(VecCreateSeq(PETSC_COMM_SELF, static_cast<PetscInt>(start.size()), position.out()));
    petsc_check(VecDuplicate(position, residual.out()));
    *WritableVectorView(position) = start;
    petsc_check(SNESCreate(PETSC_COMM_SELF, solver.out()));
    balance.attach(solver, residual);
    configure(solver, options, target, text);
    petsc_check(SNESSolve(solver, nullptr, position));
    balance.rethrow();
    text.check_all_used();
    result.position = *VectorView(position);
    KSP linear = nullptr;
    PetscInt iterations = 0;
    petsc_check(SNESGetConvergedReason(solver, &reason));
    petsc_check(SNESGetIterationNumber(solver, &iterations));
    petsc_check(SNESGetKSP(solver, &linear));
    petsc_check(KSPGetConvergedReason(linear, &linear_reason));
    result.work.newton_iterations = result.work.linear_solves = static_cast<std::uint64_t>(iterations);
  } catch (const linalg::PetscFailure& failure) {
    balance.rethrow();
    result.residual = balance.residual(result.position);
    result.status = linalg::status_of(failure);
    return result;
  }
  result.residual = balance.residual(result.position);
  result.status = status_of(reason, linear_reason, result.residual, target);
  return result;
}

}  // namespace fw::oracles::snes
