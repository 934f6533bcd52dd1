#include "analysis/theory/modified_energy.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

namespace fw::analysis {

namespace {

bool has_coefficients(const schemes::SplittingScheme& scheme, const schemes::CoefficientRow& drift,
                      const schemes::CoefficientRow& kick) {
  const auto same = [](const schemes::CoefficientRow& a, const schemes::CoefficientRow& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const auto& x, const auto& y) { return x.value() == y.value(); });
  };
  return same(scheme.drift, drift) && same(scheme.kick, kick);
}

}  // namespace

bool is_linear_oscillation(const OdeSystem& system) {
  const SecondOrderSystem* mechanics = system.second_order();
  if (mechanics == nullptr || mechanics->force_class() != ForceClass::position) return false;
  const Index n = mechanics->degrees_of_freedom();
  const Vector v = Vector::Zero(n);
  // Two states without pattern, and their sum.
  const Vector q1 = Vector::LinSpaced(n, 1.0, 2.0).array().sin(),
               q2 = Vector::LinSpaced(n, 3.0, 7.0).array().cos();
  Vector f1(n), f2(n), sum(n);
  mechanics->force(0.0, q1, v, f1);
  mechanics->force(1.7, q2, v, f2);
  mechanics->force(0.3, q1 + q2, v, sum);
  const double scale = f1.norm() + f2.norm() + sum.norm();
  const bool additive = (f1 + f2 - sum).norm() <= 1e-13 * scale;
  const bool symmetric = std::abs(f1.dot(q2) - f2.dot(q1)) <= 1e-13 * scale * (q1.norm() + q2.norm());
  return scale > 0.0 && additive && symmetric;
}

EnergyFunction velocity_verlet_energy(const Ivp& ivp, double h, EnergyFunction energy) {
  const SecondOrderSystem& mechanics = *ivp.system->second_order();
  const Index n = mechanics.degrees_of_freedom();
  const auto force = std::make_shared<Vector>(n);  // reused from call to call
  return [=, &mechanics, system = ivp.system](double t, ConstVectorRef y) {
    mechanics.force(t, y.head(n), y.tail(n), *force);
    return energy(t, y) - 0.125 * h * h * force->cwiseAbs2().cwiseQuotient(mechanics.mass()).sum();
  };
}

EnergyFunction symplectic_euler_energy(const Ivp& ivp, double h, EnergyFunction energy) {
  const SecondOrderSystem& mechanics = *ivp.system->second_order();
  const Index n = mechanics.degrees_of_freedom();
  const auto force = std::make_shared<Vector>(n);
  return [=, &mechanics, system = ivp.system](double t, ConstVectorRef y) {
    mechanics.force(t, y.head(n), y.tail(n), *force);
    return energy(t, y) + 0.5 * h * force->dot(y.tail(n));
  };
}

ModifiedEnergyRule modified_energy_rule(const schemes::SchemeData& data) {
  const auto* splitting = std::get_if<schemes::SplittingScheme>(&data);
  if (splitting == nullptr) return nullptr;
  if (has_coefficients(*splitting, {0, 1, 0}, {"1/2", "1/2"})) return velocity_verlet_energy;
  if (has_coefficients(*splitting, {0, 1}, {1})) return symplectic_euler_energy;
  return nullptr;
}

EnergyFunction modified_energy(ModifiedEnergyRule rule, const Ivp& ivp, double h, EnergyFunction energy) {
  if (rule == nullptr || !is_linear_oscillation(*ivp.system)) return {};
  return rule(ivp, h, std::move(energy));
}

}  // namespace fw::analysis
