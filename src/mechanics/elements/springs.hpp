#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "mechanics/elements/spring_law.hpp"

namespace fw::mechanics {

/// The numbers of one spring; see `Springs` for their units.
struct SpringParameters {
  double stiffness = 0.0;    ///< k_s
  double damping = 0.0;      ///< k_d
  double rest_length = 0.0;  ///< l₀
};

/// Springs one after the other that share a law.
struct SpringGroup {
  std::string name;                  ///< for people and files; may be empty
  SpringLaw law = SpringLaw::hooke;  ///< one law for all, so that kernels do not branch per spring
  std::size_t size = 0;              ///< how many springs
};

/// Springs as a structure of arrays, one entry per spring: four arrays stream through a force kernel without
/// gaps, and a kernel may permute them (slices of four owner vertices) without touching the law.
struct Springs {
  std::vector<int> first;            ///< i
  std::vector<int> second;           ///< j
  std::vector<double> stiffness;     ///< k_s [N/m], or [N] under SpringLaw::strain
  std::vector<double> damping;       ///< k_d [N·s/m]
  std::vector<double> rest_length;   ///< l₀ [m]
  SpringLaw law = SpringLaw::hooke;  ///< of all springs where `groups` is empty; of no meaning otherwise
  /// Groups with laws of their own, in the order of the springs; their sizes add up to `size()`. Empty: all
  /// springs are one group without a name.
  std::vector<SpringGroup> groups{};

  std::size_t size() const { return first.size(); }

  /// Adds a spring between particles i and j. The groups, if there are any, stay as they are.
  void add(int i, int j, const SpringParameters& spring) {
    first.push_back(i);
    second.push_back(j);
    stiffness.push_back(spring.stiffness);
    damping.push_back(spring.damping);
    rest_length.push_back(spring.rest_length);
  }

  /// The law of spring e.
  SpringLaw law_of(std::size_t e) const {
    SpringLaw result = law;
    for_each_group([&](const SpringGroup& group, std::size_t begin) {
      if (e >= begin && e < begin + group.size) result = group.law;
    });
    return result;
  }

  /// Calls `visit(group, begin)` for each group in order; `begin` is the number of its first spring. The
  /// springs of a group are numbered [begin, begin + group.size).
  template <class Visit>
  void for_each_group(Visit visit) const {
    if (groups.empty()) {
      visit(SpringGroup{{}, law, size()}, std::size_t{0});
      return;
    }
    std::size_t begin = 0;
    for (const SpringGroup& group : groups) {
      visit(group, begin);
      begin += group.size;
    }
  }
};

/// The numbers of spring `e`.
inline SpringParameters spring_parameters(const Springs& springs, std::size_t e) {
  return {springs.stiffness[e], springs.damping[e], springs.rest_length[e]};
}

}  // namespace fw::mechanics
