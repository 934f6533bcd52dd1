#include "oracles/sundials/right_hand_part.hpp"

#include <stdexcept>

#include "oracles/sundials/sparse_assembly.hpp"

namespace fw::oracles::detail {

namespace {

class WholeRightHandSide final : public RightHandPart {
 public:
  explicit WholeRightHandSide(const OdeSystem& system) : system_(system) {}

  void evaluate(double t, ConstVectorRef y, VectorRef dydt) override { system_.rhs(t, y, dydt); }
  const SparseMatrix& pattern() const override {
    if (jacobian_.size() == 0) jacobian_ = system_.jacobian_pattern();
    return jacobian_;
  }
  const SparseMatrix& jacobian(double t, ConstVectorRef y) override {
    pattern();
    system_.jacobian(t, y, jacobian_);
    return jacobian_;
  }

 private:
  const OdeSystem& system_;
  mutable SparseMatrix jacobian_;  ///< made when it is first asked for: explicit methods need none
};

class StiffPart final : public RightHandPart {
 public:
  explicit StiffPart(const SecondOrderSystem& system)
      : system_(system),
        stiffness_(system.tangent_pattern()),
        damping_(system.tangent_pattern()),
        jacobian_(assembly(system.degrees_of_freedom(), stiffness_)) {}

  void evaluate(double t, ConstVectorRef y, VectorRef dydt) override {
    const Index n = system_.degrees_of_freedom();
    dydt.head(n) = y.tail(n);
    system_.force_splitting()->stiff_force(t, y.head(n), y.tail(n), dydt.tail(n));
    dydt.tail(n).array() /= system_.mass().array();
  }
  const SparseMatrix& pattern() const override { return jacobian_.matrix(); }
  /// [[0, I], [M⁻¹K, M⁻¹D]]
  const SparseMatrix& jacobian(double t, ConstVectorRef y) override {
    const Index n = system_.degrees_of_freedom();
    const ForceSplitting& splitting = *system_.force_splitting();
    splitting.stiff_stiffness(t, y.head(n), y.tail(n), stiffness_);
    splitting.stiff_damping(t, y.head(n), y.tail(n), damping_);
    jacobian_.clear();
    for (Index i = 0; i < n; ++i) {
      jacobian_.add(0.0);
      jacobian_.add(1.0);
    }
    const Vector& mass = system_.mass();
    for_each_entry(stiffness_, [&](Index i, Index, double value) { jacobian_.add(value / mass[i]); });
    for_each_entry(damping_, [&](Index i, Index, double value) { jacobian_.add(value / mass[i]); });
    return jacobian_.matrix();
  }

 private:
  static SparseAssembly assembly(Index n, const SparseMatrix& tangent) {
    std::vector<std::pair<Index, Index>> places;
    for (Index i = 0; i < n; ++i) {
      places.emplace_back(i, i);
      places.emplace_back(i, n + i);
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

class SoftPart final : public RightHandPart {
 public:
  explicit SoftPart(const SecondOrderSystem& system) : system_(system) {}

  void evaluate(double t, ConstVectorRef y, VectorRef dydt) override {
    const Index n = system_.degrees_of_freedom();
    dydt.head(n).setZero();
    system_.force_splitting()->soft_force(t, y.head(n), y.tail(n), dydt.tail(n));
    dydt.tail(n).array() /= system_.mass().array();
  }
  const SparseMatrix& pattern() const override { throw std::logic_error("the soft part is explicit"); }
  const SparseMatrix& jacobian(double, ConstVectorRef) override {
    throw std::logic_error("the soft part is explicit");
  }

 private:
  const SecondOrderSystem& system_;
};

}  // namespace

std::unique_ptr<RightHandPart> make_whole_right_hand_side(const OdeSystem& system) {
  return std::make_unique<WholeRightHandSide>(system);
}
std::unique_ptr<RightHandPart> make_stiff_right_hand_part(const SecondOrderSystem& system) {
  return std::make_unique<StiffPart>(system);
}
std::unique_ptr<RightHandPart> make_soft_right_hand_part(const SecondOrderSystem& system) {
  return std::make_unique<SoftPart>(system);
}

}  // namespace fw::oracles::detail
