#pragma once

#include <Eigen/Dense>
#include <array>
#include <cmath>

#include "conformance/seeded_bug.hpp"
#include "integrators/loop/hermite_interpolant.hpp"
#include "schemes/butcher_tableau.hpp"
#include "schemes/multistep_formula.hpp"

namespace fw::conformance {

/// A stepper given by a function.
class FunctionStepper final : public integrators::Stepper {
 public:
  using Step = std::function<Status(double t, double h, VectorRef y)>;
  explicit FunctionStepper(Step step) : step_(std::move(step)) {}
  Status step(double t, double h, VectorRef y) override { return step_(t, h, y); }
  void restart(double, ConstVectorRef) override {}
  void serialise(StateArchive&) override {}

 private:
  Step step_;
};

/// Constant steps by the function that `make` gives for a run.
inline std::unique_ptr<Integrator> hand_written(std::function<FunctionStepper::Step(const Ivp&, Work&)> make,
                                                Capabilities needs = {}) {
  return std::make_unique<integrators::FixedStepIntegrator>(
      MethodInfo{.name = "hand-written", .needs = needs},
      [make](const Ivp& ivp, double, Work& work) -> std::unique_ptr<integrators::Stepper> {
        return std::make_unique<FunctionStepper>(make(ivp, work));
      });
}

enum class VerletMistake {
  none,
  stale_force,
  missing_inverse_mass,
  force_at_the_old_time,
  lagged_damper,
  half_kick_missing
};

/// Velocity Verlet in its textbook form; the last half-kick is implicit where forces depend on velocity.
inline std::unique_ptr<Integrator> verlet_with(VerletMistake mistake) {
  return hand_written(
      [mistake](const Ivp& ivp, Work&) -> FunctionStepper::Step {
        const SecondOrderSystem& system = *ivp.system->second_order();
        return [&system, mistake](double t, double h, VectorRef y) -> Status {
          const Index n = system.degrees_of_freedom();
          auto q = y.head(n);
          auto v = y.tail(n);
          const Vector inverse_mass = mistake == VerletMistake::missing_inverse_mass
                                          ? Vector::Ones(n)
                                          : Vector(system.mass().cwiseInverse());
          Vector old_force(n), force(n);
          system.force(t, q, v, old_force);
          const Vector half = v + 0.5 * h * inverse_mass.cwiseProduct(old_force);
          q += h * half;
          if (mistake == VerletMistake::half_kick_missing) {
            v = half;
            return {};
          }
          const double end = mistake == VerletMistake::force_at_the_old_time ? t : t + h;
          const bool lagged = mistake == VerletMistake::lagged_damper;
          const int iterations = system.force_class() == ForceClass::velocity && !lagged ? 60 : 1;
          Vector velocity = lagged ? Vector(v) : half;
          for (int i = 0; i < iterations; ++i) {
            system.force(end, q, velocity, force);
            velocity = half + 0.5 * h *
                                  inverse_mass.cwiseProduct(mistake == VerletMistake::stale_force ? old_force
                                                                                                  : force);
          }
          v = velocity;
          return {};
        };
      },
      {Capability::second_order});
}

/// The classical method, whose third stage is evaluated at t + `third_node` h.
inline std::unique_ptr<Integrator> rk4_with_third_node(double third_node) {
  return hand_written([third_node](const Ivp& ivp, Work& work) -> FunctionStepper::Step {
    return [&system = *ivp.system, &work, third_node](double t, double h, VectorRef y) -> Status {
      std::array<Vector, 4> k;
      k.fill(Vector(y.size()));
      system.rhs(t, y, k[0]);
      system.rhs(t + 0.5 * h, Vector(y + 0.5 * h * k[0]), k[1]);
      system.rhs(t + third_node * h, Vector(y + 0.5 * h * k[1]), k[2]);
      system.rhs(t + h, Vector(y + h * k[2]), k[3]);
      work.rhs_evaluations += 4;
      y += h / 6.0 * (k[0] + 2.0 * k[1] + 2.0 * k[2] + k[3]);
      return {};
    };
  });
}

/// The implicit midpoint rule on second-order systems by Newton's iteration with dense matrices.
inline std::unique_ptr<Integrator> midpoint_with_newton_iterations(int iterations) {
  return hand_written(
      [iterations](const Ivp& ivp, Work&) -> FunctionStepper::Step {
        const SecondOrderSystem& system = *ivp.system->second_order();
        return [&system, iterations](double t, double h, VectorRef y) -> Status {
          const Index n = system.degrees_of_freedom();
          const double eta = 0.5 * h;
          const Vector q = y.head(n), v = y.tail(n);
          Vector middle = v, force(n);
          SparseMatrix K = system.tangent_pattern(), D = K;
          for (int i = 0; i < iterations; ++i) {
            const Vector position = q + eta * middle;
            system.force(t + eta, position, middle, force);
            system.stiffness(t + eta, position, middle, TangentModel::exact, K);
            system.damping(t + eta, position, middle, D);
            const Matrix A = Matrix(system.mass().asDiagonal()) - eta * Matrix(D) - eta * eta * Matrix(K);
            middle -= A.partialPivLu().solve(Vector(system.mass().cwiseProduct(middle - v) - eta * force));
          }
          y.head(n) = q + h * middle;
          y.tail(n) = 2.0 * middle - v;
          return {};
        };
      },
      {Capability::second_order});
}

/// A linear multistep formula by fixed-point iterations, with the classical method or Euler's for its start.
class HandWrittenMultistep final : public integrators::Stepper {
 public:
  HandWrittenMultistep(const schemes::MultistepFormula& formula, bool starts_by_euler, const Ivp& ivp)
      : system_(*ivp.system), starts_by_euler_(starts_by_euler) {
    for (const schemes::Coefficient& a : formula.alpha) alpha_.push_back(schemes::as<double>(a));
    for (const schemes::Coefficient& b : formula.beta) beta_.push_back(schemes::as<double>(b));
  }

  Status step(double t, double h, VectorRef y) override {
    const std::size_t k = alpha_.size() - 1;
    states_.emplace_back(y);
    slopes_.push_back(slope(t, y));
    if (states_.size() < k) {
      if (starts_by_euler_) {
        y += h * slopes_.back();
      } else {
        start(t, h, y);
      }
      return {};
    }
    const std::size_t first = states_.size() - k;
    Vector base = Vector::Zero(y.size());
    for (std::size_t j = 0; j < k; ++j)
      base += h * beta_[j] * slopes_[first + j] - alpha_[j] * states_[first + j];
    if (beta_[k] == 0.0) {
      y = base;
      return {};
    }
    y += h * slopes_.back();
    for (int i = 0; i < 300; ++i) {
      const Vector next = base + h * beta_[k] * slope(t + h, y);
      const double change = (next - y).lpNorm<Eigen::Infinity>();
      y = next;
      if (change <= 1e-15 * (1.0 + y.lpNorm<Eigen::Infinity>())) return {};
    }
    return y.allFinite() ? Status{} : Status{StatusCode::newton_failed, "the fixed-point iteration diverges"};
  }
  void restart(double, ConstVectorRef) override {
    states_.clear();
    slopes_.clear();
  }
  void serialise(StateArchive&) override {}

 private:
  Vector slope(double t, ConstVectorRef y) const {
    Vector k(y.size());
    system_.rhs(t, y, k);
    return k;
  }
  void start(double t, double h, VectorRef y) const {
    constexpr int substeps = 16;
    const double d = h / substeps;
    for (int i = 0; i < substeps; ++i) {
      const double s = t + i * d;
      const Vector k1 = slope(s, y), k2 = slope(s + 0.5 * d, y + 0.5 * d * k1);
      const Vector k3 = slope(s + 0.5 * d, y + 0.5 * d * k2), k4 = slope(s + d, y + d * k3);
      y += d / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    }
  }

  const OdeSystem& system_;
  bool starts_by_euler_;
  std::vector<double> alpha_{}, beta_{};
  std::vector<Vector> states_{}, slopes_{};
};

/// `clips`: takes a shorter last step where it has to refuse, with a formula for equal steps.
inline std::unique_ptr<Integrator> multistep_by_hand(const std::string& name, bool starts_by_euler,
                                                     bool clips) {
  const auto formula = tableau_of<schemes::MultistepFormula>(name);
  return std::make_unique<integrators::FixedStepIntegrator>(
      MethodInfo{.name = name, .is_multistep = !clips},
      [formula, starts_by_euler](const Ivp& ivp, double, Work&) -> std::unique_ptr<integrators::Stepper> {
        return std::make_unique<HandWrittenMultistep>(formula, starts_by_euler, ivp);
      });
}

enum class PairMistake { none, slope_not_refreshed, evaluates_twice, forgets_to_count };

/// An explicit pair whose last stage is the new state, by plain loops.
class HandWrittenPair final : public integrators::AdaptiveStepper {
 public:
  HandWrittenPair(const schemes::ButcherTableau& tableau, PairMistake mistake, const Ivp& ivp, Work& work)
      : t_(schemes::values<double>(tableau)),
        mistake_(mistake),
        system_(*ivp.system),
        work_(work),
        k_(static_cast<std::size_t>(t_.stages), Vector(ivp.y0.size())) {}

  Status step(double t, double h, VectorRef y) override {
    Vector y_new(y.size()), error(y.size());
    Status status = attempt(t, h, Vector(y), y_new, error);
    y = y_new;
    accept();
    return status;
  }
  Status attempt(double t, double h, ConstVectorRef y, VectorRef y_new, VectorRef error) override {
    if (!has_first_slope_ || mistake_ == PairMistake::evaluates_twice) {
      system_.rhs(t, y, k_[0]);
      ++work_.rhs_evaluations;
    }
    has_first_slope_ = true;
    y_new = y;
    error.setZero();
    for (std::size_t i = 1; i < k_.size(); ++i) {
      Vector stage = y;
      for (std::size_t j = 0; j < i; ++j) stage += h * t_.A(static_cast<int>(i), static_cast<int>(j)) * k_[j];
      system_.rhs(t + t_.c[i] * h, stage, k_[i]);
      if (i > 1 || mistake_ != PairMistake::forgets_to_count) ++work_.rhs_evaluations;
    }
    for (std::size_t i = 0; i < k_.size(); ++i) {
      y_new += h * t_.b[i] * k_[i];
      error += h * (t_.b[i] - t_.b_embedded[i]) * k_[i];
    }
    // The mistake: the slope at the end of a step that may yet be rejected.
    if (mistake_ == PairMistake::slope_not_refreshed) k_.front() = k_.back();
    return {};
  }
  void accept() override { k_.front() = k_.back(); }
  void restart(double, ConstVectorRef) override { has_first_slope_ = false; }
  void serialise(StateArchive& archive) override {
    archive.visit("slopes", k_);
    archive.visit("first slope is known", has_first_slope_);
  }

 private:
  schemes::TableauValues<double> t_;
  PairMistake mistake_;
  const OdeSystem& system_;
  Work& work_;
  std::vector<Vector> k_;
  bool has_first_slope_ = false;
};

inline std::unique_ptr<Integrator> pair_by_hand(const std::string& name, PairMistake mistake) {
  const auto tableau = tableau_of<schemes::ButcherTableau>(name);
  return std::make_unique<integrators::AdaptiveIntegrator>(
      right_scheme(name)->info(), integrators::ControllerOptions{},
      [tableau, mistake](const Ivp& ivp, Work& work) -> std::unique_ptr<integrators::AdaptiveStepper> {
        return std::make_unique<HandWrittenPair>(tableau, mistake, ivp, work);
      });
}

/// The straight line in place of dense output.
class StraightLineObserver final : public Observer {
 public:
  explicit StraightLineObserver(Observer& observer) : observer_(observer) {}
  bool observe(const StepView& view) override {
    const Vector state = view.state;
    const std::function<void(double, VectorRef)> line = [&](double t, VectorRef out) {
      const double theta = (t - time_) / (view.time - time_);
      out = (1.0 - theta) * state_ + theta * state;
    };
    const bool go_on = observer_.observe({view.index, view.time, view.state, view.last, line});
    time_ = view.time;
    state_ = state;
    return go_on;
  }

 private:
  Observer& observer_;
  double time_ = 0.0;
  Vector state_{};
};

/// The cubic Hermite polynomial in place of dense output.
class CubicObserver final : public Observer {
 public:
  CubicObserver(const OdeSystem& system, Observer& observer) : cubic_(system, work_), observer_(observer) {}
  bool observe(const StepView& view) override {
    const Vector state = view.state;
    if (view.index > 0) cubic_.set_step(time_, view.time, state_, state);
    const std::function<void(double, VectorRef)> inside = [&](double t, VectorRef out) { cubic_(t, out); };
    const bool go_on = observer_.observe({view.index, view.time, view.state, view.last, inside});
    time_ = view.time;
    state_ = state;
    return go_on;
  }

 private:
  Work work_;
  integrators::HermiteInterpolant cubic_;
  Observer& observer_;
  double time_ = 0.0;
  Vector state_{};
};

/// A scheme of the catalogue with cubic polynomials in place of its dense output.
inline std::unique_ptr<Integrator> with_cubic_dense_output(std::unique_ptr<Integrator> method) {
  const std::shared_ptr<const Integrator> right = std::move(method);
  return std::make_unique<ClaimingIntegrator>(
      right->info(), right->extended_solver(),
      [right](const Ivp& ivp, const StepControl& control, Observer& observer) {
        CubicObserver cubic(*ivp.system, observer);
        return right->solve(ivp, control, cubic);
      });
}

}  // namespace fw::conformance
