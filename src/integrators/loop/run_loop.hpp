#pragma once

#include <functional>
#include <limits>
#include <memory>

#include "integrators/loop/step_source.hpp"
#include "ode/integrator.hpp"

namespace fw::integrators {

/// Makes the source of a run: allocates all work space and evaluates what the first step needs. `work`
/// outlives it and is counted into.
using StepSourceFactory = std::function<std::unique_ptr<StepSource>(Work& work)>;

/// The one time loop, of own and foreign schemes with constant and with chosen steps:
///   propose, attempt (again while rejected), check of the state, switches of the right-hand side (again where
///   one is to be the end of the step), accept, hook, observer, restart, checkpoint.
/// It owns the view of the start, the choice of the dense output, the end of the last step, the limit of
/// steps (accepted and rejected), steps that no longer advance time, the texts of the states in which a run
/// ends, the count of accepted steps, the user's interrupt, hooks and checkpoints. Nothing is allocated after
/// the first step.
Solution run_loop(const MethodInfo& info, const Ivp& ivp, const StepSourceFactory& make_source,
                  Observer& observer, const SolveOptions& options,
                  std::uint64_t maximum_steps = std::numeric_limits<std::uint64_t>::max());

}  // namespace fw::integrators
