#include "oracles/sundials/constrained_form.hpp"

#include "ode/pattern_watch.hpp"
#include "oracles/sundials/sparse_assembly.hpp"

namespace fw::oracles::detail {

namespace {

using constraints::DistanceConstraints;

class ConstrainedForm final : public DaeForm {
 public:
  ConstrainedForm(const SecondOrderSystem& system, const DistanceConstraints& constraints,
                  ConstraintExcess held)
      : system_(system),
        constraints_(constraints),
        held_(std::move(held)),
        n_(system.degrees_of_freedom()),
        m_(constraints.size()),
        watch_(system.pattern_revision()),
        stiffness_(system.tangent_pattern()),
        damping_(stiffness_),
        jacobian_(make_assembly()) {}

  Index size() const override { return 2 * n_ + 2 * m_; }

  void residual(double t, ConstVectorRef y, ConstVectorRef dydt, VectorRef residual) override {
    const auto q = y.head(n_), v = y.segment(n_, n_);
    const auto mu = y.segment(2 * n_, m_), lambda = y.tail(m_);
    const Vector& mass = system_.mass();
    // Gᵀμ and f + Gᵀλ, then what they have to equal.
    auto position_row = residual.head(n_);
    auto velocity_row = residual.segment(n_, n_);
    position_row.setZero();
    constraints_.add_transposed_product(q, mu, position_row);
    position_row = mass.cwiseProduct(dydt.head(n_) - v) - position_row;
    system_.force(t, q, v, velocity_row);
    constraints_.add_transposed_product(q, lambda, velocity_row);
    velocity_row = mass.cwiseProduct(dydt.segment(n_, n_)) - velocity_row;
    constraints_.value(q, residual.segment(2 * n_, m_));
    constraints_.product(q, v, residual.tail(m_));
    residual.segment(2 * n_, m_) -= held_.position;
    residual.tail(m_) -= held_.velocity;
  }

  const SparseMatrix& pattern() const override { return jacobian_.matrix(); }

  const SparseMatrix& jacobian(double t, double cj, ConstVectorRef y) override {
    if (watch_.has_changed(system_.pattern_revision())) {
      stiffness_ = damping_ = system_.tangent_pattern();
      jacobian_ = make_assembly();
    }
    const auto q = y.head(n_), v = y.segment(n_, n_);
    system_.stiffness(t, q, v, TangentModel::exact, stiffness_);
    system_.damping(t, q, v, damping_);
    jacobian_.clear();
    visit(cj, y, [&](Index, Index, double value) { jacobian_.add(value); });
    return jacobian_.matrix();
  }

 private:
  /// Calls `entry(row, column, value)` for
  ///   [ cj M − H(μ)    −M          −Gᵀ   0   ]
  ///   [ −K − H(λ)      cj M − D    0     −Gᵀ ]
  ///   [ G              0           0     0   ]
  ///   [ G(v)           G           0     0   ]
  /// with K and D as they are in `stiffness_` and `damping_`.
  template <class Entry>
  void visit(double cj, ConstVectorRef y, Entry entry) const {
    const auto q = y.head(n_), v = y.segment(n_, n_);
    const Index mu = 2 * n_, lambda = 2 * n_ + m_;
    const Vector& mass = system_.mass();
    for (Index i = 0; i < n_; ++i) {
      entry(i, i, cj * mass[i]);
      entry(i, n_ + i, -mass[i]);
      entry(n_ + i, n_ + i, cj * mass[i]);
    }
    for_each_entry(stiffness_, [&](Index i, Index j, double value) { entry(n_ + i, j, -value); });
    for_each_entry(damping_, [&](Index i, Index j, double value) { entry(n_ + i, n_ + j, -value); });
    constraints_.for_each_second_derivative(y.segment(mu, m_),
                                            [&](Index i, Index j, double value) { entry(i, j, -value); });
    constraints_.for_each_second_derivative(
        y.segment(lambda, m_), [&](Index i, Index j, double value) { entry(n_ + i, j, -value); });
    constraints_.for_each_derivative(q, [&](Index c, Index i, double slope) {
      entry(i, mu + c, -slope);
      entry(n_ + i, lambda + c, -slope);
      entry(mu + c, i, slope);
      entry(lambda + c, n_ + i, slope);
    });
    constraints_.for_each_derivative(v, [&](Index c, Index i, double slope) { entry(lambda + c, i, slope); });
  }

  SparseAssembly make_assembly() const {
    std::vector<std::pair<Index, Index>> places;
    visit(0.0, Vector::Zero(size()), [&](Index i, Index j, double) { places.emplace_back(i, j); });
    return {size(), size(), places};
  }

  const SecondOrderSystem& system_;
  const DistanceConstraints& constraints_;
  ConstraintExcess held_;
  Index n_, m_;
  PatternWatch watch_;
  SparseMatrix stiffness_, damping_;
  SparseAssembly jacobian_;
};

}  // namespace

ConstraintExcess excess(const DistanceConstraints& constraints, ConstVectorRef q, ConstVectorRef v) {
  ConstraintExcess result{Vector(constraints.size()), Vector(constraints.size())};
  constraints.value(q, result.position);
  constraints.product(q, v, result.velocity);
  return result;
}

std::unique_ptr<DaeForm> make_constrained_form(const SecondOrderSystem& system,
                                               const DistanceConstraints& constraints,
                                               ConstraintExcess held) {
  return std::make_unique<ConstrainedForm>(system, constraints, std::move(held));
}

}  // namespace fw::oracles::detail
