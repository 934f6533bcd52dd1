#include "oracles/petsc/ts_equations.hpp"

#include <algorithm>
#include <utility>

#include "oracles/petsc/vector_view.hpp"
#include "sparse/sparse_slots.hpp"

namespace fw::oracles {

using linalg::petsc_check;

namespace {

/// δ of the difference in time, as a fraction of the interval: rounding ε/δ and the error δ⁴ of the fourth
/// order formula are equally small.
constexpr double time_increment = 6e-4;

void make_vector(Index size, linalg::PetscVec& vector) {
  petsc_check(VecCreateSeq(PETSC_COMM_SELF, static_cast<PetscInt>(size), vector.out()));
}

/// The pattern of `A` with an empty row and a full column at the end, and a full diagonal.
SparseMatrix with_time_column(const SparseMatrix& A) {
  const Index n = A.cols();
  std::vector<Eigen::Triplet<double, int>> entries;
  for (int column = 0; column < n; ++column) {
    for (SparseMatrix::InnerIterator entry(A, column); entry; ++entry) {
      entries.emplace_back(entry.row(), column, 0.0);
    }
  }
  for (int row = 0; row <= n; ++row) entries.emplace_back(row, static_cast<int>(n), 0.0);
  SparseMatrix wider(n + 1, n + 1);
  wider.setFromTriplets(entries.begin(), entries.end());
  return wider;
}

}  // namespace

TsEquations::TsEquations(const Ivp& ivp, TsForm form, Work& work)
    : system_(*ivp.system),
      second_order_(ivp.system->second_order()),
      form_(form),
      work_(work),
      t0_(ivp.t0),
      length_(ivp.t1 - ivp.t0),
      y0_(ivp.y0),
      watch_(revision()) {
  if (form == TsForm::explicit_form || form == TsForm::hamiltonian) return;
  make_patterns();
  petsc_matrix_ = std::make_unique<linalg::PetscMatrix>(matrix_, linalg::PetscMatrixType::aij);
}

std::uint64_t TsEquations::revision() const {
  return second_order_ != nullptr ? second_order_->pattern_revision() : system_.pattern_revision();
}

void TsEquations::renew_patterns() {
  if (!watch_.has_changed(revision())) return;
  make_patterns();
  petsc_matrix_->set_pattern(matrix_);
}

void TsEquations::make_patterns() {
  const Index n = system_.size();
  switch (form_) {
    case TsForm::explicit_form:
    case TsForm::hamiltonian:
      return;
    case TsForm::second_order:
      matrix_ = second_order_->tangent_pattern();
      stiffness_ = damping_ = matrix_;
      break;
    case TsForm::implicit_explicit:
      stiffness_ = damping_ = second_order_->tangent_pattern();
      blocks_.emplace(stiffness_);
      jacobian_ = blocks_->pattern();
      matrix_ = jacobian_;
      break;
    case TsForm::implicit_form:
      jacobian_ = system_.jacobian_pattern();
      matrix_ = jacobian_;
      break;
    case TsForm::autonomous:
      jacobian_ = system_.jacobian_pattern();
      matrix_ = with_time_column(jacobian_);
      time_derivative_ = Vector::Zero(n);
      other_slope_ = shifted_ = Vector::Zero(n);
      time_place_.clear();
      for (Index row = 0; row < n; ++row) time_place_.push_back(sparse::slot_of(matrix_, row, n));
      break;
  }
  jacobian_place_.clear();
  for (Index column = 0; column < jacobian_.cols(); ++column) {
    for (SparseMatrix::InnerIterator entry(jacobian_, column); entry; ++entry) {
      jacobian_place_.push_back(sparse::slot_of(matrix_, entry.row(), column));
    }
  }
  diagonal_place_ = sparse::diagonal_slots(matrix_);
}

void TsEquations::attach(TS stepper) {
  const Index n = system_.size();
  petsc_check(TSSetApplicationContext(stepper, this));
  // A symplectic step would lose memory by the refusal; its state tells by itself.
  if (form_ != TsForm::hamiltonian) petsc_check(TSSetFunctionDomainError(stepper, state_is_finite));
  if (form_ == TsForm::second_order) {
    make_vector(n / 2, state_);
    make_vector(n / 2, velocity_);
    *WritableVectorView(state_) = y0_.head(n / 2);
    *WritableVectorView(velocity_) = y0_.tail(n / 2);
    petsc_check(TSSetI2Function(stepper, nullptr, second_order_residual, this));
    petsc_check(
        TSSetI2Jacobian(stepper, petsc_matrix_->get(), petsc_matrix_->get(), second_order_matrix, this));
    petsc_check(TS2SetSolution(stepper, state_, velocity_));
    return;
  }
  make_vector(form_ == TsForm::autonomous ? n + 1 : n, state_);
  {
    const WritableVectorView state(state_);
    (*state).head(n) = y0_;
    if (form_ == TsForm::autonomous) (*state)[n] = t0_;
  }
  petsc_check(TSSetSolution(stepper, state_));
  switch (form_) {
    case TsForm::explicit_form:
      petsc_check(TSSetRHSFunction(stepper, nullptr, explicit_slope, this));
      break;
    case TsForm::hamiltonian: {
      const auto half = static_cast<PetscInt>(n / 2);
      petsc_check(ISCreateStride(PETSC_COMM_SELF, half, 0, 1, positions_.out()));
      petsc_check(ISCreateStride(PETSC_COMM_SELF, half, half, 1, momenta_.out()));
      petsc_check(TSRHSSplitSetIS(stepper, "position", positions_));
      petsc_check(TSRHSSplitSetIS(stepper, "momentum", momenta_));
      petsc_check(TSRHSSplitSetRHSFunction(stepper, "position", nullptr, velocity_of_position, this));
      petsc_check(TSRHSSplitSetRHSFunction(stepper, "momentum", nullptr, force_on_momentum, this));
      break;
    }
    default:
      if (form_ == TsForm::implicit_explicit) {
        petsc_check(TSSetRHSFunction(stepper, nullptr, soft_slope, this));
      }
      petsc_check(TSSetIFunction(stepper, nullptr, implicit_residual, this));
      petsc_check(TSSetIJacobian(stepper, petsc_matrix_->get(), petsc_matrix_->get(), implicit_matrix, this));
  }
}

void TsEquations::interpolate(TS ts, double t, VectorRef y) {
  if (!inside_) petsc_check(VecDuplicate(state_, inside_.out()));
  petsc_check(TSInterpolate(ts, t, inside_));
  y = (*VectorView(inside_)).head(y.size());
}

void TsEquations::copy_state(VectorRef y) const {
  if (form_ == TsForm::second_order) {
    y.head(y.size() / 2) = *VectorView(state_);
    y.tail(y.size() / 2) = *VectorView(velocity_);
  } else {
    y = (*VectorView(state_)).head(y.size());
  }
}

void TsEquations::rethrow() {
  if (exception_) std::rethrow_exception(std::exchange(exception_, nullptr));
}

bool TsEquations::take_non_finite() {
  stage_is_non_finite_ = false;
  return std::exchange(non_finite_, false);
}

void TsEquations::note(ConstVectorRef values) {
  if (!values.allFinite()) non_finite_ = stage_is_non_finite_ = true;
}

template <class Body>
PetscErrorCode TsEquations::guarded(Body body) {
  try {
    body();
    return 0;
  } catch (...) {
    exception_ = std::current_exception();
    // A symplectic step holds parts of the state that it would not give back after an error: it is let run to
    // its end, and the exception goes on from there.
    return form_ == TsForm::hamiltonian ? 0 : PETSC_ERR_USER;
  }
}

void TsEquations::slope(double t, ConstVectorRef y, VectorRef dydt) {
  ++work_.rhs_evaluations;
  if (form_ == TsForm::implicit_explicit) {
    const Index n = y.size() / 2;
    dydt.head(n) = y.tail(n);
    second_order_->force_splitting()->stiff_force(t, y.head(n), y.tail(n), dydt.tail(n));
    dydt.tail(n).array() /= second_order_->mass().array();
  } else if (form_ == TsForm::autonomous) {
    const Index n = system_.size();
    system_.rhs(y[n], y.head(n), dydt.head(n));
    dydt[n] = 1.0;
  } else {
    system_.rhs(t, y, dydt);
  }
  note(dydt);
}

void TsEquations::assemble(double t, ConstVectorRef y, double sigma) {
  ++work_.jacobian_evaluations;
  ++work_.factorisations;
  renew_patterns();
  const Index n = system_.size();
  if (form_ == TsForm::implicit_explicit) {
    assemble_stiff(t, y);
  } else {
    system_.jacobian(form_ == TsForm::autonomous ? y[n] : t, y.head(n), jacobian_);
  }
  double* values = matrix_.valuePtr();
  for (std::size_t k = 0; k < jacobian_place_.size(); ++k)
    values[jacobian_place_[k]] = -jacobian_.valuePtr()[k];
  if (form_ == TsForm::autonomous) {
    differentiate_in_time(y[n], y.head(n));
    for (std::size_t i = 0; i < time_place_.size(); ++i) {
      values[time_place_[i]] = -time_derivative_[static_cast<Index>(i)];
    }
    values[diagonal_place_.back()] = 0.0;
  }
  for (const int place : diagonal_place_) values[place] += sigma;
  note(matrix_.coeffs());
  if (!matrix_.coeffs().allFinite()) {
    // KLU would fail in the middle of a step, from which PETSc does not recover its memory. The right-hand
    // side is not finite either, and ends the step.
    matrix_.coeffs().setZero();
    for (const int place : diagonal_place_) values[place] = sigma;
  }
  petsc_matrix_->set_values(matrix_);
}

/// ∂(v, M⁻¹ f_stiff)/∂(q, v).
void TsEquations::assemble_stiff(double t, ConstVectorRef y) {
  const Index n = y.size() / 2;
  const ForceSplitting& splitting = *second_order_->force_splitting();
  splitting.stiff_stiffness(t, y.head(n), y.tail(n), stiffness_);
  splitting.stiff_damping(t, y.head(n), y.tail(n), damping_);
  blocks_->fill(stiffness_, damping_, second_order_->mass(), jacobian_);
}

/// ∂f/∂t ≈ 4/3 Δ(δ) − 1/3 Δ(2δ) with Δ(δ) = (f(t + δ) − f(t − δ))/(2δ); zero is told by the first difference.
void TsEquations::differentiate_in_time(double t, ConstVectorRef y) {
  const auto difference = [&](double delta, Vector& out) {
    const double after = t + delta, before = t - delta;
    system_.rhs(after, y, out);
    system_.rhs(before, y, shifted_);
    work_.rhs_evaluations += 2;
    out = (out - shifted_) / (after - before);
  };
  const double delta = time_increment * std::min(length_, 1.0);
  difference(delta, time_derivative_);
  if ((time_derivative_.array() == 0.0).all()) return;
  difference(2.0 * delta, other_slope_);
  time_derivative_ = (4.0 / 3.0) * time_derivative_ - (1.0 / 3.0) * other_slope_;
}

PetscErrorCode TsEquations::explicit_slope(TS, PetscReal t, Vec y, Vec dydt, void* context) {
  auto& self = *static_cast<TsEquations*>(context);
  return self.guarded([&] { self.slope(t, *VectorView(y), *WritableVectorView(dydt)); });
}

PetscErrorCode TsEquations::soft_slope(TS, PetscReal t, Vec y, Vec dydt, void* context) {
  auto& self = *static_cast<TsEquations*>(context);
  return self.guarded([&] {
    const VectorView state(y);
    const WritableVectorView out(dydt);
    const Index n = self.system_.size() / 2;
    ++self.work_.rhs_evaluations;
    (*out).head(n).setZero();
    self.second_order_->force_splitting()->soft_force(t, (*state).head(n), (*state).tail(n), (*out).tail(n));
    (*out).tail(n).array() /= self.second_order_->mass().array();
    self.note(*out);
  });
}

PetscErrorCode TsEquations::implicit_residual(TS, PetscReal t, Vec y, Vec ydot, Vec F, void* context) {
  auto& self = *static_cast<TsEquations*>(context);
  return self.guarded([&] {
    const WritableVectorView out(F);
    self.slope(t, *VectorView(y), *out);
    *out = *VectorView(ydot) - *out;
  });
}

PetscErrorCode TsEquations::implicit_matrix(TS, PetscReal t, Vec y, Vec, PetscReal sigma, Mat A, Mat P,
                                            void* context) {
  auto& self = *static_cast<TsEquations*>(context);
  return self.guarded([&] {
    self.assemble(t, *VectorView(y), sigma);
    if (A == P) return;  // otherwise A works without entries
    petsc_check(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY));
    petsc_check(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
  });
}

PetscErrorCode TsEquations::second_order_residual(TS, PetscReal t, Vec q, Vec v, Vec a, Vec F,
                                                  void* context) {
  auto& self = *static_cast<TsEquations*>(context);
  return self.guarded([&] {
    const WritableVectorView out(F);
    self.second_order_->force(t, *VectorView(q), *VectorView(v), *out);
    ++self.work_.rhs_evaluations;
    *out = self.second_order_->mass().cwiseProduct(*VectorView(a)) - *out;
    self.note(*out);
  });
}

PetscErrorCode TsEquations::second_order_matrix(TS, PetscReal t, Vec q, Vec v, Vec, PetscReal sigma_v,
                                                PetscReal sigma_a, Mat A, Mat P, void* context) {
  auto& self = *static_cast<TsEquations*>(context);
  return self.guarded([&] {
    const VectorView position(q), velocity(v);
    ++self.work_.jacobian_evaluations;
    ++self.work_.factorisations;
    self.renew_patterns();
    self.second_order_->stiffness(t, *position, *velocity, TangentModel::exact, self.stiffness_);
    self.second_order_->damping(t, *position, *velocity, self.damping_);
    self.matrix_.coeffs() = -self.stiffness_.coeffs() - sigma_v * self.damping_.coeffs();
    for (std::size_t i = 0; i < self.diagonal_place_.size(); ++i) {
      self.matrix_.valuePtr()[self.diagonal_place_[i]] +=
          sigma_a * self.second_order_->mass()[static_cast<Index>(i)];
    }
    self.petsc_matrix_->set_values(self.matrix_);
    if (A == P) return;
    petsc_check(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY));
    petsc_check(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
  });
}

PetscErrorCode TsEquations::velocity_of_position(TS, PetscReal, Vec v, Vec out, void* context) {
  return static_cast<TsEquations*>(context)->guarded([&] { petsc_check(VecCopy(v, out)); });
}

PetscErrorCode TsEquations::force_on_momentum(TS, PetscReal t, Vec q, Vec out, void* context) {
  auto& self = *static_cast<TsEquations*>(context);
  return self.guarded([&] {
    const VectorView position(q);
    const WritableVectorView acceleration(out);
    self.shifted_.setZero((*position).size());  // a velocity that the force does not look at
    self.second_order_->force(t, *position, self.shifted_, *acceleration);
    ++self.work_.rhs_evaluations;
    (*acceleration).array() /= self.second_order_->mass().array();
    self.note(*acceleration);
  });
}

PetscErrorCode TsEquations::state_is_finite(TS stepper, PetscReal, Vec, PetscBool* accept) {
  void* context = nullptr;
  PetscCall(TSGetApplicationContext(stepper, static_cast<void*>(&context)));
  // Every slope of this step so far has been finite; otherwise PETSc tries a smaller step.
  auto& self = *static_cast<TsEquations*>(context);
  *accept = std::exchange(self.stage_is_non_finite_, false) ? PETSC_FALSE : PETSC_TRUE;
  return 0;
}

}  // namespace fw::oracles
