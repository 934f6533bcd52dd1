#pragma once
// Private to stability*.cpp.

#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "analysis/theory/linear_modes.hpp"
#include "analysis/theory/scheme_growth.hpp"
#include "core/special_values.hpp"
#include "study/plan.hpp"
#include "study/problem_spec.hpp"

namespace fw::study {

/// A method as the cases share it.
struct StabilityMethod {
  std::string call;
  std::shared_ptr<const Integrator> integrator;
  schemes::SchemeData data;       ///< its coefficients
  analysis::LinearScheme linear;  ///< what it is on linear systems
};

/// The keys of [regions].
struct RegionSettings {
  double real_from = -5.0, real_to = 2.0;
  double imaginary_from = -4.0, imaginary_to = 4.0;
  std::int64_t points = 121;  ///< along each axis
};

/// The keys of [limits].
struct LimitSettings {
  double tolerance = 0.02;  ///< |observed/predicted − 1| that holds
  double exponent_tolerance = 0.01;
  double farthest = 1000.0;  ///< largest step tried, in units of 1/|λ|
  double growth = 10.0;      ///< of the norm of a perturbation that makes a step unstable
  std::int64_t fewest_steps = 2000, most_steps = 20'000;  ///< of a run
  std::int64_t samples = 9;                               ///< of J along a nonlinear trajectory
  std::int64_t largest_dense = 600;                       ///< unknowns with all eigenvalues
  std::int64_t seed = 0;                                  ///< of the study
};
void declare(settings::Archive& a, LimitSettings& settings);

/// The spectrum of a problem: once for a linear one, at several times of its trajectory for a nonlinear one.
struct ProblemSpectrum {
  bool is_linear = false;
  /// The problem that J and the runs are taken from: of a linear problem its homogeneous part, ẏ = Jy, since
  /// forcing moves the solution and its sign, but no limit.
  std::shared_ptr<const OdeSystem> system;
  std::vector<double> times;
  std::vector<analysis::LinearModes> modes;  ///< at each time
  double spectral_radius = 0.0;              ///< the largest
  double largest_size = 0.0;                 ///< of ‖v‖ (of ‖y‖, first order) along the trajectory
  std::string failure;                       ///< why there is none
};

/// A problem that the cases of all methods share, linearised if the study asks for it. Its spectrum is
/// computed by the first case that needs it. Safe to use from several threads.
class StabilityProblem {
 public:
  StabilityProblem(StudyProblem problem, bool linearise, std::shared_ptr<const Integrator> tracer);

  const StudyProblem& entry() const { return problem_; }
  const Ivp& ivp() const { return ivp_; }
  const ProblemSpectrum& spectrum(const LimitSettings& settings, const RunContext& context) const;

 private:
  StudyProblem problem_;
  Ivp ivp_;
  std::shared_ptr<const Integrator> tracer_;
  mutable std::mutex mutex_;
  mutable std::shared_ptr<const ProblemSpectrum> spectrum_;
};

/// A problem or a family of them.
struct StabilityFamily {
  std::string label;
  std::string parameter;  ///< empty: a single problem
  std::vector<double> values;
  std::vector<std::shared_ptr<const StabilityProblem>> members;
  double exponent = std::numeric_limits<double>::quiet_NaN();  ///< of the limit over the parameter, in theory
  std::string identity;
};

/// The row of the summary that every case has.
struct StabilityRow {
  std::string part, problem, method, basis;
  double real_interval = no_value, imaginary_interval = no_value, angle = no_value, at_infinity = no_value;
  double spectral_radius = no_value;
  double predicted = no_value, observed = no_value, ratio = no_value;
  double monotone_predicted = no_value, monotone_observed = no_value;
  double largest_deviation = no_value;
  double expected_exponent = no_value;
  double predicted_exponent = no_value, predicted_exponent_low = no_value, predicted_exponent_high = no_value;
  double observed_exponent = no_value, observed_exponent_low = no_value, observed_exponent_high = no_value;
};
void declare(SummaryRow& a, const StabilityRow& row);

/// What is found of one problem.
struct StabilityLimit {
  double predicted = no_value, observed = no_value;  ///< largest stable step [s]
  double monotone_predicted = no_value, monotone_observed = no_value;
  std::int64_t steps = 0;  ///< of a run of the search
  bool is_confirmed_by_growth = false;
  /// Measured over predicted ln of the factor per step, where growth is the evidence.
  std::vector<double> growth_ratios{};
  std::string failure{};
  std::string failed_run{};  ///< how the last run ended that failed without growing

  double ratio() const {
    if (std::isinf(predicted) && std::isinf(observed)) return 1.0;
    return predicted > 0.0 ? observed / predicted : no_value;
  }
};

StabilityLimit measure_limit(const StabilityProblem& problem, const StabilityMethod& method,
                             const analysis::SchemeGrowth& growth, const LimitSettings& settings,
                             const RunContext& context);

CaseResult run_region_case(const StabilityMethod& method, const RegionSettings& settings,
                           const RunContext& context);
CaseResult run_limit_case(const StabilityFamily& family, const StabilityMethod& method,
                          const LimitSettings& settings, const RunContext& context);

}  // namespace fw::study
