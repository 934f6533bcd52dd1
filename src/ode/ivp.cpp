#include "ode/ivp.hpp"

namespace fw {

std::vector<Float128> initial_state_extended(const Ivp& ivp) {
  if (!ivp.y0_extended.empty()) return ivp.y0_extended;
  return {ivp.y0.data(), ivp.y0.data() + ivp.y0.size()};
}

}  // namespace fw
