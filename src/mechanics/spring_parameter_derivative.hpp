#pragma once

#include <vector>

#include "core/types.hpp"
#include "mechanics/mass_spring_model.hpp"

namespace fw::mechanics {

/// A number that every spring has.
enum class SpringParameter {
  stiffness,    ///< k_s [N/m], [N] under SpringLaw::strain
  damping,      ///< k_d [N·s/m]
  rest_length,  ///< l₀ [m]
};

/// One parameter p of a family of systems: the given numbers of all these springs are p_e + p, so that ∂/∂p
/// is the sum of the derivatives with respect to each of them.
struct SpringParameterGroup {
  SpringParameter parameter = SpringParameter::stiffness;
  std::vector<int> springs{};  ///< indices; empty: all springs
};

/// Throws InputError that names the first index that is out of range.
void validate(const SpringParameterGroup& group, const Springs& springs);

/// out = ∂f/∂p at (q, v), 3 entries per particle, where f is the force of the model:
///   ∂f_i/∂k_s = ∂σ/∂k_s r,  ∂f_i/∂k_d = (w·r) r,  ∂f_i/∂l₀ = ∂σ/∂l₀ r
/// with ∂σ/∂k_s = L − l₀ (hooke) or (L − l₀)/l₀ (strain) and ∂σ/∂l₀ = −k_s (hooke) or −k_s L/l₀² (strain);
/// a slack rope gives nothing but its damper's part, and a spring of length zero, whose force is defined as
/// zero, nothing at all. Rows of fixed particles are zero. The indices of `group` are valid.
void parameter_derivative(const MassSpringModel& model, const SpringParameterGroup& group, ConstVectorRef q,
                          ConstVectorRef v, VectorRef out);

}  // namespace fw::mechanics
