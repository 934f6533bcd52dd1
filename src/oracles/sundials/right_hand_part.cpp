#include "oracles/sundials/right_hand_part.hpp"

#include <stdexcept>

#include "ode/first_order_jacobian.hpp"
#include "ode/pattern_watch.hpp"

namespace fw::oracles::detail {

namespace {

class WholeRightHandSide final : public RightHandPart {
 public:
  explicit WholeRightHandSide(const OdeSystem& system) : system_(system), watch_(system.pattern_revision()) {}

  void evaluate(double t, ConstVectorRef y, VectorRef dydt) override { system_.rhs(t, y, dydt); }
  const SparseMatrix& pattern() const override {
    const bool is_new = watch_.has_changed(system_.pattern_revision());
    if (jacobian_.size() == 0 || is_new) jacobian_ = system_.jacobian_pattern();
    return jacobian_;
  }
  const SparseMatrix& jacobian(double t, ConstVectorRef y) override {
    pattern();
    system_.jacobian(t, y, jacobian_);
    return jacobian_;
  }

 private:
  const OdeSystem& system_;
  mutable PatternWatch watch_;
  mutable SparseMatrix jacobian_;  ///< made when it is first asked for: explicit methods need none
};

class StiffPart final : public RightHandPart {
 public:
  explicit StiffPart(const SecondOrderSystem& system)
      : system_(system),
        watch_(system.pattern_revision()),
        stiffness_(system.tangent_pattern()),
        damping_(stiffness_),
        blocks_(stiffness_),
        jacobian_(blocks_.pattern()) {}

  void evaluate(double t, ConstVectorRef y, VectorRef dydt) override {
    const Index n = system_.degrees_of_freedom();
    dydt.head(n) = y.tail(n);
    system_.force_splitting()->stiff_force(t, y.head(n), y.tail(n), dydt.tail(n));
    dydt.tail(n).array() /= system_.mass().array();
  }
  const SparseMatrix& pattern() const override { return jacobian_; }
  /// [[0, I], [M⁻¹K, M⁻¹D]]
  const SparseMatrix& jacobian(double t, ConstVectorRef y) override {
    if (watch_.has_changed(system_.pattern_revision())) {
      stiffness_ = damping_ = system_.tangent_pattern();
      blocks_ = FirstOrderJacobian(stiffness_);
      jacobian_ = blocks_.pattern();
    }
    const Index n = system_.degrees_of_freedom();
    const ForceSplitting& splitting = *system_.force_splitting();
    splitting.stiff_stiffness(t, y.head(n), y.tail(n), stiffness_);
    splitting.stiff_damping(t, y.head(n), y.tail(n), damping_);
    blocks_.fill(stiffness_, damping_, system_.mass(), jacobian_);
    return jacobian_;
  }

 private:
  const SecondOrderSystem& system_;
  PatternWatch watch_;
  SparseMatrix stiffness_, damping_;
  FirstOrderJacobian blocks_;
  SparseMatrix jacobian_;
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
