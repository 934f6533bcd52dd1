#include "integrators/exponential/exponential_rosenbrock_euler.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.hpp"
#include "integrators/exponential/krylov_phi.hpp"
#include "integrators/loop/stepper.hpp"

namespace fw::integrators {

namespace {

class ExponentialRosenbrockEulerStepper final : public Stepper {
 public:
  ExponentialRosenbrockEulerStepper(const ExponentialOptions& options, const Ivp& ivp, Work& work)
      : options_(options),
        system_(*ivp.system),
        work_(work),
        phi_(ivp.y0.size() + 1, options.krylov_dimension),
        slope_(ivp.y0.size() + 1),
        time_slope_(ivp.y0.size()),
        slope_before_(ivp.y0.size()),
        increment_(ivp.y0.size() + 1) {}

  Status step(double t, double h, VectorRef y) override {
    const Index n = y.size();
    system_.rhs(t, y, slope_.head(n));
    slope_[n] = 1.0;
    // A central difference; its error is far below that of the scheme, and its rounding below that of f.
    const double delta = 1e-3 * h;
    system_.rhs(t + delta, y, time_slope_);
    system_.rhs(t - delta, y, slope_before_);
    time_slope_ = (time_slope_ - slope_before_) / (2.0 * delta);
    work_.rhs_evaluations += 3;

    const auto apply = [&](ConstVectorRef w, VectorRef out) {
      system_.jacobian_product(t, y, w.head(n), out.head(n));
      ++work_.jacobian_products;
      out.head(n) = h * (out.head(n) + w[n] * time_slope_);
      out[n] = 0.0;
    };
    const double size = std::max(y.norm(), h * slope_.head(n).norm());
    int dimension = 0;
    Status status = phi_.multiply(apply, slope_, options_.krylov_tolerance * size / h, increment_, dimension);
    work_.linear_iterations += static_cast<std::uint64_t>(dimension);
    ++work_.linear_solves;
    if (status.ok()) y += h * increment_.head(n);
    return status;
  }

  /// A step depends on (t, y) only.
  void restart(double, ConstVectorRef) override {}
  void serialise(StateArchive&) override {}

 private:
  ExponentialOptions options_;
  const OdeSystem& system_;
  Work& work_;
  KrylovPhi phi_;
  Vector slope_, time_slope_, slope_before_, increment_;
};

}  // namespace

std::unique_ptr<Integrator> make_exponential_rosenbrock_euler(const ExponentialOptions& options) {
  if (!(options.krylov_tolerance > 0.0 && options.krylov_tolerance <= 1.0)) {
    throw InputError(fmt::format("option krylov_tolerance: found {}, expected a number in (0, 1]",
                                 options.krylov_tolerance));
  }
  if (options.krylov_dimension < 1 || options.krylov_dimension > 2000) {
    throw InputError(fmt::format("option krylov_dimension: found {}, expected a whole number from 1 to 2000",
                                 options.krylov_dimension));
  }
  MethodInfo info{.name = "exponential_rosenbrock_euler",
                  .title = "Exponential Rosenbrock-Euler (Krylov)",
                  .family = "exponential",
                  .order = 2,
                  .order_with_velocity_forces = 2,
                  .stages = 3,  // one right-hand side and two for its derivative by t
                  .is_explicit = true,
                  .is_a_stable = true,
                  .is_l_stable = true,
                  .formula = "y' = y + h phi1(hJ) f(t, y) + h² phi2(hJ) df/dt",
                  .reference = "[Pope 1963; Hochbruck, Ostermann 2010, 2.5]"};
  return std::make_unique<FixedStepIntegrator>(
      std::move(info), [options](const Ivp& ivp, double, Work& work) -> std::unique_ptr<Stepper> {
        return std::make_unique<ExponentialRosenbrockEulerStepper>(options, ivp, work);
      });
}

}  // namespace fw::integrators
