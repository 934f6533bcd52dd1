#include "integrators/tableau/runge_kutta_chebyshev.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "integrators/loop/stepper.hpp"
#include "integrators/tableau/tableau_info.hpp"
#include "schemes/chebyshev_recurrence.hpp"

namespace fw::integrators {

namespace {

using schemes::ChebyshevRecurrence;

constexpr int steps_between_estimates = 25;
constexpr int most_power_iterations = 100;
constexpr double power_iteration_tolerance = 0.01;
constexpr double spectral_radius_safety = 1.1;

/// ϱ(J) by power iteration with products J·w.
class SpectralRadiusEstimate {
 public:
  SpectralRadiusEstimate(const OdeSystem& system, Index size, Work& work)
      : system_(system), work_(work), vector_(size), product_(size) {
    restart();
  }

  void restart() {
    // Every component takes part, none in tune with a mode of a regular chain.
    for (Index k = 0; k < vector_.size(); ++k) {
      vector_[k] = 1.0 + 0.5 * std::sin(static_cast<double>(k * k + 1));
    }
    vector_.normalize();
  }
  void serialise(StateArchive& archive) { archive.visit("eigenvector", vector_); }

  /// The growth per product, as the geometric mean over two of them, since complex pairs make single ones
  /// oscillate.
  double operator()(double t, ConstVectorRef y) {
    double before = 0.0, previous_growth = 0.0;
    for (int iteration = 0; iteration < most_power_iterations; ++iteration) {
      system_.jacobian_product(t, y, vector_, product_);
      ++work_.jacobian_products;
      const double growth = product_.norm();
      if (!(growth > 0.0) || !std::isfinite(growth)) return growth;
      vector_ = product_ / growth;
      const double mean = std::sqrt(growth * previous_growth);
      if (iteration > 1 && std::abs(mean - before) <= power_iteration_tolerance * mean)
        return std::max(mean, growth);
      before = mean;
      previous_growth = growth;
    }
    return std::max(before, previous_growth);
  }

 private:
  const OdeSystem& system_;
  Work& work_;
  Vector vector_, product_;
};

class ChebyshevStepper final : public Stepper {
 public:
  ChebyshevStepper(const RungeKuttaChebyshevOptions& options, const Ivp& ivp, Work& work)
      : options_(options),
        system_(*ivp.system),
        work_(work),
        spectral_radius_(system_, options.stages == 0 ? ivp.y0.size() : 0, work),
        first_slope_(ivp.y0.size()),
        slope_(ivp.y0.size()),
        before_(ivp.y0.size()),
        now_(ivp.y0.size()),
        next_(ivp.y0.size()) {
    recurrence_.reserve(options.stages == 0 ? most_chebyshev_stages : options.stages);
    if (options.stages != 0) recurrence_.set(options.order, options.stages);
  }

  Status step(double t, double h, VectorRef y) override {
    if (options_.stages == 0) {
      if (Status status = choose_stages(t, h, y); !status.ok()) return status;
    }
    const ChebyshevRecurrence<double>& r = recurrence_;
    system_.rhs(t, y, first_slope_);
    ++work_.rhs_evaluations;
    before_ = y;
    now_ = y + (r.mu_tilde[1] * h) * first_slope_;
    for (std::size_t j = 2; j <= static_cast<std::size_t>(r.stages); ++j) {
      system_.rhs(t + r.c[j - 1] * h, now_, slope_);
      ++work_.rhs_evaluations;
      // In differences to y, whose weights 1 − μ, μ and ν sum to one: what rests stays at rest to the last
      // bit.
      next_ = y + r.mu[j] * (now_ - y) + r.nu[j] * (before_ - y) + (r.mu_tilde[j] * h) * slope_ +
              (r.gamma_tilde[j] * h) * first_slope_;
      before_.swap(now_);
      now_.swap(next_);
    }
    y = now_;
    return {};
  }

  void restart(double, ConstVectorRef) override {
    spectral_radius_.restart();
    steps_ = 0;
  }
  void serialise(StateArchive& archive) override {
    spectral_radius_.serialise(archive);
    archive.visit("spectral radius", radius_);
    archive.visit("steps since the start", steps_);
  }

 private:
  Status choose_stages(double t, double h, ConstVectorRef y) {
    if (steps_ % steps_between_estimates == 0) radius_ = spectral_radius_safety * spectral_radius_(t, y);
    ++steps_;
    const double wanted = h * radius_;
    int stages = fewest_chebyshev_stages;
    while (stages <= most_chebyshev_stages &&
           schemes::real_stability_interval(options_.order, stages) < wanted) {
      ++stages;
    }
    if (!(wanted >= 0.0) || stages > most_chebyshev_stages) {
      return {StatusCode::step_limit,
              fmt::format("h times the spectral radius is {:.3g}: more than {} stages are needed", wanted,
                          most_chebyshev_stages)};
    }
    if (stages != recurrence_.stages) recurrence_.set(options_.order, stages);
    return {};
  }

  RungeKuttaChebyshevOptions options_;
  const OdeSystem& system_;
  Work& work_;
  SpectralRadiusEstimate spectral_radius_;
  ChebyshevRecurrence<double> recurrence_{};
  Vector first_slope_, slope_, before_, now_, next_;
  double radius_ = 0.0;
  std::uint64_t steps_ = 0;
};

std::vector<Float128> solve_extended(const ChebyshevRecurrence<Float128>& r, const Ivp& ivp,
                                     std::uint64_t steps) {
  std::vector<Float128> y = initial_state_extended(ivp);
  std::vector<Float128> first(y.size()), slope(y.size()), before(y.size()), now(y.size()), next(y.size());
  const Float128 h = (Float128(ivp.t1) - Float128(ivp.t0)) / steps;
  for (std::uint64_t step = 0; step < steps; ++step) {
    const Float128 t = Float128(ivp.t0) + step * h;
    ivp.system->rhs(t, y, first);
    before = y;
    for (std::size_t k = 0; k < y.size(); ++k) now[k] = y[k] + r.mu_tilde[1] * h * first[k];
    for (std::size_t j = 2; j <= static_cast<std::size_t>(r.stages); ++j) {
      ivp.system->rhs(Float128(t + r.c[j - 1] * h), now, slope);
      for (std::size_t k = 0; k < y.size(); ++k) {
        next[k] = (1 - r.mu[j] - r.nu[j]) * y[k] + r.mu[j] * now[k] + r.nu[j] * before[k] +
                  h * (r.mu_tilde[j] * slope[k] + r.gamma_tilde[j] * first[k]);
      }
      before.swap(now);
      now.swap(next);
    }
    y = now;
  }
  return y;
}

}  // namespace

std::unique_ptr<Integrator> make_runge_kutta_chebyshev(const RungeKuttaChebyshevOptions& options) {
  // The orders do not depend on the number of stages; a few serve to derive them.
  constexpr int stages_to_derive_from = 4;
  MethodInfo info = tableau_info(
      schemes::chebyshev_tableau(options.order, options.stages == 0 ? stages_to_derive_from : options.stages),
      "stabilised explicit Runge-Kutta");
  if (options.stages == 0) info.stages = fewest_chebyshev_stages;
  info.formula =
      "Y_j = (1 - mu_j - nu_j) y + mu_j Y_{j-1} + nu_j Y_{j-2} + mt_j h f(Y_{j-1}) + gt_j h f(y);  y' = Y_s";
  ExtendedSolver extended;
  if (options.stages != 0) {
    ChebyshevRecurrence<Float128> recurrence;
    recurrence.set(options.order, options.stages);
    extended = [recurrence](const Ivp& ivp, std::uint64_t steps) {
      return solve_extended(recurrence, ivp, steps);
    };
  }
  return std::make_unique<FixedStepIntegrator>(
      std::move(info),
      [options](const Ivp& ivp, double, Work& work) -> std::unique_ptr<Stepper> {
        return std::make_unique<ChebyshevStepper>(options, ivp, work);
      },
      std::move(extended));
}

}  // namespace fw::integrators
