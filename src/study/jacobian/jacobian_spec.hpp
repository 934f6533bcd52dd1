#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "study/jacobian/jacobian_definiteness.hpp"
#include "study/jacobian/jacobian_derivatives.hpp"
#include "study/problem_spec.hpp"

namespace fw::study {

/// What `--quick` leaves: entries of each list, samples of each subject.
struct QuickRule {
  bool is_on = false;
  std::int64_t points = 5;
  std::int64_t samples = 20;
};

/// The keys of [springs].
struct SpringSpec {
  std::vector<std::string> laws = {"hooke", "strain", "tension_only"};
  std::vector<std::string> dampers = {"without", "with"};
  std::int64_t samples = 200;
};
void declare(settings::Archive& a, SpringSpec& spec);

/// The keys of [derivatives].
struct DerivativeSpec {
  DerivativeSettings settings;
  std::vector<std::string> formulas = derivative_formulas();
  std::int64_t samples = 5;   ///< of each problem
  double displacement = 0.1;  ///< in typical lengths
  bool pattern = true;
};
void declare(settings::Archive& a, DerivativeSpec& spec);

/// The state that [definiteness] and [runs] begin with; lengths in the typical length of the problem's
/// springs.
struct CompressionSpec {
  double closing_rate = 0.0, displacement = 0.05, speed = 0.0;

  Compression with_seed(std::int64_t seed) const {
    return {.closing_rate = closing_rate, .displacement = displacement, .speed = speed, .seed = seed};
  }
};
void declare(settings::Archive& a, CompressionSpec& spec);

/// The keys of [definiteness].
struct DefinitenessSpec {
  std::vector<double> compressions, steps;
  CompressionSpec start;
  std::vector<std::string> tangents = tangent_model_names();
};
void declare(settings::Archive& a, DefinitenessSpec& spec);

/// The keys of [runs].
struct RunsSpec {
  std::vector<double> compressions, steps;
  CompressionSpec start;
  std::vector<std::string> methods;
};
void declare(settings::Archive& a, RunsSpec& spec);

/// A study file of kind "jacobian".
struct JacobianSpec {
  std::optional<SpringSpec> springs;
  std::optional<DerivativeSpec> derivatives;
  std::optional<DefinitenessSpec> definiteness;
  std::optional<RunsSpec> runs;
  std::vector<ProblemSpec> problems;
  QuickRule rule;
};
void declare(settings::Archive& a, JacobianSpec& spec);

}  // namespace fw::study
