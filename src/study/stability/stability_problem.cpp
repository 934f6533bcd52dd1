#include <algorithm>
#include <cmath>

#include "analysis/theory/linearised_system.hpp"
#include "study/stability/stability_cases.hpp"

namespace fw::study {

namespace {

/// Notes the state at evenly spaced times and the largest speed.
class TrajectorySamples final : public Observer {
 public:
  TrajectorySamples(const Ivp& ivp, std::int64_t count) : system_(ivp.system->second_order()) {
    for (std::int64_t k = 0; k < count; ++k) {
      times_.push_back(ivp.t0 + (ivp.t1 - ivp.t0) * static_cast<double>(k) / static_cast<double>(count - 1));
    }
  }

  bool observe(const StepView& view) override {
    const double size =
        system_ != nullptr ? view.state.tail(system_->degrees_of_freedom()).norm() : view.state.norm();
    largest_size_ = std::max(largest_size_, size);
    while (states_.size() < times_.size() && (times_[states_.size()] <= view.time || view.last)) {
      Vector state = view.state;
      if (view.interpolate && times_[states_.size()] < view.time)
        view.interpolate(times_[states_.size()], state);
      states_.push_back(std::move(state));
    }
    return true;
  }

  const std::vector<double>& times() const { return times_; }
  const std::vector<Vector>& states() const { return states_; }
  double largest_size() const { return largest_size_; }

 private:
  const SecondOrderSystem* system_;
  std::vector<double> times_;
  std::vector<Vector> states_;
  double largest_size_ = 0.0;
};

ProblemSpectrum find_spectrum(const Ivp& ivp, const Integrator& tracer, const LimitSettings& settings,
                              const RunContext& context) {
  ProblemSpectrum spectrum;
  spectrum.is_linear = analysis::is_linear(*ivp.system, ivp.t0, ivp.y0);
  spectrum.system = spectrum.is_linear ? analysis::homogeneous_part(ivp.system, ivp.t0, ivp.y0) : ivp.system;
  std::vector<Vector> states = {ivp.y0};
  spectrum.times = {ivp.t0};
  if (!spectrum.is_linear) {
    TrajectorySamples samples(ivp, settings.samples);
    const Solution solution = context.solve(
        tracer, ivp, AdaptiveStep{.relative_tolerance = 1e-5, .absolute_tolerance = 1e-7}, samples);
    if (!solution.status.ok()) {
      spectrum.failure = "no trajectory to take J along: " + solution.status.describe();
      return spectrum;
    }
    states = samples.states();
    spectrum.times = samples.times();
    spectrum.largest_size = samples.largest_size();
  }
  for (std::size_t k = 0; k < states.size(); ++k) {
    context.check();
    spectrum.modes.push_back(
        analysis::linear_modes(*ivp.system, spectrum.times[k], states[k], settings.largest_dense));
    if (!spectrum.modes.back().status.ok()) {
      spectrum.failure = "no eigenvalues: " + spectrum.modes.back().status.describe();
      return spectrum;
    }
    spectrum.spectral_radius = std::max(spectrum.spectral_radius, spectrum.modes.back().spectral_radius);
  }
  return spectrum;
}

}  // namespace

StabilityProblem::StabilityProblem(StudyProblem problem, bool linearise,
                                   std::shared_ptr<const Integrator> tracer)
    : problem_(std::move(problem)), ivp_(problem_.problem.ivp), tracer_(std::move(tracer)) {
  if (!linearise) return;
  const SecondOrderSystem& system = *ivp_.system->second_order();
  const Index n = system.degrees_of_freedom();
  ivp_.system =
      std::make_shared<analysis::LinearisedSystem>(system, ivp_.t0, ivp_.y0.head(n), ivp_.y0.tail(n));
  ivp_.y0.setZero();
  ivp_.y0_extended.clear();
}

const ProblemSpectrum& StabilityProblem::spectrum(const LimitSettings& settings,
                                                  const RunContext& context) const {
  const std::lock_guard lock(mutex_);
  if (!spectrum_)
    spectrum_ = std::make_shared<const ProblemSpectrum>(find_spectrum(ivp_, *tracer_, settings, context));
  return *spectrum_;
}

}  // namespace fw::study
