#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "core/special_values.hpp"
#include "schemes/scheme_data.hpp"
#include "study/propagation/disturbed_network.hpp"

namespace fw::study {

/// The keys of [propagation].
struct PropagationSettings {
  std::vector<double> steps;
  std::int64_t step_count = 60;
  double duration = 0.0;
  std::int64_t mass = -1;
  bool kick = true;
  double size = 1.0;
  Vec3<double> direction{1.0, 0.0, 0.0};
  double threshold = 1e-3;
  double speed_tolerance = 0.02;

  /// How many steps of this length a run has.
  std::int64_t steps_of(double step) const;
};
void declare(settings::Archive& a, PropagationSettings& s);

/// The row of the summary.
struct PropagationRow {
  std::string problem, method;
  double step = no_value;
  std::int64_t farthest = 0;
  double springs_per_step = no_value;
  std::int64_t first_step_velocity = -1, first_step_position = -1;
  double wave_springs_per_step = no_value, wave_speed = no_value, physical_wave_speed = no_value;
};
void declare(SummaryRow& a, const PropagationRow& row);

/// One method with one step on a disturbed network: how far the disturbance has come after each step, against
/// what the method's stages (`data`) allow, and the speed of the wave against the physical one.
CaseResult run_propagation(const DisturbedNetwork& network, const std::string& call,
                           const Integrator& integrator, const schemes::SchemeData& data, double step,
                           const PropagationSettings& settings, const RunContext& context);

}  // namespace fw::study
