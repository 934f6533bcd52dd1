#include "analysis/theory/influence_front.hpp"

#include <algorithm>
#include <optional>

namespace fw::analysis {

namespace {

/// The front of a force evaluated at positions (or, by dampers, velocities) with this front.
int force_front(int position) {
  return position < 0 ? -1 : position + 1;
}

/// One step; empty where the scheme is implicit.
using Advance = std::optional<InfluenceFront>;

/// A Runge–Kutta method, and whether springs have dampers.
struct DampedTableau {
  const schemes::TableauValues<Float128>& values;
  bool dampers;
};

Advance advance(const DampedTableau& scheme, InfluenceFront state) {
  const schemes::TableauValues<Float128>& t = scheme.values;
  std::vector<InfluenceFront> slopes;
  for (int i = 0; i < t.stages; ++i) {
    InfluenceFront stage = state;
    for (int j = 0; j < t.stages; ++j) {
      if (t.A(i, j) == 0) continue;
      if (j >= i) return std::nullopt;
      const InfluenceFront& slope = slopes[static_cast<std::size_t>(j)];
      stage.position = std::max(stage.position, slope.position);
      stage.velocity = std::max(stage.velocity, slope.velocity);
    }
    const int force = scheme.dampers ? std::max(stage.position, stage.velocity) : stage.position;
    slopes.push_back({stage.velocity, force_front(force)});
  }
  InfluenceFront next = state;
  for (std::size_t i = 0; i < slopes.size(); ++i) {
    if (t.b[i] == 0) continue;
    next.position = std::max(next.position, slopes[i].position);
    next.velocity = std::max(next.velocity, slopes[i].velocity);
  }
  return next;
}

Advance advance(const schemes::NystromValues<Float128>& t, InfluenceFront state) {
  const auto s = static_cast<std::size_t>(t.stages);
  std::vector<int> forces;
  for (std::size_t i = 0; i < s; ++i) {
    int position = t.c[i] == 0 ? state.position : std::max(state.position, state.velocity);
    for (std::size_t j = 0; j < s; ++j) {
      if (t.a_position[i * s + j] == 0) continue;
      if (j >= i) return std::nullopt;
      position = std::max(position, forces[j]);
    }
    forces.push_back(force_front(position));
  }
  InfluenceFront next = {std::max(state.position, state.velocity), state.velocity};
  for (std::size_t i = 0; i < s; ++i) {
    if (t.b_position[i] != 0) next.position = std::max(next.position, forces[i]);
    if (t.b_velocity[i] != 0) next.velocity = std::max(next.velocity, forces[i]);
  }
  return next;
}

Advance advance(const schemes::SplittingScheme& scheme, InfluenceFront state) {
  for (std::size_t i = 0; i < scheme.drift.size(); ++i) {
    if (scheme.drift[i].value() != 0) state.position = std::max(state.position, state.velocity);
    if (i < scheme.kick.size() && scheme.kick[i].value() != 0) {
      state.velocity = std::max(state.velocity, force_front(state.position));
    }
  }
  return state;
}

template <class Scheme>
PredictedFronts follow(const Scheme& scheme, InfluenceFront state, int farthest, std::uint64_t steps) {
  PredictedFronts predicted{.known = true};
  predicted.fronts.push_back(state);
  for (std::uint64_t n = 0; n < steps; ++n) {
    const Advance next = advance(scheme, state);
    if (!next) return {.known = true, .whole_system = true};
    state = {std::min(next->position, farthest), std::min(next->velocity, farthest)};
    predicted.fronts.push_back(state);
  }
  return predicted;
}

struct Predict {
  InfluenceFront start;
  int farthest;
  std::uint64_t steps;
  bool dampers;

  template <class Other>
  PredictedFronts operator()(const Other&) const {
    return {};
  }
  PredictedFronts operator()(const schemes::ButcherTableau& tableau) const {
    const schemes::TableauValues<Float128> values = schemes::values<Float128>(tableau);
    return follow(DampedTableau{values, dampers}, start, farthest, steps);
  }
  PredictedFronts operator()(const schemes::NystromTableau& tableau) const {
    if (dampers) return {};
    return follow(schemes::values<Float128>(tableau), start, farthest, steps);
  }
  PredictedFronts operator()(const schemes::SplittingScheme& scheme) const {
    if (dampers) return {};
    return follow(scheme, start, farthest, steps);
  }
};

}  // namespace

PredictedFronts predict_fronts(const schemes::SchemeData& data, InfluenceFront start, int farthest,
                               std::uint64_t steps, bool dampers) {
  return std::visit(Predict{start, farthest, steps, dampers}, data);
}

}  // namespace fw::analysis
