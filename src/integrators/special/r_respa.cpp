#include "integrators/special/r_respa.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "core/error.hpp"
#include "integrators/implicit/implicit_kick.hpp"
#include "integrators/loop/stepper.hpp"
#include "ode/force_splitting.hpp"
#include "ode/not_applicable.hpp"
#include "ode/pattern_watch.hpp"

namespace fw::integrators {

namespace {

/// One part of the forces as a system of its own, as far as an implicit kick asks for it. It lives in one
/// run.
class ForcePart final : public SecondOrderSystem {
 public:
  enum class Kind { stiff, soft };

  ForcePart(const SecondOrderSystem& whole, Kind kind)
      : whole_(whole),
        splitting_(*whole.force_splitting()),
        kind_(kind),
        watch_(whole.pattern_revision()),
        product_(whole.degrees_of_freedom()) {
    if (whole.force_class() == ForceClass::velocity) damping_ = whole.tangent_pattern();
  }

  Index degrees_of_freedom() const override { return whole_.degrees_of_freedom(); }
  const Vector& mass() const override { return whole_.mass(); }
  const std::vector<char>& fixed() const override { return whole_.fixed(); }
  ForceClass force_class() const override { return whole_.force_class(); }
  bool has_springs() const override { return whole_.has_springs(); }
  void force(double t, ConstVectorRef q, ConstVectorRef v, VectorRef f) const override {
    kind_ == Kind::stiff ? splitting_.stiff_force(t, q, v, f) : splitting_.soft_force(t, q, v, f);
  }
  SparseMatrix tangent_pattern() const override { return whole_.tangent_pattern(); }
  void stiffness(double t, ConstVectorRef q, ConstVectorRef v, TangentModel model,
                 SparseMatrix& K) const override {
    if (model != TangentModel::exact)
      throw NotApplicable("a part of the forces has its exact tangent stiffness only");
    splitting_.stiff_stiffness(t, q, v, K);
    if (kind_ == Kind::stiff) return;
    SparseMatrix sum = whole_.tangent_pattern();
    whole_.stiffness(t, q, v, model, sum);
    K.coeffs() = sum.coeffs() - K.coeffs();
  }
  void damping(double t, ConstVectorRef q, ConstVectorRef v, SparseMatrix& D) const override {
    splitting_.stiff_damping(t, q, v, D);
    if (kind_ == Kind::stiff) return;
    SparseMatrix sum = whole_.tangent_pattern();
    whole_.damping(t, q, v, sum);
    D.coeffs() = sum.coeffs() - D.coeffs();
  }
  /// For dq = 0, which is what an implicit kick needs: D·dv of the part.
  void tangent_product(double t, ConstVectorRef q, ConstVectorRef v, ConstVectorRef dq, ConstVectorRef dv,
                       VectorRef out) const override {
    if (!dq.isZero(0.0)) throw std::logic_error("a part of the forces multiplies by its damping only");
    if (watch_.has_changed(whole_.pattern_revision())) damping_ = whole_.tangent_pattern();
    splitting_.stiff_damping(t, q, v, damping_);
    product_.noalias() = damping_ * dv;
    if (kind_ == Kind::stiff) {
      out = product_;
      return;
    }
    whole_.tangent_product(t, q, v, dq, dv, out);
    out -= product_;
  }
  std::uint64_t pattern_revision() const override { return whole_.pattern_revision(); }

 private:
  const SecondOrderSystem& whole_;
  const ForceSplitting& splitting_;
  Kind kind_;
  mutable PatternWatch watch_;
  mutable SparseMatrix damping_;  ///< of the stiff part
  mutable Vector product_;
};

class RespaStepper final : public Stepper {
 public:
  RespaStepper(int inner_steps, const Ivp& ivp, Work& work)
      : inner_steps_(inner_steps),
        system_(*ivp.system->second_order()),
        work_(work),
        stiff_(system_, ForcePart::Kind::stiff),
        soft_(system_, ForcePart::Kind::soft),
        stiff_kick_(stiff_, work),
        soft_kick_(soft_, work),
        inverse_mass_(system_.mass().cwiseInverse()),
        stiff_force_(system_.degrees_of_freedom()),
        soft_force_(system_.degrees_of_freedom()),
        held_(system_.degrees_of_freedom()) {
    restart(ivp.t0, ivp.y0);
  }

  Status step(double t, double h, VectorRef y) override {
    const Index n = held_.size();
    auto q = y.head(n);
    auto v = y.tail(n);
    v += (0.5 * h) * inverse_mass_.cwiseProduct(soft_force_);
    if (system_.force_class() == ForceClass::velocity) {  // the soft kicks have changed the velocity
      stiff_.force(t, q, v, stiff_force_);
      ++work_.rhs_evaluations;
    }
    const double tau = h / inner_steps_;
    for (int i = 1; i <= inner_steps_; ++i) {
      held_ = v + (0.5 * tau) * inverse_mass_.cwiseProduct(stiff_force_);
      q += tau * held_;
      v = held_ + (0.5 * tau) * inverse_mass_.cwiseProduct(stiff_force_);
      const double end = i == inner_steps_ ? t + h : t + i * tau;
      if (Status status = stiff_kick_.solve(end, 0.5 * tau, q, held_, v, stiff_force_); !status.ok())
        return status;
    }
    held_ = v;
    v += (0.5 * h) * inverse_mass_.cwiseProduct(soft_force_);
    return soft_kick_.solve(t + h, 0.5 * h, q, held_, v, soft_force_);
  }

  void restart(double t, ConstVectorRef y) override {
    const Index n = held_.size();
    stiff_.force(t, y.head(n), y.tail(n), stiff_force_);
    soft_.force(t, y.head(n), y.tail(n), soft_force_);
    work_.rhs_evaluations += 2;
  }
  void serialise(StateArchive& archive) override {
    archive.visit("stiff force", stiff_force_);
    archive.visit("soft force", soft_force_);
  }

 private:
  int inner_steps_;
  const SecondOrderSystem& system_;
  Work& work_;
  ForcePart stiff_, soft_;
  ImplicitKick stiff_kick_, soft_kick_;
  Vector inverse_mass_, stiff_force_, soft_force_, held_;
};

}  // namespace

std::unique_ptr<Integrator> make_r_respa(const RespaOptions& options) {
  if (options.inner_steps < 1) {
    throw InputError(
        fmt::format("option inner_steps: found {}, expected a whole number >= 1", options.inner_steps));
  }
  MethodInfo info{.name = "r_respa",
                  .title = "r-RESPA (impulse, multiple time steps)",
                  .family = "multirate",
                  .order = 2,
                  .order_with_velocity_forces = 2,
                  .stages = options.inner_steps + 1,
                  .is_symplectic = true,
                  .is_symmetric = true,
                  .needs = {Capability::second_order, Capability::force_splitting},
                  .formula =
                      "v += ½h M^-1 f_soft;  n times velocity Verlet of step h/n with f_stiff;  "
                      "v' = v + ½h M^-1 f_soft'",
                  .reference = "[Grubmüller et al. 1991; Tuckerman, Berne, Martyna 1992]"};
  return std::make_unique<FixedStepIntegrator>(
      std::move(info), [options](const Ivp& ivp, double, Work& work) -> std::unique_ptr<Stepper> {
        return std::make_unique<RespaStepper>(options.inner_steps, ivp, work);
      });
}

}  // namespace fw::integrators
