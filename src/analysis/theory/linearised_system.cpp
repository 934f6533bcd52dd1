#include "analysis/theory/linearised_system.hpp"

#include "analysis/theory/numerical_jacobian.hpp"
#include "ode/functor_system.hpp"
#include "ode/not_applicable.hpp"

namespace fw::analysis {

namespace {

void check_tangent(TangentModel model) {
  if (model != TangentModel::exact)
    throw NotApplicable("a linearised system has its exact tangent stiffness only");
}

/// ẏ = Jy with a dense J.
struct DenseFlow {
  Matrix J;
  template <class S>
  void operator()(const S&, std::span<const S> y, std::span<S> dydt) const {
    for (Index i = 0; i < J.rows(); ++i) {
      S sum(0);
      for (Index j = 0; j < J.cols(); ++j) sum += S(J(i, j)) * y[static_cast<std::size_t>(j)];
      dydt[static_cast<std::size_t>(i)] = sum;
    }
  }
};

}  // namespace

class LinearisedSystem::Splitting final : public ForceSplitting {
 public:
  Splitting(const LinearisedSystem& whole, const ForceSplitting& original, double t, ConstVectorRef q,
            ConstVectorRef v)
      : stiff_stiffness_(whole.pattern_), stiff_damping_(whole.pattern_) {
    original.stiff_stiffness(t, q, v, stiff_stiffness_);
    original.stiff_damping(t, q, v, stiff_damping_);
    soft_stiffness_ = whole.stiffness_;
    soft_damping_ = whole.damping_;
    soft_stiffness_.coeffs() -= stiff_stiffness_.coeffs();
    soft_damping_.coeffs() -= stiff_damping_.coeffs();
  }

  void stiff_force(double, ConstVectorRef q, ConstVectorRef v, VectorRef f) const override {
    f.noalias() = stiff_stiffness_ * q;
    f.noalias() += stiff_damping_ * v;
  }
  void soft_force(double, ConstVectorRef q, ConstVectorRef v, VectorRef f) const override {
    f.noalias() = soft_stiffness_ * q;
    f.noalias() += soft_damping_ * v;
  }
  void stiff_stiffness(double, ConstVectorRef, ConstVectorRef, SparseMatrix& K) const override {
    K.coeffs() = stiff_stiffness_.coeffs();
  }
  void stiff_damping(double, ConstVectorRef, ConstVectorRef, SparseMatrix& D) const override {
    D.coeffs() = stiff_damping_.coeffs();
  }

 private:
  SparseMatrix stiff_stiffness_, stiff_damping_, soft_stiffness_, soft_damping_;
};

LinearisedSystem::LinearisedSystem(const SecondOrderSystem& original, double t, ConstVectorRef q,
                                   ConstVectorRef v)
    : mass_(original.mass()),
      fixed_(original.fixed()),
      force_class_(original.force_class()),
      pattern_(original.tangent_pattern()),
      blocks_(pattern_),
      stiffness_(pattern_),
      damping_(pattern_) {
  original.stiffness(t, q, v, TangentModel::exact, stiffness_);
  if (force_class_ == ForceClass::velocity) original.damping(t, q, v, damping_);
  // The displacement of a fixed degree of freedom is zero: its column has no effect, and without it the
  // matrices are symmetric.
  for (int j = 0; j < pattern_.outerSize(); ++j) {
    if (!fixed_[static_cast<std::size_t>(j)]) continue;
    for (SparseMatrix::InnerIterator entry(stiffness_, j); entry; ++entry) entry.valueRef() = 0.0;
    for (SparseMatrix::InnerIterator entry(damping_, j); entry; ++entry) entry.valueRef() = 0.0;
  }
  if (const ForceSplitting* splitting = original.force_splitting())
    splitting_ = std::make_shared<const Splitting>(*this, *splitting, t, q, v);
}

template <class S>
void LinearisedSystem::evaluate(std::span<const S> y, std::span<S> dydt) const {
  const auto n = static_cast<std::size_t>(mass_.size());
  for (std::size_t i = 0; i < n; ++i) {
    dydt[i] = y[n + i];
    dydt[n + i] = S(0);
  }
  const auto add = [&](const SparseMatrix& matrix, std::span<const S> x) {
    for (int j = 0; j < matrix.outerSize(); ++j) {
      for (SparseMatrix::InnerIterator entry(matrix, j); entry; ++entry)
        dydt[n + static_cast<std::size_t>(entry.row())] += S(entry.value()) * x[static_cast<std::size_t>(j)];
    }
  };
  add(stiffness_, y.first(n));
  if (force_class_ == ForceClass::velocity) add(damping_, y.last(n));
  for (std::size_t i = 0; i < n; ++i) dydt[n + i] /= S(mass_[static_cast<Index>(i)]);
}

void LinearisedSystem::rhs(double t, ConstVectorRef y, VectorRef dydt) const {
  const Index n = mass_.size();
  dydt.head(n) = y.tail(n);
  force(t, y.head(n), y.tail(n), dydt.tail(n));
  dydt.tail(n).array() /= mass_.array();
}

void LinearisedSystem::rhs(const Float128&, std::span<const Float128> y, std::span<Float128> dydt) const {
  evaluate(y, dydt);
}

void LinearisedSystem::rhs(double, std::span<const Complex> y, std::span<Complex> dydt) const {
  evaluate(y, dydt);
}

SparseMatrix LinearisedSystem::jacobian_pattern() const {
  return blocks_.pattern();
}

void LinearisedSystem::jacobian(double, ConstVectorRef, SparseMatrix& J) const {
  blocks_.fill(stiffness_, damping_, mass_, J);
}

void LinearisedSystem::jacobian_product(double t, ConstVectorRef, ConstVectorRef w, VectorRef out) const {
  rhs(t, w, out);
}

void LinearisedSystem::force(double, ConstVectorRef q, ConstVectorRef v, VectorRef f) const {
  f.noalias() = stiffness_ * q;
  if (force_class_ == ForceClass::velocity) f.noalias() += damping_ * v;
}

void LinearisedSystem::stiffness(double, ConstVectorRef, ConstVectorRef, TangentModel model,
                                 SparseMatrix& K) const {
  check_tangent(model);
  K.coeffs() = stiffness_.coeffs();
}

void LinearisedSystem::damping(double, ConstVectorRef, ConstVectorRef, SparseMatrix& D) const {
  D.coeffs() = damping_.coeffs();
}

void LinearisedSystem::tangent_product(double t, ConstVectorRef, ConstVectorRef, ConstVectorRef dq,
                                       ConstVectorRef dv, VectorRef out) const {
  force(t, dq, dv, out);
}

std::shared_ptr<const OdeSystem> homogeneous_part(const std::shared_ptr<const OdeSystem>& system, double t,
                                                  ConstVectorRef y) {
  const Vector zero = Vector::Zero(system->size());
  Vector forcing(system->size());
  bool is_homogeneous = true;
  for (const double time : {t, t + 0.37, t + 0.74}) {  // where analysis::is_linear looks
    system->rhs(time, zero, forcing);
    is_homogeneous = is_homogeneous && forcing.isZero(0.0);
  }
  if (is_homogeneous) return system;
  if (const SecondOrderSystem* mechanics = system->second_order()) {
    const Index n = mechanics->degrees_of_freedom();
    return std::make_shared<const LinearisedSystem>(*mechanics, t, y.head(n), y.tail(n));
  }
  return std::make_shared<const FunctorSystem<DenseFlow>>(system->size(),
                                                          DenseFlow{analytic_jacobian(*system, t, y)});
}

}  // namespace fw::analysis
