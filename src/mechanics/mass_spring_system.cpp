#include "mechanics/mass_spring_system.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/error.hpp"
#include "mechanics/driving.hpp"
#include "mechanics/model_elements.hpp"
#include "mechanics/model_validation.hpp"

namespace fw::mechanics {

namespace {

/// The switches of a system's elements.
class ElementSurfaces final : public SwitchingSurfaces {
 public:
  explicit ElementSurfaces(const MassSpringSystem& system) : system_(system) {}

  void find(const StatePath<double>& path, SwitchSink<double>& sink) const override {
    system_.elements().find_switches(path, system_.model().mass, sink);
    if (system_.driving() != nullptr) system_.driving()->find_corners(path, sink);
  }
  void find(const StatePath<Float128>& path, SwitchSink<Float128>& sink) const override {
    system_.elements().find_switches(path, system_.model().mass, sink);
    if (system_.driving() != nullptr) system_.driving()->find_corners(path, sink);
  }
  void acting(const double* y, SwitchSink<double>& sink) const override {
    system_.elements().find_acting(y, system_.model().mass, sink);
  }

 private:
  const MassSpringSystem& system_;
};

MassSpringModel validated(MassSpringModel model) {
  validate_particles(model);
  return model;
}

}  // namespace

MassSpringSystem::MassSpringSystem(MassSpringModel model, SystemParts parts)
    : model_(validated(std::move(model))), parts_(std::move(parts)) {
  mass_.resize(3 * particle_count());
  for (Index c = 0; c < mass_.size(); ++c) mass_[c] = model_.mass[static_cast<std::size_t>(c / 3)];
  fixed_.assign(3 * model_.mass.size(), 0);
  for (const int i : model_.fixed) std::fill_n(fixed_.begin() + 3 * static_cast<std::ptrdiff_t>(i), 3, 1);
  make_elements();
  derived_ = std::make_unique<Derived>();
  surfaces_ = std::make_unique<const ElementSurfaces>(*this);
}

MassSpringSystem::~MassSpringSystem() = default;

void MassSpringSystem::make_elements() {
  auto elements = parts_.elements ? parts_.elements(model_) : assemble<ElementBatch>(model_);
  auto kernel = parts_.kernel ? parts_.kernel(model_) : nullptr;
  auto driving = Driving::is_needed(model_) ? std::make_shared<const Driving>(model_) : nullptr;
  elements_ = std::move(elements);
  kernel_ = std::move(kernel);
  driving_ = std::move(driving);
  force_class_ = elements_->force_class();
}

void MassSpringSystem::change_elements(MassSpringModel model) {
  if (model.mass != model_.mass || model.fixed != model_.fixed) {
    throw InputError(fmt::format(
        "a change of elements: found other particles ({} masses, {} fixed), expected the {} masses "
        "and {} fixed particles of the system",
        model.mass.size(), model.fixed.size(), model_.mass.size(), model_.fixed.size()));
  }
  std::swap(model_, model);
  try {
    make_elements();
  } catch (...) {
    std::swap(model_, model);
    throw;
  }
  ++element_revision_;
  const std::unique_ptr<Derived> before = std::exchange(derived_, std::make_unique<Derived>());
  // A pattern that nobody has seen needs no comparison.
  ++pattern_revision_;
  if (before->pattern != nullptr && block_pattern().has_same_blocks(*before->pattern)) {
    --pattern_revision_;
    derived_ = std::make_unique<Derived>();
  }
  if (before->splitting != nullptr) {
    before->splitting->split(*elements_, block_pattern(), driving_);
    std::call_once(derived_->splitting_once, [&] { derived_->splitting = std::move(before->splitting); });
  }
}

const BlockPattern& MassSpringSystem::block_pattern() const {
  std::call_once(derived_->pattern_once, [this] {
    derived_->pattern = std::make_unique<const BlockPattern>(static_cast<int>(particle_count()),
                                                             elements_->cliques(), pattern_revision_);
  });
  return *derived_->pattern;
}

Index MassSpringSystem::size() const {
  return 6 * particle_count();
}

template <class Time, class Scalar>
void MassSpringSystem::evaluate_force(const Time& t, const Scalar* q, const Scalar* v, Scalar* f) const {
  count_degenerate(evaluate_elements(q, v, f));
  if (driving_ != nullptr) driving_->add_force(t, f);
}

template <class Time, class Scalar>
void MassSpringSystem::evaluate_rhs(const Time& t, const Scalar* y, Scalar* dydt) const {
  const std::size_t particles = model_.mass.size();
  const std::size_t n = 3 * particles;
  std::copy_n(y + n, n, dydt);
  for (const int i : model_.fixed) store3(dydt, i, Vec3<Scalar>{});
  Scalar* acceleration = dydt + n;
  evaluate_force(t, y, y + n, acceleration);
  for (std::size_t i = 0; i < particles; ++i) {
    for (std::size_t a = 0; a < 3; ++a) acceleration[3 * i + a] /= model_.mass[i];
  }
}

void MassSpringSystem::rhs(double t, ConstVectorRef y, VectorRef dydt) const {
  evaluate_rhs(t, y.data(), dydt.data());
}

void MassSpringSystem::rhs(const Float128& t, std::span<const Float128> y, std::span<Float128> dydt) const {
  evaluate_rhs(t, y.data(), dydt.data());
}

void MassSpringSystem::rhs(double t, std::span<const Complex> y, std::span<Complex> dydt) const {
  evaluate_rhs(t, y.data(), dydt.data());
}

SparseMatrix MassSpringSystem::jacobian_pattern() const {
  return block_pattern().jacobian();
}

void MassSpringSystem::jacobian(double, ConstVectorRef y, SparseMatrix& J) const {
  const BlockPattern& blocks = block_pattern();
  blocks.require_jacobian(J, "J");
  double* values = J.valuePtr();
  std::fill_n(values, J.nonZeros(), 0.0);
  const auto n = static_cast<int>(degrees_of_freedom());
  for (int c = 0; c < n; ++c) {
    if (fixed_[static_cast<std::size_t>(c)] == 0) values[blocks.jacobian_unit(c)] = 1.0;
  }
  count_degenerate(elements_->fill_jacobian(blocks, model_.mass, y.data(), y.data() + n, values));
}

void MassSpringSystem::jacobian_product(double t, ConstVectorRef y, ConstVectorRef w, VectorRef out) const {
  first_order_product(*this, t, y, w, out);
}

const SwitchingSurfaces* MassSpringSystem::switching_surfaces() const {
  const bool has_any = elements_->has_switches() || (driving_ != nullptr && driving_->has_corners());
  return has_any ? surfaces_.get() : nullptr;
}

Index MassSpringSystem::degrees_of_freedom() const {
  return mass_.size();
}

void MassSpringSystem::force(double t, ConstVectorRef q, ConstVectorRef v, VectorRef f) const {
  evaluate_force(t, q.data(), v.data(), f.data());
}

SparseMatrix MassSpringSystem::tangent_pattern() const {
  return block_pattern().tangent();
}

void MassSpringSystem::stiffness(double, ConstVectorRef q, ConstVectorRef v, TangentModel model,
                                 SparseMatrix& K) const {
  block_pattern().require_tangent(K, "K");
  count_degenerate(
      elements_->fill_stiffness(nullptr, block_pattern(), q.data(), v.data(), model, K.valuePtr()));
}

void MassSpringSystem::damping(double, ConstVectorRef q, ConstVectorRef v, SparseMatrix& D) const {
  block_pattern().require_tangent(D, "D");
  count_degenerate(elements_->fill_damping(nullptr, block_pattern(), q.data(), v.data(), D.valuePtr()));
}

void MassSpringSystem::tangent_product(double, ConstVectorRef q, ConstVectorRef v, ConstVectorRef dq,
                                       ConstVectorRef dv, VectorRef out) const {
  count_degenerate(elements_->tangent_product(q.data(), v.data(), dq.data(), dv.data(), out.data()));
}

const ForceSplitting* MassSpringSystem::force_splitting() const {
  std::call_once(derived_->splitting_once, [this] {
    if (SpringSplitting::is_possible(*elements_)) {
      derived_->splitting =
          std::make_unique<SpringSplitting>(*elements_, block_pattern(), degenerate_, driving_);
    }
  });
  return derived_->splitting.get();
}

bool MassSpringSystem::is_smooth() const {
  return !elements_->has_kinks() && (driving_ == nullptr || driving_->is_smooth());
}

void MassSpringSystem::add_driving_force(double t, VectorRef f) const {
  if (driving_ != nullptr) driving_->add_force(t, f.data());
}

Energies MassSpringSystem::energies(double t, ConstVectorRef q, ConstVectorRef v) const {
  Energies energies;
  double& kinetic = energies.at("kinetic");
  for (Index i = 0; i < particle_count(); ++i) {
    const Vec3<double> velocity = load3(v.data(), i);
    kinetic += 0.5 * mass_[3 * i] * dot(velocity, velocity);
  }
  elements_->add_energies(q.data(), energies);
  if (driving_ != nullptr && driving_->moves_supports()) {
    energies.at("elastic") += driving_->energy_of_motion(t, q.data());
  }
  return energies;
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

double MassSpringSystem::dissipated_power(double t, ConstVectorRef q, ConstVectorRef v) const {
  std::uint64_t degenerate = 0;
  const double power = elements_->dissipated_power(q.data(), v.data(), degenerate);
  count_degenerate(degenerate);
  return driving_ != nullptr ? power + driving_->dissipation_of_motion(t, v.data()) : power;
}

double MassSpringSystem::external_power(double t, ConstVectorRef q, ConstVectorRef v) const {
  return driving_ != nullptr ? driving_->external_power(t, q.data(), v.data()) : 0.0;
}

}  // namespace fw::mechanics
