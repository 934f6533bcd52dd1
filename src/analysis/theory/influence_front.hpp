#pragma once

#include <cstdint>
#include <vector>

#include "schemes/scheme_data.hpp"

namespace fw::analysis {

/// How many springs away from a disturbed mass something has arrived; −1: nowhere yet, not even there.
struct InfluenceFront {
  int position = -1;  ///< of displacements
  int velocity = -1;  ///< of velocities
  bool operator==(const InfluenceFront&) const = default;
};

/// What a scheme's structure says of the fronts.
struct PredictedFronts {
  bool known = false;         ///< the scheme is given by a Runge–Kutta, Nyström or splitting scheme
  bool whole_system = false;  ///< implicit: every mass after one step
  std::vector<InfluenceFront> fronts{};  ///< after 0, 1, … steps; empty where implicit
};

/// The fronts of an explicit scheme on springs, by counting how force evaluations are chained in its stages: a
/// velocity takes the front of the positions at which its force is evaluated one spring further, with `dampers`
/// in the springs that of the velocities as well, a position takes over that of the velocity. A coefficient that
/// is zero passes nothing on. `start` is what is disturbed before the first step; no front goes further than
/// `farthest`. That no two contributions cancel is taken for granted: true for rounding arithmetic outside
/// accidents. With `dampers` only Runge–Kutta methods are known: Nyström and splitting schemes have more than one
/// way to treat a force that depends on the velocity, and their coefficients do not tell which.
PredictedFronts predict_fronts(const schemes::SchemeData& data, InfluenceFront start, int farthest,
                               std::uint64_t steps, bool dampers = false);

}  // namespace fw::analysis
