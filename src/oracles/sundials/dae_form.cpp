#include "oracles/sundials/dae_form.hpp"

#include "integrators/loop/particle_norm.hpp"
#include "ode/first_order_jacobian.hpp"
#include "ode/pattern_watch.hpp"
#include "sparse/sparse_slots.hpp"

namespace fw::oracles::detail {

namespace {

class FirstOrderForm final : public DaeForm {
 public:
  explicit FirstOrderForm(const OdeSystem& system)
      : system_(system), watch_(system.pattern_revision()), jacobian_(system.jacobian_pattern()) {}

  Index size() const override { return system_.size(); }
  void residual(double t, ConstVectorRef y, ConstVectorRef dydt, VectorRef residual) override {
    system_.rhs(t, y, residual);
    residual = dydt - residual;
  }
  const SparseMatrix& pattern() const override { return jacobian_; }
  const SparseMatrix& jacobian(double t, double cj, ConstVectorRef y) override {
    if (watch_.has_changed(system_.pattern_revision())) jacobian_ = system_.jacobian_pattern();
    system_.jacobian(t, y, jacobian_);
    jacobian_.coeffs() = -jacobian_.coeffs();
    sparse::add_to_diagonal(jacobian_, cj);
    return jacobian_;
  }

 private:
  const OdeSystem& system_;
  PatternWatch watch_;
  SparseMatrix jacobian_;
};

class SecondOrderForm final : public DaeForm {
 public:
  explicit SecondOrderForm(const SecondOrderSystem& system)
      : system_(system),
        watch_(system.pattern_revision()),
        stiffness_(system.tangent_pattern()),
        damping_(stiffness_),
        blocks_(stiffness_),
        jacobian_(blocks_.pattern()),
        diagonal_(sparse::diagonal_slots(stiffness_)) {}

  Index size() const override { return 2 * system_.degrees_of_freedom(); }
  Vector tolerances(const AdaptiveStep& control) const override {
    const Index n = system_.degrees_of_freedom();
    return absolute_tolerances(control, 2 * n, n, n);
  }
  bool is_of_particles() const override { return integrators::has_particles(system_); }
  void residual(double t, ConstVectorRef y, ConstVectorRef dydt, VectorRef residual) override {
    const Index n = system_.degrees_of_freedom();
    residual.head(n) = dydt.head(n) - y.tail(n);
    system_.force(t, y.head(n), y.tail(n), residual.tail(n));
    residual.tail(n) = system_.mass().cwiseProduct(dydt.tail(n)) - residual.tail(n);
  }
  const SparseMatrix& pattern() const override { return jacobian_; }
  /// [[cj I, −I], [−K, cj M − D]]
  const SparseMatrix& jacobian(double t, double cj, ConstVectorRef y) override {
    if (watch_.has_changed(system_.pattern_revision())) make_pattern();
    const Index n = system_.degrees_of_freedom();
    system_.stiffness(t, y.head(n), y.tail(n), TangentModel::exact, stiffness_);
    system_.damping(t, y.head(n), y.tail(n), damping_);
    double* values = jacobian_.valuePtr();
    for (int c = 0; c < static_cast<int>(n); ++c) {
      values[blocks_.diagonal(c)] = cj;
      values[blocks_.unit(c)] = -1.0;
      for (int k = stiffness_.outerIndexPtr()[c]; k < stiffness_.outerIndexPtr()[c + 1]; ++k) {
        values[blocks_.stiffness(k, c)] = 0.0 - stiffness_.valuePtr()[k];  // no negative zeros
        values[blocks_.damping(k, c)] = 0.0 - damping_.valuePtr()[k];
      }
      values[blocks_.damping(diagonal_[static_cast<std::size_t>(c)], c)] += cj * system_.mass()[c];
    }
    return jacobian_;
  }

 private:
  void make_pattern() {
    stiffness_ = damping_ = system_.tangent_pattern();
    blocks_ = FirstOrderJacobian(stiffness_);
    jacobian_ = blocks_.pattern();
    diagonal_ = sparse::diagonal_slots(stiffness_);
  }

  const SecondOrderSystem& system_;
  PatternWatch watch_;
  SparseMatrix stiffness_, damping_;
  FirstOrderJacobian blocks_;  ///< has the pattern of this Jacobian
  SparseMatrix jacobian_;
  std::vector<int> diagonal_;  ///< slots in the tangents
};

}  // namespace

std::unique_ptr<DaeForm> make_residual_form(const OdeSystem& system) {
  if (const SecondOrderSystem* second_order = system.second_order()) {
    return std::make_unique<SecondOrderForm>(*second_order);
  }
  return std::make_unique<FirstOrderForm>(system);
}

}  // namespace fw::oracles::detail
