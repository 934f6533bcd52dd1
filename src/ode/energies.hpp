#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <string_view>

namespace fw {

/// A number with its name and SI unit; the texts are literals.
struct NamedValue {
  std::string_view name;
  std::string_view unit;
  double value = 0.0;
};

/// The energies of a state by name [J]. Four are always there, in this order: "kinetic" ½ Σ m v², "elastic"
/// (springs and anchors), "gravitational" −Σ m g·x, "obstacle" Σ ½ k δ²; force elements may add others after
/// them. All but the kinetic energy are potential energies. Nothing is allocated.
class Energies {
 public:
  /// How many names there can be.
  static constexpr std::size_t most = 16;

  Energies() : entries_{{{"kinetic", "J"}, {"elastic", "J"}, {"gravitational", "J"}, {"obstacle", "J"}}} {}

  /// The energy of this name, a literal; it begins at zero where the name is new. Throws std::length_error
  /// where there are too many names.
  double& at(std::string_view name) {
    for (std::size_t k = 0; k < count_; ++k) {
      if (entries_[k].name == name) return entries_[k].value;
    }
    if (count_ == most) throw std::length_error("more names of energies than Energies::most");
    entries_[count_] = {name, "J"};
    return entries_[count_++].value;
  }
  /// The energy of this name, zero where there is none.
  double operator[](std::string_view name) const {
    for (const NamedValue& entry : list()) {
      if (entry.name == name) return entry.value;
    }
    return 0.0;
  }

  double kinetic() const { return entries_[0].value; }
  /// The sum of all but the kinetic energy, in the order of the list.
  double potential() const {
    double sum = entries_[1].value;
    for (const NamedValue& entry : list().subspan(2)) sum += entry.value;
    return sum;
  }
  double total() const { return kinetic() + potential(); }

  std::span<const NamedValue> list() const { return {entries_.data(), count_}; }

 private:
  std::array<NamedValue, most> entries_;
  std::size_t count_ = 4;
};

}  // namespace fw
