#pragma once

#include <gtest/gtest.h>

#include "analysis/reference/reference_solution.hpp"

namespace fw::oracles {

/// The certified state at the end of a problem.
inline Vector reference_state(const Ivp& ivp) {
  const auto reference = analysis::certified_reference(ivp, ivp.t1);
  EXPECT_TRUE(reference.status.ok()) << reference.status.describe();
  return reference.states.at(0).rounded();
}

}  // namespace fw::oracles
