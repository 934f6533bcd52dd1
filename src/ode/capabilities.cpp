#include "ode/capabilities.hpp"

namespace fw {

const std::vector<CapabilityInfo>& capabilities() {
  static const std::vector<CapabilityInfo> list = {
      {Capability::second_order, "second_order", "M q'' = f(t, q, q')",
       "the method needs M q'' = f(t, q, q'), the problem is y' = f(t, y)",
       [](const OdeSystem& system) { return system.second_order() != nullptr; }},
      {Capability::position_forces, "position_forces", "M q'' = f(t, q)",
       "the method needs forces f(t, q), those of the problem depend on velocity",
       [](const OdeSystem& system) {
         return system.second_order() != nullptr &&
                system.second_order()->force_class() == ForceClass::position;
       }},
      {Capability::springs, "springs", "mass-spring systems", "the method needs a mass-spring system",
       [](const OdeSystem& system) {
         return system.second_order() != nullptr && system.second_order()->has_springs();
       }},
      {Capability::force_splitting, "force_splitting", "M q'' = f_stiff + f_soft",
       "the method needs forces in a stiff and a soft part, as a mass-spring system has them",
       [](const OdeSystem& system) {
         return system.second_order() != nullptr && system.second_order()->force_splitting() != nullptr;
       }}};
  return list;
}

std::string why_lacking(Capabilities needs, const OdeSystem& system) {
  for (const CapabilityInfo& info : capabilities()) {
    if (needs.has(info.capability) && !info.is_there(system)) return info.lacking;
  }
  return {};
}

std::string works_on(Capabilities needs) {
  std::string text = "y' = f(t, y)";
  for (const CapabilityInfo& info : capabilities()) {
    if (needs.has(info.capability)) text = info.works_on;
  }
  return text;
}

}  // namespace fw
