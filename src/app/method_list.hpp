#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "catalog/methods.hpp"

namespace fw::app {

/// Which methods a user asks for; what is not set asks nothing.
struct MethodFilter {
  bool only_oracles = false;
  std::string family{};        ///< a part of the family's name, in any case of letters
  std::optional<int> order{};  ///< on systems without forces that depend on velocities
  std::optional<bool> is_explicit{};
  std::optional<bool> is_adaptive{};  ///< true: can choose its steps; false: can take constant ones
  bool symplectic = false, a_stable = false, l_stable = false;

  /// Whether anything but `only_oracles` is asked.
  bool asks() const;
  bool takes(const MethodInfo& info) const;
};

/// The methods that the filter takes, in the order of the catalogue. Throws InputError where it names a family that
/// no method has.
std::vector<const catalog::MethodEntry*> chosen_methods(const MethodFilter& filter);

/// Where to start, the families with their sizes, orders and first names, and how to see more.
std::string methods_overview(std::size_t width);

/// A row per method and their number, for a terminal.
std::string methods_table(const std::vector<const catalog::MethodEntry*>& methods, std::size_t width);

/// An array with an object per method.
std::string methods_json(const std::vector<const catalog::MethodEntry*>& methods);

}  // namespace fw::app
