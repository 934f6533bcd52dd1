#include "oracles/gsl/odeiv2.hpp"

#include <fmt/format.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_matrix.h>
#include <gsl/gsl_odeiv2.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <mutex>

#include "core/error.hpp"
#include "ode/not_applicable.hpp"
#include "ode/pattern_watch.hpp"
#include "oracles/foreign_stepper.hpp"

namespace fw::oracles {

namespace {

constexpr Index largest_dense_system = 10'000;
/// Tolerances of Newton's iteration where the step is constant.
constexpr double rounding_tolerance = 1e-14;

/// GSL's last complaint in this thread.
thread_local std::string last_message;

void keep_message(const char* reason, const char*, int, int) {
  last_message = reason;
}

/// GSL's own handler aborts the program.
void install_error_handler() {
  static std::once_flag once;
  std::call_once(once, [] { gsl_set_error_handler(keep_message); });
}

struct Stepper {
  GslStepper known;
  const gsl_odeiv2_step_type* const* type;
  int order;
  int stages;
  bool is_explicit;
  bool has_fixed_step;
  const char* title;
  bool is_symplectic = false;  ///< and symmetric
  bool is_a_stable = false;
  bool is_l_stable = false;
};

const std::vector<Stepper>& steppers() {
  // Stages are right-hand sides per attempted step.
  static const std::vector<Stepper> list = {
      {{"rk2", 1.0}, &gsl_odeiv2_step_rk2, 3, 3, true, true, "Runge-Kutta 3(2), goes on with order 3"},
      {{"rk4", 1.0}, &gsl_odeiv2_step_rk4, 4, 11, true, true, "classical Runge-Kutta, step doubling"},
      {{"rkf45", 1.0}, &gsl_odeiv2_step_rkf45, 5, 6, true, true, "Runge-Kutta-Fehlberg 5(4)"},
      {{"rkck", 1.0}, &gsl_odeiv2_step_rkck, 5, 6, true, true, "Runge-Kutta-Cash-Karp 5(4)"},
      {{"rk8pd", 1.0}, &gsl_odeiv2_step_rk8pd, 8, 13, true, true, "Prince-Dormand 8(7)"},
      {{"rk1imp", 1.0},
       &gsl_odeiv2_step_rk1imp,
       1,
       1,
       false,
       true,
       "implicit Euler, step doubling",
       false,
       true,
       true},
      {{"rk2imp", 1.0},
       &gsl_odeiv2_step_rk2imp,
       2,
       1,
       false,
       true,
       "implicit midpoint, step doubling",
       true,
       true},
      {{"rk4imp", 1.0},
       &gsl_odeiv2_step_rk4imp,
       4,
       2,
       false,
       true,
       "Gauss of two stages, step doubling",
       true,
       true},
      {{"bsimp", 1.0},
       &gsl_odeiv2_step_bsimp,
       0,
       1,
       false,
       false,
       "Bulirsch-Stoer, semi-implicit midpoint rule of Bader and Deuflhard"},
      {{"msadams", 1e-2}, &gsl_odeiv2_step_msadams, 0, 1, true, false, "variable-order Adams"},
      {{"msbdf", 1e-3}, &gsl_odeiv2_step_msbdf, 0, 1, false, false, "variable-order BDF"}};
  return list;
}

struct DriverDeleter {
  void operator()(gsl_odeiv2_driver* driver) const { gsl_odeiv2_driver_free(driver); }
};

class OdeivStepper final : public ForeignStepper {
 public:
  OdeivStepper(const Stepper& stepper, const Ivp& ivp, const StepControl& control, Work& work)
      : system_(*ivp.system), work_(work), name_(stepper.known.name) {
    install_error_handler();
    const Index n = system_.size();
    if (!stepper.is_explicit) {
      if (n > largest_dense_system) {
        throw NotApplicable(
            fmt::format("method \"gsl:{}\" has a dense Jacobian: found {} unknowns, expected at most {}",
                        name_, n, largest_dense_system));
      }
      jacobian_ = system_.jacobian_pattern();
      watch_ = PatternWatch(system_.pattern_revision());
    }
    later_.resize(n);
    earlier_.resize(n);
    gsl_system_ = {evaluate, stepper.is_explicit ? nullptr : evaluate_jacobian, static_cast<std::size_t>(n),
                   this};
    const auto* adaptive = std::get_if<AdaptiveStep>(&control);
    is_adaptive_ = adaptive != nullptr;
    needs_time_derivative_ = name_ == "bsimp";
    end_ = ivp.t1;
    maximum_step_ = is_adaptive_ ? adaptive->maximum_step : std::numeric_limits<double>::infinity();
    minimum_step_ = is_adaptive_ ? adaptive->minimum_step : 0.0;
    const double absolute = is_adaptive_ ? adaptive->absolute_tolerance : rounding_tolerance;
    const double relative = is_adaptive_ ? adaptive->relative_tolerance : rounding_tolerance;
    relative_ = relative;
    absolute_ = absolute;
    given_step_ = is_adaptive_ ? adaptive->initial_step : std::get<FixedStep>(control).step;
    start(ivp.t0, ivp.y0);
    if (is_adaptive_ && adaptive->has_velocity_tolerance(system_)) {
      const Vector scales = absolute_tolerances(*adaptive, system_) / absolute;
      driver_.reset(gsl_odeiv2_driver_alloc_scaled_new(&gsl_system_, *stepper.type, step_, absolute, relative,
                                                       1.0, 0.0, scales.data()));
    } else {
      driver_.reset(gsl_odeiv2_driver_alloc_y_new(&gsl_system_, *stepper.type, step_, absolute, relative));
    }
    if (!driver_) throw SystemError(fmt::format("GSL cannot make its stepper: {}", last_message));
  }

  Status advance(double limit, double& t, VectorRef y) override {
    last_message.clear();
    met_non_finite_ = false;
    int code = GSL_SUCCESS;
    if (is_adaptive_) {
      step_ = std::min(step_, maximum_step_);
      const double target = std::min(limit, t + maximum_step_);
      code = gsl_odeiv2_evolve_apply(driver_->e, driver_->c, driver_->s, &gsl_system_, &t, target, &step_,
                                     y.data());
    } else {
      // GSL halves a step whose stages fail, also without a controller: that one is not the scheme's.
      const double start = t;
      double step = limit - t;
      code =
          gsl_odeiv2_evolve_apply(driver_->e, nullptr, driver_->s, &gsl_system_, &t, limit, &step, y.data());
      if (failure_) std::rethrow_exception(failure_);
      if (code == GSL_SUCCESS && t < limit) {
        t = start;
        return {met_non_finite_ ? StatusCode::non_finite : StatusCode::newton_failed,
                fmt::format("GSL {} at t = {:.6g}: {}", name_, t,
                            met_non_finite_ ? "the right-hand side is not finite"
                                            : "the equations of the stages cannot be solved for this step")};
      }
    }
    if (failure_) std::rethrow_exception(failure_);
    if (code != GSL_SUCCESS) return failure_status(code, t);
    if (is_adaptive_ && step_ < minimum_step_ && t < limit) {
      return {StatusCode::step_too_small,
              fmt::format("GSL {} at t = {:.6g} asks for a step of {:.3g}, below the smallest of {:.3g}",
                          name_, t, step_, minimum_step_)};
    }
    return {};
  }

  void restart(double t, ConstVectorRef y) override {
    collect_work(work_);
    start(t, y);
    gsl_odeiv2_driver_reset_hstart(driver_.get(), step_);
  }

  void collect_work(Work& work) const override { work.rejected_steps += driver_->e->failed_steps; }

 private:
  /// The scale of time and the first step of a run from (t, y).
  void start(double t, ConstVectorRef y) {
    time_scale_ = end_ - t;
    step_ = given_step_ > 0.0 ? given_step_ : first_step(t, y);
    step_ = std::min({step_, time_scale_, maximum_step_});
  }

  /// GSL takes the first step from its user: h with an error of the tolerance, by the size of f.
  double first_step(double t, ConstVectorRef y) {
    system_.rhs(t, y, later_);
    ++work_.rhs_evaluations;
    const double slope = later_.lpNorm<Eigen::Infinity>();
    const double size = y.lpNorm<Eigen::Infinity>();
    const double span = time_scale_;
    const double step = std::sqrt(relative_ * size + absolute_) * (size + 1.0) / (slope + 1e-30);
    return std::isfinite(step) ? std::clamp(step, 1e-8 * span, 1e-2 * span) : 1e-6 * span;
  }

  Status failure_status(int code, double t) const {
    const StatusCode kind = met_non_finite_                               ? StatusCode::non_finite
                            : code == GSL_ESING                           ? StatusCode::matrix_singular
                            : code == GSL_FAILURE && is_adaptive_         ? StatusCode::step_too_small
                            : code == GSL_FAILURE || code == GSL_EMAXITER ? StatusCode::newton_failed
                                                                          : StatusCode::library_failure;
    return {kind, fmt::format("GSL {} at t = {:.6g}: {}{}{}", name_, t, gsl_strerror(code),
                              last_message.empty() ? "" : ": ", last_message)};
  }

  /// Runs one of our functions inside GSL's frames, which no exception may cross.
  template <class Function>
  int guarded(const Function& function) {
    try {
      return function();
    } catch (...) {
      failure_ = std::current_exception();
      return GSL_EBADFUNC;
    }
  }

  static int evaluate(double t, const double* y, double* dydt, void* parameters) {
    auto& run = *static_cast<OdeivStepper*>(parameters);
    return run.guarded([&] {
      const Index n = run.system_.size();
      VectorMap slope(dydt, n);
      run.system_.rhs(t, ConstVectorMap(y, n), slope);
      ++run.work_.rhs_evaluations;
      if (slope.allFinite()) return static_cast<int>(GSL_SUCCESS);
      run.met_non_finite_ = true;
      return static_cast<int>(GSL_FAILURE);  // a smaller step is tried
    });
  }

  static int evaluate_jacobian(double t, const double* y, double* dfdy, double* dfdt, void* parameters) {
    auto& run = *static_cast<OdeivStepper*>(parameters);
    return run.guarded([&] {
      const Index n = run.system_.size();
      const ConstVectorMap state(y, n);
      if (run.watch_.has_changed(run.system_.pattern_revision())) {
        run.jacobian_ = run.system_.jacobian_pattern();
      }
      run.system_.jacobian(t, state, run.jacobian_);
      ++run.work_.jacobian_evaluations;
      using DenseRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
      Eigen::Map<DenseRows>(dfdy, n, n) = run.jacobian_;
      if (!run.needs_time_derivative_) {
        VectorMap(dfdt, n).setZero();  // read by bsimp only
        return static_cast<int>(GSL_SUCCESS);
      }
      const double delta = std::cbrt(std::numeric_limits<double>::epsilon()) * run.time_scale_;
      run.system_.rhs(t + delta, state, run.later_);
      run.system_.rhs(t - delta, state, run.earlier_);
      run.work_.rhs_evaluations += 2;
      VectorMap(dfdt, n) = (run.later_ - run.earlier_) / (2.0 * delta);
      return static_cast<int>(GSL_SUCCESS);
    });
  }

  const OdeSystem& system_;
  Work& work_;
  std::string name_;
  gsl_odeiv2_system gsl_system_{};
  std::unique_ptr<gsl_odeiv2_driver, DriverDeleter> driver_;
  SparseMatrix jacobian_;
  PatternWatch watch_{0};  ///< of the Jacobian
  Vector later_, earlier_;
  std::exception_ptr failure_;
  bool is_adaptive_ = false;
  bool met_non_finite_ = false;  ///< in this step
  bool needs_time_derivative_ = false;
  double end_ = 0.0, time_scale_ = 1.0;
  double given_step_ = 0.0;  ///< 0: to be found
  double relative_ = 0.0, absolute_ = 0.0;
  double step_ = 0.0, maximum_step_ = 0.0, minimum_step_ = 0.0;
};

}  // namespace

const std::vector<GslStepper>& gsl_steppers() {
  static const std::vector<GslStepper> list = [] {
    std::vector<GslStepper> known;
    for (const Stepper& stepper : steppers()) known.push_back(stepper.known);
    return known;
  }();
  return list;
}

std::unique_ptr<Integrator> make_gsl_stepper(const std::string& name, const GslOptions& options) {
  for (const Stepper& stepper : steppers()) {
    if (stepper.known.name != name) continue;
    const bool has_history = stepper.order == 0 && name != "bsimp";
    MethodInfo info{.name = "gsl:" + name,
                    .title = fmt::format("GSL, {}", stepper.title),
                    .family = "oracle",
                    .order = stepper.order,
                    .order_with_velocity_forces = stepper.order,
                    .stages = stepper.stages,
                    .is_explicit = stepper.is_explicit,
                    .is_multistep = has_history,
                    .is_adaptive = true,
                    .has_fixed_step = stepper.has_fixed_step,
                    .dense_output = stepper.has_fixed_step ? DenseOutput::side_steps : DenseOutput::side_runs,
                    .is_symplectic = stepper.is_symplectic,
                    .is_symmetric = stepper.is_symplectic,
                    .is_a_stable = stepper.is_a_stable,
                    .is_l_stable = stepper.is_l_stable,
                    .formula = fmt::format("gsl_odeiv2_step_{}", name),
                    .reference = "[Galassi et al. 2009]"};
    return std::make_unique<OracleIntegrator>(
        std::move(info),
        [&stepper](const Ivp& ivp, const StepControl& control,
                   Work& work) -> std::unique_ptr<ForeignStepper> {
          return std::make_unique<OdeivStepper>(stepper, ivp, control, work);
        },
        ToleranceScaling{.factor = options.tolerance_factor});
  }
  throw InputError(fmt::format("GSL has no stepper \"{}\"", name));
}

}  // namespace fw::oracles
