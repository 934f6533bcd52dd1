#pragma once

#include <initializer_list>
#include <string>
#include <vector>

#include "ode/ode_system.hpp"

namespace fw {

/// What a system can have beside ẏ = f(t, y), and a scheme may need.
enum class Capability : unsigned {
  second_order,     ///< M q̈ = f(t, q, v)
  position_forces,  ///< f = f(t, q) only
  springs,          ///< a mass-spring system
  force_splitting,  ///< forces in a stiff and a soft part
};

/// A set of capabilities.
class Capabilities {
 public:
  constexpr Capabilities() = default;
  constexpr Capabilities(std::initializer_list<Capability> list) {
    for (const Capability capability : list) add(capability);
  }

  constexpr bool has(Capability capability) const { return (bits_ & bit(capability)) != 0; }
  constexpr void add(Capability capability) { bits_ |= bit(capability); }
  friend constexpr bool operator==(Capabilities, Capabilities) = default;

 private:
  static constexpr unsigned bit(Capability capability) { return 1u << static_cast<unsigned>(capability); }
  unsigned bits_ = 0;
};

/// What is known of a capability: the only place where one is registered.
struct CapabilityInfo {
  Capability capability;
  std::string name;      ///< for programs, for example "force_splitting"
  std::string works_on;  ///< for people: the systems that have it
  std::string lacking;   ///< why a scheme that needs it cannot run on a system without, as a clause
  bool (*is_there)(const OdeSystem& system);
};

/// Every capability, from the most general to the most special.
const std::vector<CapabilityInfo>& capabilities();

/// Why `system` does not do for a scheme with these needs, as a clause ("the method needs ..."); empty if it
/// does. The first capability of the list that is lacking decides.
std::string why_lacking(Capabilities needs, const OdeSystem& system);

/// The systems that a scheme with these needs works on, for people: "mass-spring systems".
std::string works_on(Capabilities needs);

}  // namespace fw
