#pragma once

#include <memory>

#include "core/state_archive.hpp"
#include "core/status.hpp"
#include "core/work.hpp"
#include "ode/ode_system.hpp"

namespace fw::integrators {

/// Solves y' = w + c f(t, y') for y', the equation of every implicit scheme with one unknown stage. Newton's
/// iteration to convergence with a direct solver; a second-order system is reduced to its accelerations (see
/// `ImplicitAcceleration`).
class ImplicitUpdate {
 public:
  virtual ~ImplicitUpdate() = default;

  /// `y` holds the initial guess and receives y'; `slope` receives (y' − w)/c, which is f(t, y') to Newton's
  /// tolerance. Fails with Newton's Status.
  virtual Status solve(double t, double c, ConstVectorRef w, VectorRef y, VectorRef slope) = 0;

  /// Forgets the factors of Newton's iteration.
  virtual void forget_matrix() = 0;
  /// Visits what the next solve depends on.
  virtual void serialise(StateArchive& archive) = 0;
};

std::unique_ptr<ImplicitUpdate> make_implicit_update(const OdeSystem& system, Work& work);

}  // namespace fw::integrators
