#pragma once

#include <memory>

#include "ode/integrator.hpp"

namespace fw::integrators {

struct RespaOptions {
  int inner_steps = 10;  ///< steps of the stiff forces per step of the soft ones
};

/// The reversible reference system propagator, also known as impulse or Verlet-I scheme: multiple time steps
/// on the splitting f = f_stiff + f_soft of the system [Grubmüller et al. 1991; Tuckerman, Berne, Martyna
/// 1992]:
///   v += ½h M⁻¹ f_soft(t, q, v),   inner_steps × velocity Verlet with f_stiff,   v' = v + ½h M⁻¹ f_soft(t +
///   h, q', v').
/// All second half-kicks are implicit where forces depend on velocity (see `ImplicitKick`), so that the order
/// is 2 for both classes of forces. Near h = π/ω of a stiff frequency ω it resonates, whatever the inner
/// steps [Hairer, Lubich, Wanner 2006, XIII.1].
///
/// `Work::rhs_evaluations` counts each evaluation of either part as one.
std::unique_ptr<Integrator> make_r_respa(const RespaOptions& options = {});

}  // namespace fw::integrators
