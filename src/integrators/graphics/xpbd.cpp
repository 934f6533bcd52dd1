#include "integrators/graphics/xpbd.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "core/error.hpp"
#include "integrators/graphics/explicit_external_force.hpp"
#include "integrators/loop/mass_spring_access.hpp"
#include "integrators/loop/stepper.hpp"
#include "mechanics/elements/spring_force.hpp"
#include "ode/not_applicable.hpp"

namespace fw::integrators {

namespace {

class XpbdStepper final : public Stepper {
 public:
  XpbdStepper(const XpbdOptions& options, const mechanics::MassSpringSystem& system, Work& work)
      : options_(options),
        model_(system.model()),
        work_(work),
        external_(system, ExplicitExternalForce::Dampers::to_neither, "xpbd"),
        inverse_mass_(model_.mass.size()),
        start_(system.degrees_of_freedom()),
        displacement_(system.degrees_of_freedom()),
        force_(system.degrees_of_freedom()) {
    if (!model_.support_motions.empty()) {
      throw NotApplicable(
          "method \"xpbd\": found anchors whose supports move, expected supports that stand: its constraints "
          "are "
          "those of the positions at the start");
    }
    for (std::size_t i = 0; i < inverse_mass_.size(); ++i) {
      inverse_mass_[i] = system.fixed()[3 * i] ? 0.0 : 1.0 / model_.mass[i];
    }
  }

  Status step(double t, double h, VectorRef y) override {
    const double length = h / options_.substeps;
    for (int substep = 0; substep < options_.substeps; ++substep) {
      make_substep(t + (substep + 1) * length, length, y);
    }
    return {};
  }

  /// A step depends on y only: multipliers start from zero in each substep.
  void restart(double, ConstVectorRef) override {}
  void serialise(StateArchive&) override {}

 private:
  /// A substep of the length τ that ends at the time `end`.
  void make_substep(double end, double tau, VectorRef y) {
    const Index n = force_.size();
    auto q = y.head(n);
    auto v = y.tail(n);
    external_.evaluate(end, q, v, force_);
    ++work_.rhs_evaluations;
    // The displacement of the substep is kept apart from the position: velocities are then free of q's
    // rounding over τ.
    start_ = q;
    for (Index c = 0; c < n; ++c) {
      displacement_[c] = tau * (v[c] + tau * inverse_mass_[static_cast<std::size_t>(c / 3)] * force_[c]);
    }
    spring_multiplier_.assign(model_.springs.size(), 0.0);
    anchor_multiplier_.assign(model_.anchors.size(), Vec3<double>{});
    for (int sweep = 0; sweep < options_.iterations; ++sweep) {
      model_.springs.for_each_group([&](const mechanics::SpringGroup& group, std::size_t begin) {
        mechanics::with_spring_law(group.law, [&](auto law) {
          for (std::size_t e = begin; e < begin + group.size; ++e) project_spring<law()>(e, tau);
        });
      });
      for (std::size_t a = 0; a < model_.anchors.size(); ++a) project_anchor(a, tau);
    }
    v = displacement_ / tau;
    q = start_ + displacement_;
  }

  /// The correction in terms of the impulse-like multiplier λ, multiplied by k: k = 0 is then no exception.
  template <mechanics::SpringLaw Law>
  void project_spring(std::size_t e, double tau) {
    const mechanics::Springs& springs = model_.springs;
    const mechanics::SpringParameters spring = mechanics::spring_parameters(springs, e);
    const int i = springs.first[e];
    const int j = springs.second[e];
    const double inverse_i = inverse_mass_[static_cast<std::size_t>(i)];
    const double inverse_j = inverse_mass_[static_cast<std::size_t>(j)];
    double* u = displacement_.data();
    const Vec3<double> moved = load3(u, j) - load3(u, i);
    const Vec3<double> d = load3(start_.data(), j) - load3(start_.data(), i) + moved;
    const double distance = norm(d);
    if (distance == 0.0 || inverse_i + inverse_j == 0.0) return;
    const Vec3<double> r = (1.0 / distance) * d;
    const double stiffness =
        mechanics::spring_acts<Law>(spring, distance) ? mechanics::spring_rate<Law>(spring) : 0.0;
    const double damping = spring.damping / tau;
    double& multiplier = spring_multiplier_[e];
    const double change =
        -(stiffness * (distance - spring.rest_length) + multiplier / (tau * tau) + damping * dot(r, moved)) /
        ((stiffness + damping) * (inverse_i + inverse_j) + 1.0 / (tau * tau));
    multiplier += change;
    add3(u, i, (-inverse_i * change) * r);
    add3(u, j, (inverse_j * change) * r);
  }

  /// Three constraints x − x₀ = 0, one per axis.
  void project_anchor(std::size_t a, double tau) {
    const mechanics::Anchor& anchor = model_.anchors[a];
    const int i = anchor.particle;
    const double inverse = inverse_mass_[static_cast<std::size_t>(i)];
    double* u = displacement_.data();
    const Vec3<double> moved = load3(u, i);
    const double damping = anchor.damping / tau;
    Vec3<double>& multiplier = anchor_multiplier_[a];
    const Vec3<double> change =
        (-1.0 / ((anchor.stiffness + damping) * inverse + 1.0 / (tau * tau))) *
        (anchor.stiffness * mechanics::anchor_offset(anchor, load3(start_.data(), i) + moved) +
         (1.0 / (tau * tau)) * multiplier + damping * moved);
    multiplier += change;
    add3(u, i, inverse * change);
  }

  XpbdOptions options_;
  const mechanics::MassSpringModel& model_;
  Work& work_;
  ExplicitExternalForce external_;
  std::vector<double> inverse_mass_;
  std::vector<double> spring_multiplier_;  ///< λ [kg·m]: the force is −λ/τ² along the spring
  std::vector<Vec3<double>> anchor_multiplier_;
  Vector start_, displacement_, force_;
};

}  // namespace

std::unique_ptr<Integrator> make_xpbd(const XpbdOptions& options) {
  if (options.substeps < 1) {
    throw InputError(
        fmt::format("option substeps: found {}, expected a whole number >= 1", options.substeps));
  }
  if (options.iterations < 1) {
    throw InputError(
        fmt::format("option iterations: found {}, expected a whole number >= 1", options.iterations));
  }
  MethodInfo info{.name = "xpbd",
                  .title = "Extended position-based dynamics (XPBD)",
                  .family = "graphics",
                  .order = 1,
                  .order_with_velocity_forces = 1,
                  .stages = options.substeps,
                  .is_explicit = false,
                  .needs = {Capability::second_order, Capability::springs},
                  .formula =
                      "q' = q + h v + h² M^-1 f_ext;  per spring q' += M^-1 grad C' dl with "
                      "dl = -(C + l/(k h²) + ...)/(grad C M^-1 grad C' + 1/(k h²));  v' = (q' - q)/h",
                  .reference = "[Macklin, Müller, Chentanez 2016; Macklin et al. 2019]"};
  return std::make_unique<FixedStepIntegrator>(
      std::move(info), [options](const Ivp& ivp, double, Work& work) -> std::unique_ptr<Stepper> {
        return std::make_unique<XpbdStepper>(options, require_mass_spring_system(*ivp.system, "xpbd"), work);
      });
}

}  // namespace fw::integrators
