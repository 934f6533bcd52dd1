#pragma once

#include <algorithm>
#include <utility>
#include <variant>

#include "mechanics/assembly/block_fill.hpp"
#include "mechanics/assembly/discrete_force.hpp"
#include "mechanics/assembly/element_assembly.hpp"
#include "mechanics/assembly/energy.hpp"
#include "mechanics/assembly/force.hpp"
#include "mechanics/assembly/switch_search.hpp"
#include "mechanics/assembly/tangent_product.hpp"

namespace fw::mechanics {

/// A batch whose elements can be stiffer than one another.
template <class Batch>
concept HasRate = requires(const Batch& batch) {
  batch.rate(std::size_t{0});
};

/// The sums over batches of the types in `Batch`, a std::variant such as `ElementBatch`. A longer list makes
/// the same sums over more types.
template <class Batch>
class AssemblyOf final : public ElementAssembly {
 public:
  /// `fixed`: indices of the particles that never move. Throws InputError that names the first entry of an
  /// element that is out of its range.
  AssemblyOf(std::vector<Batch> batches, std::size_t particles, const std::vector<int>& fixed)
      : batches_(std::move(batches)), particles_(particles), fixed_(fixed), is_fixed_(particles, 0) {
    for (const int i : fixed_) is_fixed_[static_cast<std::size_t>(i)] = 1;
    for_each_batch([&](std::size_t, const auto& batch) { batch.validate(particles_); });
  }

  std::size_t batch_count() const override { return batches_.size(); }
  ElementLabels labels(std::size_t batch) const override {
    return std::visit([](const auto& elements) { return elements.labels; }, batches_[batch]);
  }
  ForceClass force_class() const override {
    return any_of([](const auto& batch) { return batch.force_class() == ForceClass::velocity; })
               ? ForceClass::velocity
               : ForceClass::position;
  }
  ForceClass force_class(std::size_t batch) const override {
    return std::visit([](const auto& elements) { return elements.force_class(); }, batches_[batch]);
  }
  bool has_kinks() const override {
    return any_of([](const auto& batch) { return batch.has_kinks(); });
  }
  bool has_switches() const override {
    return any_of([]<class Elements>(const Elements& batch) {
      if constexpr (HasSwitches<Elements>) return batch.has_kinks() && batch.size() > 0;
      return false;
    });
  }
  void find_switches(const StatePath<double>& path, const std::vector<double>& mass,
                     SwitchSink<double>& sink) const override {
    for_each_switching_batch([&](const auto& batch) { search_switches(batch, {path, mass, is_fixed_}, sink); });
  }
  void find_switches(const StatePath<Float128>& path, const std::vector<double>& mass,
                     SwitchSink<Float128>& sink) const override {
    for_each_switching_batch([&](const auto& batch) { search_switches(batch, {path, mass, is_fixed_}, sink); });
  }
  void find_acting(const double* y, const std::vector<double>& mass, SwitchSink<double>& sink) const override {
    const StatePath<double> standing{0.0, 0.0, y, y};
    for_each_switching_batch(
        [&](const auto& batch) { list_acting(batch, {standing, mass, is_fixed_}, sink); });
  }
  bool is_internal() const override {
    return !any_of([](const auto& batch) { return !batch.is_internal(); });
  }

  std::vector<Cliques> cliques() const override {
    std::vector<Cliques> result(batches_.size());
    for_each_batch([&]<class Elements>(std::size_t k, const Elements& batch) {
      result[k].arity = Elements::arity;
      if (Elements::arity == 1) return;
      result[k].nodes.reserve(batch.size() * static_cast<std::size_t>(Elements::arity));
      for (std::size_t e = 0; e < batch.size(); ++e) {
        for (const int node : batch.nodes(e)) result[k].nodes.push_back(node);
      }
    });
    return result;
  }
  std::vector<std::vector<double>> rates() const override {
    std::vector<std::vector<double>> result(batches_.size());
    for_each_batch([&]<class Elements>(std::size_t k, const Elements& batch) {
      if constexpr (HasRate<Elements>) {
        result[k].reserve(batch.size());
        for (std::size_t e = 0; e < batch.size(); ++e) result[k].push_back(batch.rate(e));
      }
    });
    return result;
  }

  std::uint64_t force(const double* q, const double* v, double* f) const override { return sum(q, v, f); }
  std::uint64_t force(const Float128* q, const Float128* v, Float128* f) const override {
    return sum(q, v, f);
  }
  std::uint64_t force(const Complex* q, const Complex* v, Complex* f) const override { return sum(q, v, f); }
  std::uint64_t force(const ElementChoice& choice, const double* q, const double* v,
                      double* f) const override {
    std::fill_n(f, 3 * particles_, 0.0);
    std::uint64_t degenerate = 0;
    for_each_batch(
        [&](std::size_t k, const auto& batch) { degenerate += add_force(batch, choice[k], q, v, f); });
    clear_fixed(f);
    return degenerate;
  }

  void add_energies(const double* q, Energies& energies) const override {
    for_each_batch([&]<class Elements>(std::size_t, const Elements& batch) {
      add_energy(batch, q, energies.at(Elements::labels.energy));
    });
  }
  double dissipated_power(const double* q, const double* v, std::uint64_t& degenerate) const override {
    double power = 0.0;
    for_each_batch(
        [&](std::size_t, const auto& batch) { degenerate += add_dissipated_power(batch, q, v, power); });
    return power;
  }

  std::uint64_t tangent_product(const double* q, const double* v, const double* dq, const double* dv,
                                double* out) const override {
    std::fill_n(out, 3 * particles_, 0.0);
    std::uint64_t degenerate = 0;
    for_each_batch(
        [&](std::size_t, const auto& batch) { degenerate += add_tangent_product(batch, q, v, dq, dv, out); });
    clear_fixed(out);
    return degenerate;
  }
  std::uint64_t fill_stiffness(const ElementChoice* choice, const BlockPattern& pattern, const double* q,
                               const double* v, TangentModel model, double* values) const override {
    return fill_tangent(choice, pattern, q, v, model, values,
                        [](const auto& tangent) { return tangent.position_blocks(); });
  }
  std::uint64_t fill_damping(const ElementChoice* choice, const BlockPattern& pattern, const double* q,
                             const double* v, double* values) const override {
    return fill_tangent(choice, pattern, q, v, TangentModel::exact, values,
                        [](const auto& tangent) { return tangent.velocity_blocks(); });
  }
  std::uint64_t fill_jacobian(const BlockPattern& pattern, const std::vector<double>& mass, const double* q,
                              const double* v, double* values) const override {
    std::uint64_t degenerate = 0;
    for_each_batch([&](std::size_t k, const auto& batch) {
      degenerate += fill_blocks(
          batch, nullptr, {pattern, is_fixed_, k}, q, v, TangentModel::exact,
          [](const auto& tangent) { return std::pair(tangent.position_blocks(), tangent.velocity_blocks()); },
          [&](BlockSlot slot, int i, int j, int a, int b, const auto& blocks) {
            const double inverse_mass = 1.0 / mass[static_cast<std::size_t>(i)];
            add_block(values, pattern.jacobian_position(slot, j), inverse_mass, blocks.first, a, b);
            add_block(values, pattern.jacobian_velocity(slot, j), inverse_mass, blocks.second, a, b);
          });
    });
    return degenerate;
  }

  void discrete_force(const DiscreteStep& step, double* f) const override {
    std::fill_n(f, 3 * particles_, 0.0);
    for_each_batch([&](std::size_t, const auto& batch) { add_discrete_force(batch, step, f); });
    clear_fixed(f);
  }
  void fill_discrete(const BlockPattern& pattern, const DiscreteStep& step, const DiscreteWeights& weights,
                     double* values) const override {
    for_each_batch([&](std::size_t k, const auto& batch) {
      fill_discrete_blocks(batch, {pattern, is_fixed_, k}, step, weights, values);
    });
  }

 private:
  template <class Visit>
  void for_each_batch(Visit visit) const {
    for (std::size_t k = 0; k < batches_.size(); ++k) {
      std::visit([&](const auto& batch) { visit(k, batch); }, batches_[k]);
    }
  }
  template <class Visit>
  void for_each_switching_batch(Visit visit) const {
    for_each_batch([&]<class Elements>(std::size_t, const Elements& batch) {
      if constexpr (HasSwitches<Elements>) visit(batch);
    });
  }
  template <class Holds>
  bool any_of(Holds holds) const {
    return std::ranges::any_of(batches_, [&](const Batch& batch) { return std::visit(holds, batch); });
  }
  template <class Scalar>
  void clear_fixed(Scalar* f) const {
    for (const int i : fixed_) store3(f, i, Vec3<Scalar>{});
  }
  template <class Scalar>
  std::uint64_t sum(const Scalar* q, const Scalar* v, Scalar* f) const {
    std::fill_n(f, 3 * particles_, Scalar(0));
    std::uint64_t degenerate = 0;
    for_each_batch([&](std::size_t, const auto& batch) { degenerate += add_force(batch, q, v, f); });
    clear_fixed(f);
    return degenerate;
  }
  template <class Select>
  std::uint64_t fill_tangent(const ElementChoice* choice, const BlockPattern& pattern, const double* q,
                             const double* v, TangentModel model, double* values, Select select) const {
    std::fill_n(values, pattern.tangent_nonzeros(), 0.0);
    std::uint64_t degenerate = 0;
    for_each_batch([&](std::size_t k, const auto& batch) {
      const BatchChoice* chosen = choice != nullptr ? &(*choice)[k] : nullptr;
      degenerate += fill_blocks(batch, chosen, {pattern, is_fixed_, k}, q, v, model, select,
                                [&](BlockSlot slot, int, int, int a, int b, const auto& blocks) {
                                  add_block(values, slot, 1.0, blocks, a, b);
                                });
    });
    return degenerate;
  }

  std::vector<Batch> batches_;
  std::size_t particles_;
  std::vector<int> fixed_;
  std::vector<char> is_fixed_;  ///< one flag per particle
};

}  // namespace fw::mechanics
