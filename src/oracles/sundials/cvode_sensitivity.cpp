#include "oracles/sundials/cvode_sensitivity.hpp"

#include <cvodes/cvodes.h>
#include <fmt/format.h>

#include <cmath>

#include "core/error.hpp"
#include "integrators/loop/mass_spring_access.hpp"
#include "oracles/sundials/cvode_session.hpp"
#include "oracles/sundials/eigen_vector.hpp"

namespace fw::oracles {

namespace {

using namespace detail;
using mechanics::SpringParameter;
using mechanics::SpringParameterGroup;

const std::vector<double>& numbers_of(const mechanics::Springs& springs, SpringParameter parameter) {
  switch (parameter) {
    case SpringParameter::damping:
      return springs.damping;
    case SpringParameter::rest_length:
      return springs.rest_length;
    case SpringParameter::stiffness:
      break;
  }
  return springs.stiffness;
}

/// The size of p for the error test. The indices have been checked.
double scale_of(const mechanics::Springs& springs, const SpringParameterGroup& group) {
  const std::vector<double>& numbers = numbers_of(springs, group.parameter);
  double sum = 0.0;
  if (group.springs.empty()) {
    for (const double number : numbers) sum += std::abs(number);
  } else {
    for (const int e : group.springs) sum += std::abs(numbers[static_cast<std::size_t>(e)]);
  }
  const auto count = static_cast<double>(group.springs.empty() ? numbers.size() : group.springs.size());
  return sum > 0.0 ? sum / count : 1.0;
}

/// A session with the sensitivities' right-hand side.
class SessionWithSensitivities final : public CvodeSession {
 public:
  SessionWithSensitivities(const std::vector<SpringParameterGroup>& parameters,
                           const SensitivityOptions& options, const Ivp& ivp, const AdaptiveStep& tolerances,
                           Work& work)
      : CvodeSession(options.formula, options.cvode, ivp, tolerances, work),
        springs_(integrators::require_mass_spring_system(*ivp.system, "CVODES forward sensitivities")),
        parameters_(parameters),
        corrector_(options.corrector == SensitivityCorrector::simultaneous ? CV_SIMULTANEOUS : CV_STAGGERED),
        force_(springs_.degrees_of_freedom()) {
    std::vector<N_Vector> start;
    for (const SpringParameterGroup& group : parameters_) {
      validate(group, springs_.model().springs);
      scales_.push_back(scale_of(springs_.model().springs, group));
      sensitivities_.push_back(new_vector(ivp.y0.size(), options.cvode.vector, context()));
      start.push_back(sensitivities_.back().get());
      N_VConst(0.0, start.back());
    }
    require(CVodeSensInit1(memory(), static_cast<int>(start.size()), corrector_, evaluate, start.data()),
            "CVodeSensInit1");
    require(CVodeSetSensParams(memory(), nullptr, scales_.data(), nullptr), "CVodeSetSensParams");
    require(CVodeSensEEtolerances(memory()), "CVodeSensEEtolerances");
    require(CVodeSetSensErrCon(memory(), options.error_control ? SUNTRUE : SUNFALSE), "CVodeSetSensErrCon");
  }

  /// CVODES starts anew from (t, y); the sensitivities go on from their values.
  void restart_with_sensitivities(double t, ConstVectorRef y) {
    std::vector<N_Vector> values;
    for (const VectorPointer& vector : sensitivities_) values.push_back(vector.get());
    double reached = 0.0;
    require(CVodeGetSens(memory(), &reached, values.data()), "CVodeGetSens");
    restart(t, y);
    require(CVodeSensReInit(memory(), corrector_, values.data()), "CVodeSensReInit");
  }

  /// ∂y/∂p_k at the end of the last step.
  Matrix sensitivities() {
    std::vector<N_Vector> out;
    for (const VectorPointer& vector : sensitivities_) out.push_back(vector.get());
    double t = 0.0;
    require(CVodeGetSens(memory(), &t, out.data()), "CVodeGetSens");
    Matrix columns(system().size(), static_cast<Index>(out.size()));
    for (std::size_t k = 0; k < out.size(); ++k) {
      columns.col(static_cast<Index>(k)) = view(out[k], system().size());
    }
    return columns;
  }

 private:
  static int evaluate(int, sunrealtype t, N_Vector y, N_Vector, int k, N_Vector s, N_Vector slope,
                      void* user_data, N_Vector, N_Vector) {
    auto& session = static_cast<SessionWithSensitivities&>(*static_cast<CvodeSession*>(user_data));
    return session.guard().call([&] { return session.evaluate_slope(t, y, k, s, slope); });
  }

  int evaluate_slope(double t, N_Vector y, int k, N_Vector s, N_Vector slope) {
    const Index n = springs_.degrees_of_freedom();
    const ConstVectorMap state = view(y, 2 * n);
    VectorMap out = mutable_view(slope, 2 * n);
    springs_.jacobian_product(t, state, view(s, 2 * n), out);
    ++work().jacobian_products;
    parameter_derivative(springs_.model(), parameters_[static_cast<std::size_t>(k)], state.head(n),
                         state.tail(n), force_);
    out.tail(n) += force_.cwiseQuotient(springs_.mass());
    return out.allFinite() ? 0 : 1;
  }

  const mechanics::MassSpringSystem& springs_;
  const std::vector<SpringParameterGroup>& parameters_;
  int corrector_;
  std::vector<double> scales_;  ///< kept by CVODES
  std::vector<VectorPointer> sensitivities_;
  Vector force_;
};

class SensitivityStepper final : public ForeignStepper {
 public:
  SensitivityStepper(Matrix& result, const std::vector<SpringParameterGroup>& parameters,
                     const SensitivityOptions& options, const Ivp& ivp, const StepControl& control,
                     Work& work)
      : result_(result),
        end_(ivp.t1),
        session_(parameters, options, ivp, std::get<AdaptiveStep>(control), work) {}

  Status advance(double limit, double& t, VectorRef y) override {
    Status status = session_.advance(limit, t, y);
    if (status.ok() && t >= end_) result_ = session_.sensitivities();
    return status;
  }
  void interpolate(double t, VectorRef out) override { session_.interpolate(t, out); }
  void restart(double t, ConstVectorRef y) override { session_.restart_with_sensitivities(t, y); }
  void collect_work(Work& work) const override { session_.collect_work(work); }

 private:
  Matrix& result_;
  double end_;
  SessionWithSensitivities session_;
};

}  // namespace

SolutionWithSensitivity solve_with_cvode_sensitivities(const Ivp& ivp, const AdaptiveStep& tolerances,
                                                       const std::vector<SpringParameterGroup>& parameters,
                                                       const SensitivityOptions& options) {
  if (parameters.empty()) throw InputError("sensitivities: found no parameter, expected at least one");
  if (iteration_of(options.formula, options.cvode) != CvodeIteration::newton) {
    throw InputError("sensitivities: found the fixed-point iteration, expected Newton's");
  }
  SolutionWithSensitivity result;
  const OracleIntegrator integrator(
      cvode_info(options.formula, options.cvode),
      [&](const Ivp& problem, const StepControl& control, Work& work) {
        return std::make_unique<SensitivityStepper>(result.sensitivity, parameters, options, problem, control,
                                                    work);
      },
      ToleranceScaling{.factor = options.cvode.tolerance_factor});
  NullObserver observer;
  result.solution = integrator.solve(ivp, tolerances, observer);
  return result;
}

}  // namespace fw::oracles
