#include "mechanics/mass_spring_system.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/error.hpp"
#include "mechanics/mass_spring_energy.hpp"
#include "mechanics/mass_spring_force.hpp"
#include "mechanics/mass_spring_tangent.hpp"
#include "mechanics/model_validation.hpp"
#include "mechanics/tangent_fill.hpp"

namespace fw::mechanics {

namespace {

ForceClass classify(const MassSpringModel& model) {
  const auto damps = [](const auto& element) { return element.damping > 0.0; };
  const bool velocity =
      model.drag > 0.0 || std::ranges::any_of(model.springs.damping, [](double c) { return c > 0.0; }) ||
      std::ranges::any_of(model.anchors, damps) || std::ranges::any_of(model.obstacles, damps);
  return velocity ? ForceClass::velocity : ForceClass::position;
}

MassSpringModel validated(MassSpringModel model) {
  validate(model);
  return model;
}

/// Fills the lower half [M⁻¹K, M⁻¹D] of the Jacobian.
struct JacobianFill {
  const BlockPattern& pattern;
  const std::vector<char>& fixed;
  const std::vector<double>& mass;
  double* values;

  void add(BlockSlot slot, int column, double factor, const Matrix3& k, const Matrix3& d) const {
    add_block(values, pattern.jacobian_position(slot, column), factor, k);
    add_block(values, pattern.jacobian_velocity(slot, column), factor, d);
  }
  void point(int i, const auto& tangent) const {
    const auto row = static_cast<std::size_t>(i);
    if (fixed[3 * row] != 0) return;
    add(pattern.diagonal(i), i, 1.0 / mass[row], tangent.position_block(), tangent.velocity_block());
  }
  void pair(std::size_t e, int i, int j, const CentralForceTangent& tangent) const {
    const Matrix3 k = tangent.position_block();
    const Matrix3 d = tangent.velocity_block();
    if (const auto row = static_cast<std::size_t>(i); fixed[3 * row] == 0) {
      add(pattern.diagonal(i), i, -1.0 / mass[row], k, d);
      add(pattern.upper(e, j), j, 1.0 / mass[row], k, d);
    }
    if (const auto row = static_cast<std::size_t>(j); fixed[3 * row] == 0) {
      add(pattern.diagonal(j), j, -1.0 / mass[row], k, d);
      add(pattern.lower(e, i), i, 1.0 / mass[row], k, d);
    }
  }
};

/// Adds K·dq + D·dv to `out`.
struct TangentProduct {
  const double* dq;
  const double* dv;
  double* out;

  void point(int i, const auto& tangent) const { add3(out, i, tangent.product(load3(dq, i), load3(dv, i))); }
  void pair(std::size_t, int i, int j, const CentralForceTangent& tangent) const {
    const Vec3<double> df = tangent.product(load3(dq, j) - load3(dq, i), load3(dv, j) - load3(dv, i));
    add3(out, i, df);
    add3(out, j, -df);
  }
};

/// Writes K·dq + D·dv into `out`, fixed rows zero; returns how many springs had no direction.
std::uint64_t multiply_tangent(const MassSpringModel& model, const double* q, const double* v,
                               const double* dq, const double* dv, double* out) {
  std::fill_n(out, 3 * model.mass.size(), 0.0);
  const std::uint64_t degenerate =
      visit_tangents(model, q, v, TangentModel::exact, TangentProduct{dq, dv, out});
  for (const int i : model.fixed) store3(out, i, Vec3<double>{});
  return degenerate;
}

}  // namespace

MassSpringSystem::MassSpringSystem(MassSpringModel model)
    : model_(validated(std::move(model))), force_class_(classify(model_)) {
  mass_.resize(3 * particle_count());
  for (Index c = 0; c < mass_.size(); ++c) mass_[c] = model_.mass[static_cast<std::size_t>(c / 3)];
  fixed_.assign(3 * model_.mass.size(), 0);
  for (const int i : model_.fixed) std::fill_n(fixed_.begin() + 3 * static_cast<std::ptrdiff_t>(i), 3, 1);
}

MassSpringSystem::~MassSpringSystem() = default;

const BlockPattern& MassSpringSystem::pattern() const {
  std::call_once(pattern_once_, [this] {
    pattern_ = std::make_unique<const BlockPattern>(static_cast<int>(particle_count()), model_.springs.first,
                                                    model_.springs.second);
  });
  return *pattern_;
}

Index MassSpringSystem::size() const {
  return 6 * particle_count();
}

template <class Scalar>
void MassSpringSystem::evaluate_rhs(const Scalar* y, Scalar* dydt) const {
  const std::size_t particles = model_.mass.size();
  const std::size_t n = 3 * particles;
  std::copy_n(y + n, n, dydt);
  for (const int i : model_.fixed) store3(dydt, i, Vec3<Scalar>{});
  Scalar* acceleration = dydt + n;
  count_degenerate(mass_spring_force(model_, y, y + n, acceleration));
  for (std::size_t i = 0; i < particles; ++i) {
    for (std::size_t a = 0; a < 3; ++a) acceleration[3 * i + a] /= model_.mass[i];
  }
}

void MassSpringSystem::rhs(double, ConstVectorRef y, VectorRef dydt) const {
  evaluate_rhs(y.data(), dydt.data());
}

void MassSpringSystem::rhs(const Float128&, std::span<const Float128> y, std::span<Float128> dydt) const {
  evaluate_rhs(y.data(), dydt.data());
}

void MassSpringSystem::rhs(double, std::span<const Complex> y, std::span<Complex> dydt) const {
  evaluate_rhs(y.data(), dydt.data());
}

SparseMatrix MassSpringSystem::jacobian_pattern() const {
  return pattern().jacobian();
}

void MassSpringSystem::jacobian(double, ConstVectorRef y, SparseMatrix& J) const {
  const BlockPattern& blocks = pattern();
  require_pattern(J, size(), blocks.jacobian_nonzeros(), "J");
  double* values = J.valuePtr();
  std::fill_n(values, J.nonZeros(), 0.0);
  const Index n = degrees_of_freedom();
  for (Index c = 0; c < n; ++c) {
    if (fixed_[static_cast<std::size_t>(c)] == 0) values[blocks.jacobian_unit(c)] = 1.0;
  }
  count_degenerate(visit_tangents(model_, y.data(), y.data() + n, TangentModel::exact,
                                  JacobianFill{blocks, fixed_, model_.mass, values}));
}

void MassSpringSystem::jacobian_product(double, ConstVectorRef y, ConstVectorRef w, VectorRef out) const {
  const Index n = degrees_of_freedom();
  count_degenerate(multiply_tangent(model_, y.data(), y.data() + n, w.data(), w.data() + n, out.data() + n));
  out.tail(n).array() /= mass_.array();
  out.head(n) = w.tail(n);
  for (const int i : model_.fixed) store3(out.data(), i, Vec3<double>{});
}

Index MassSpringSystem::degrees_of_freedom() const {
  return mass_.size();
}

void MassSpringSystem::force(double, ConstVectorRef q, ConstVectorRef v, VectorRef f) const {
  count_degenerate(mass_spring_force(model_, q.data(), v.data(), f.data()));
}

SparseMatrix MassSpringSystem::tangent_pattern() const {
  return pattern().tangent();
}

void MassSpringSystem::require_tangent(const SparseMatrix& matrix, const char* name) const {
  require_pattern(matrix, degrees_of_freedom(), pattern().tangent_nonzeros(), name);
}

void MassSpringSystem::stiffness(double, ConstVectorRef q, ConstVectorRef v, TangentModel model,
                                 SparseMatrix& K) const {
  require_tangent(K, "K");
  std::fill_n(K.valuePtr(), K.nonZeros(), 0.0);
  const auto block = [](const auto& tangent) { return tangent.position_block(); };
  count_degenerate(visit_tangents(model_, q.data(), v.data(), model,
                                  TangentFill<decltype(block)>{pattern(), fixed_, K.valuePtr(), block}));
}

void MassSpringSystem::damping(double, ConstVectorRef q, ConstVectorRef v, SparseMatrix& D) const {
  require_tangent(D, "D");
  std::fill_n(D.valuePtr(), D.nonZeros(), 0.0);
  const auto block = [](const auto& tangent) { return tangent.velocity_block(); };
  count_degenerate(visit_tangents(model_, q.data(), v.data(), TangentModel::exact,
                                  TangentFill<decltype(block)>{pattern(), fixed_, D.valuePtr(), block}));
}

void MassSpringSystem::tangent_product(double, ConstVectorRef q, ConstVectorRef v, ConstVectorRef dq,
                                       ConstVectorRef dv, VectorRef out) const {
  count_degenerate(multiply_tangent(model_, q.data(), v.data(), dq.data(), dv.data(), out.data()));
}

const ForceSplitting* MassSpringSystem::force_splitting() const {
  std::call_once(splitting_once_, [this] {
    if (SpringSplitting::is_possible(model_)) {
      splitting_ = std::make_unique<const SpringSplitting>(model_, pattern(), fixed_, degenerate_);
    }
  });
  return splitting_.get();
}

Energies MassSpringSystem::energies(ConstVectorRef q, ConstVectorRef v) const {
  return {kinetic_energy(model_, v.data()), elastic_energy(model_, q.data()),
          gravitational_energy(model_, q.data()), obstacle_energy(model_, q.data())};
}

Vec3<double> MassSpringSystem::linear_momentum(ConstVectorRef v) const {
  Vec3<double> momentum;
  for (Index i = 0; i < particle_count(); ++i) momentum += mass_[3 * i] * load3(v.data(), i);
  return momentum;
}

Vec3<double> MassSpringSystem::angular_momentum(ConstVectorRef q, ConstVectorRef v) const {
  Vec3<double> momentum;
  for (Index i = 0; i < particle_count(); ++i) {
    momentum += mass_[3 * i] * cross(load3(q.data(), i), load3(v.data(), i));
  }
  return momentum;
}

double MassSpringSystem::dissipated_power(ConstVectorRef q, ConstVectorRef v) const {
  const Springs& springs = model_.springs;
  double power = model_.drag * v.squaredNorm();
  std::uint64_t degenerate = 0;
  for (std::size_t e = 0; e < springs.size(); ++e) {
    const int i = springs.first[e];
    const int j = springs.second[e];
    power += spring_dissipated_power(spring_parameters(springs, e), load3(q.data(), j) - load3(q.data(), i),
                                     load3(v.data(), j) - load3(v.data(), i), degenerate);
  }
  count_degenerate(degenerate);
  for (const Anchor& anchor : model_.anchors) {
    const Vec3<double> velocity = load3(v.data(), anchor.particle);
    power += anchor.damping * dot(velocity, velocity);
  }
  for (const Obstacle& obstacle : model_.obstacles) {
    std::visit(
        [&](const auto& shape) {
          for (Index i = 0; i < particle_count(); ++i) {
            power += obstacle_dissipated_power(obstacle, shape, load3(q.data(), i), load3(v.data(), i));
          }
        },
        obstacle.shape);
  }
  return power;
}

}  // namespace fw::mechanics
