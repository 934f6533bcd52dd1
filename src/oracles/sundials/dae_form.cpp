#include "oracles/sundials/dae_form.hpp"

#include "oracles/sundials/sparse_assembly.hpp"

namespace fw::oracles::detail {

namespace {

class FirstOrderForm final : public DaeForm {
 public:
  explicit FirstOrderForm(const OdeSystem& system) : system_(system), jacobian_(system.jacobian_pattern()) {}

  Index size() const override { return system_.size(); }
  void residual(double t, ConstVectorRef y, ConstVectorRef dydt, VectorRef residual) override {
    system_.rhs(t, y, residual);
    residual = dydt - residual;
  }
  const SparseMatrix& pattern() const override { return jacobian_; }
  const SparseMatrix& jacobian(double t, double cj, ConstVectorRef y) override {
    system_.jacobian(t, y, jacobian_);
    jacobian_.coeffs() = -jacobian_.coeffs();
    for (Index i = 0; i < size(); ++i) jacobian_.coeffRef(i, i) += cj;  // the diagonal is in the pattern
    return jacobian_;
  }

 private:
  const OdeSystem& system_;
  SparseMatrix jacobian_;
};

class SecondOrderForm final : public DaeForm {
 public:
  explicit SecondOrderForm(const SecondOrderSystem& system)
      : system_(system),
        stiffness_(system.tangent_pattern()),
        damping_(system.tangent_pattern()),
        jacobian_(assembly(system.degrees_of_freedom(), stiffness_)) {}

  Index size() const override { return 2 * system_.degrees_of_freedom(); }
  void residual(double t, ConstVectorRef y, ConstVectorRef dydt, VectorRef residual) override {
    const Index n = system_.degrees_of_freedom();
    residual.head(n) = dydt.head(n) - y.tail(n);
    system_.force(t, y.head(n), y.tail(n), residual.tail(n));
    residual.tail(n) = system_.mass().cwiseProduct(dydt.tail(n)) - residual.tail(n);
  }
  const SparseMatrix& pattern() const override { return jacobian_.matrix(); }
  /// [[cj I, −I], [−K, cj M − D]]
  const SparseMatrix& jacobian(double t, double cj, ConstVectorRef y) override {
    const Index n = system_.degrees_of_freedom();
    system_.stiffness(t, y.head(n), y.tail(n), TangentModel::exact, stiffness_);
    system_.damping(t, y.head(n), y.tail(n), damping_);
    jacobian_.clear();
    for (Index i = 0; i < n; ++i) {
      jacobian_.add(cj);
      jacobian_.add(-1.0);
      jacobian_.add(cj * system_.mass()[i]);
    }
    for_each_entry(stiffness_, [&](Index, Index, double value) { jacobian_.add(-value); });
    for_each_entry(damping_, [&](Index, Index, double value) { jacobian_.add(-value); });
    return jacobian_.matrix();
  }

 private:
  static SparseAssembly assembly(Index n, const SparseMatrix& tangent) {
    std::vector<std::pair<Index, Index>> places;
    for (Index i = 0; i < n; ++i) {
      places.emplace_back(i, i);
      places.emplace_back(i, n + i);
      places.emplace_back(n + i, n + i);
    }
    for (const Index column : {Index{0}, n}) {
      for_each_entry(tangent, [&](Index i, Index j, double) { places.emplace_back(n + i, column + j); });
    }
    return {2 * n, 2 * n, places};
  }

  const SecondOrderSystem& system_;
  SparseMatrix stiffness_, damping_;
  SparseAssembly jacobian_;
};

}  // namespace

std::unique_ptr<DaeForm> make_residual_form(const OdeSystem& system) {
  if (const SecondOrderSystem* second_order = system.second_order()) {
    return std::make_unique<SecondOrderForm>(*second_order);
  }
  return std::make_unique<FirstOrderForm>(system);
}

}  // namespace fw::oracles::detail
