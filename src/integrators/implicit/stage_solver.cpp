#include "integrators/implicit/stage_solver.hpp"

#include <cmath>
#include <limits>

#include "integrators/implicit/implicit_stage.hpp"

namespace fw::integrators {

namespace {

constexpr double rounding = std::numeric_limits<double>::epsilon();

linalg::SimplifiedNewtonOptions newton_options(const ImplicitOptions& options) {
  return {.tolerance = options.newton_tolerance, .rate_of_renewal = options.rate_of_renewal};
}

/// Unknown Y, residual Y − ȳ − η f(t, Y), matrix I − η J.
class FirstOrderStages final : public StageSolver {
 public:
  FirstOrderStages(const OdeSystem& system, const ImplicitOptions& options, Work& work)
      : system_(system),
        work_(work),
        newton_(system.size(), newton_options(options)),
        equation_(system, work),
        state_(system.size()) {}

  void slope(double t, ConstVectorRef y, VectorRef k) override {
    system_.rhs(t, y, k);
    ++work_.rhs_evaluations;
  }
  Status solve(double t, double eta, ConstVectorRef start, VectorRef k) override {
    equation_.set(t, eta, start);
    state_ = equation_.start() + eta * k;
    const double scale = equation_.start().lpNorm<Eigen::Infinity>();
    if (Status status = newton_.solve(equation_, state_, eta, scale, rounding * scale, work_); !status.ok()) {
      return status;
    }
    k = (state_ - equation_.start()) / eta;
    return {};
  }
  Status filter(double, VectorRef e) override {
    if (!newton_.has_matrix()) return {};
    state_ = e;
    return newton_.solve_linear(state_, e, work_);
  }
  void forget_matrix() override { newton_.forget_matrix(); }
  void serialise(StateArchive& archive) override { newton_.serialise(archive); }

 private:
  const OdeSystem& system_;
  Work& work_;
  linalg::SimplifiedNewton newton_;
  ImplicitStage equation_;
  Vector state_;
};

/// Unknown V, residual M (V − v̄) − η f(t, q̄ + η V, V), matrix M − η D − η² K.
class SecondOrderStages final : public StageSolver, private linalg::NewtonProblem {
 public:
  SecondOrderStages(const SecondOrderSystem& system, const ForceSplitting* splitting,
                    const ImplicitOptions& options, Work& work)
      : system_(system),
        splitting_(splitting),
        work_(work),
        newton_(system.degrees_of_freedom(), newton_options(options)),
        matrix_(system, splitting),
        force_(system.degrees_of_freedom()),
        start_position_(system.degrees_of_freedom()),
        start_velocity_(system.degrees_of_freedom()),
        position_(system.degrees_of_freedom()),
        velocity_(system.degrees_of_freedom()) {}

  void slope(double t, ConstVectorRef y, VectorRef k) override {
    const Index n = force_.size();
    evaluate(t, y.head(n), y.tail(n));
    k.head(n) = y.tail(n);
    k.tail(n) = force_.cwiseQuotient(system_.mass());
  }
  Status solve(double t, double eta, ConstVectorRef start, VectorRef k) override {
    const Index n = force_.size();
    start_position_ = start.head(n);
    start_velocity_ = start.tail(n);
    time_ = t;
    eta_ = eta;
    velocity_ = start_velocity_ + eta * k.tail(n);
    const double scale = start_velocity_.lpNorm<Eigen::Infinity>();
    // Velocities below this do not change the positions: at rest the residual is the rounding of forces.
    const double floor = 16.0 * rounding * start_position_.lpNorm<Eigen::Infinity>() / std::abs(eta);
    if (Status status = newton_.solve(*this, velocity_, eta, scale, floor, work_); !status.ok()) {
      return status;
    }
    k.tail(n) = force_.cwiseQuotient(system_.mass());
    k.head(n) = start_velocity_ + eta * k.tail(n);
    return {};
  }
  Status filter(double eta, VectorRef e) override {
    if (!newton_.has_matrix()) return {};
    const Index n = force_.size();
    // x_q − η x_v = e_q and M x_v − η (K x_q + D x_v) = M e_v.
    force_.noalias() = matrix_.stiffness() * e.head(n);
    position_ = system_.mass().cwiseProduct(e.tail(n)) + eta * force_;
    Status status = newton_.solve_linear(position_, velocity_, work_);
    e.head(n) += eta * velocity_;
    e.tail(n) = velocity_;
    return status;
  }
  void forget_matrix() override { newton_.forget_matrix(); }
  void serialise(StateArchive& archive) override {
    matrix_.serialise(archive);
    newton_.serialise(archive);
  }

 private:
  void evaluate(double t, ConstVectorRef q, ConstVectorRef v) {
    if (splitting_ != nullptr) {
      splitting_->stiff_force(t, q, v, force_);
    } else {
      system_.force(t, q, v, force_);
    }
    ++work_.rhs_evaluations;
  }
  void residual(ConstVectorRef v, VectorRef out) override {
    position_ = start_position_ + eta_ * v;
    evaluate(time_, position_, v);
    out = system_.mass().cwiseProduct(v - start_velocity_) - eta_ * force_;
  }
  const SparseMatrix& matrix(ConstVectorRef v) override {
    position_ = start_position_ + eta_ * v;
    ++work_.jacobian_evaluations;
    return matrix_.assemble(time_, position_, v, eta_, TangentModel::exact);
  }
  std::uint64_t pattern_revision() const override { return system_.pattern_revision(); }

  const SecondOrderSystem& system_;
  const ForceSplitting* splitting_;
  Work& work_;
  linalg::SimplifiedNewton newton_;
  StepMatrix matrix_;
  Vector force_, start_position_, start_velocity_, position_, velocity_;
  double time_ = 0.0, eta_ = 0.0;
};

}  // namespace

std::unique_ptr<StageSolver> make_stage_solver(const OdeSystem& system, const ImplicitOptions& options,
                                               Work& work) {
  if (system.second_order() != nullptr) {
    return std::make_unique<SecondOrderStages>(*system.second_order(), nullptr, options, work);
  }
  return std::make_unique<FirstOrderStages>(system, options, work);
}

std::unique_ptr<StageSolver> make_stiff_stage_solver(const SecondOrderSystem& system,
                                                     const ForceSplitting& splitting,
                                                     const ImplicitOptions& options, Work& work) {
  return std::make_unique<SecondOrderStages>(system, &splitting, options, work);
}

}  // namespace fw::integrators
