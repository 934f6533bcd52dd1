#include "integrators/tableau/linear_multistep.hpp"

#include <algorithm>
#include <vector>

#include "integrators/implicit/implicit_update.hpp"
#include "integrators/loop/starting_steps.hpp"
#include "integrators/loop/stepper.hpp"
#include "integrators/tableau/extended_precision_steps.hpp"
#include "schemes/multistep_properties.hpp"

namespace fw::integrators {

namespace {

struct Formula {
  std::vector<double> alpha{}, beta{};
  int order = 0;
  double sum_before = 0.0;  ///< −Σ_{j<k} α_j, which is 1 for every consistent formula; without rounding

  std::size_t steps() const { return alpha.size() - 1; }
  bool is_explicit() const { return beta.back() == 0.0; }
};

/// The last k vectors of a run, [0] the oldest of them.
class History {
 public:
  History(std::size_t length, Index size) : values_(length, Vector::Zero(size)) {}

  void push(ConstVectorRef value) {
    values_[first_] = value;
    first_ = (first_ + 1) % values_.size();
    ++count_;
  }
  bool full() const { return count_ >= values_.size(); }
  void clear() { first_ = count_ = 0; }
  void serialise(StateArchive& archive) {
    archive.visit("history", values_);
    archive.visit("place of the oldest", first_);
    archive.visit("length of the history", count_);
  }
  const Vector& operator[](std::size_t j) const { return values_[(first_ + j) % values_.size()]; }

 private:
  std::vector<Vector> values_;
  std::uint64_t first_ = 0, count_ = 0;
};

class LinearMultistepStepper final : public Stepper {
 public:
  LinearMultistepStepper(const Formula& formula, const Ivp& ivp, Work& work)
      : formula_(formula),
        system_(*ivp.system),
        work_(work),
        states_(formula.steps(), ivp.y0.size()),
        slopes_(formula.steps(), ivp.y0.size()),
        base_(ivp.y0.size()),
        slope_(Vector::Zero(ivp.y0.size())) {
    if (!formula.is_explicit()) update_ = make_implicit_update(system_, work);
    if (formula.steps() > 1) {
      const int order = std::max(1, formula.order);  // of a formula with a seeded mistake it may be 0
      start_ = formula.is_explicit() ? make_explicit_starting_steps(ivp, order, work)
                                     : make_implicit_starting_steps(ivp, order, work);
    }
  }

  Status step(double t, double h, VectorRef y) override {
    // f_n: of an implicit formula it is known from the step before.
    if (formula_.is_explicit() || !slope_is_known_) {
      system_.rhs(t, y, slope_);
      ++work_.rhs_evaluations;
    }
    states_.push(y);
    slopes_.push(slope_);
    if (!states_.full()) return start_->step(t, h, y);

    const std::size_t k = formula_.steps();
    // −Σ_{j<k} α_j y_{n+j} in differences to the last state, so that what rests stays at rest to the last
    // bit.
    base_ = formula_.sum_before * y;
    for (std::size_t j = 0; j < k; ++j) {
      if (j + 1 < k && formula_.alpha[j] != 0.0) base_ -= formula_.alpha[j] * (states_[j] - y);
      if (formula_.beta[j] != 0.0) base_ += (h * formula_.beta[j]) * slopes_[j];
    }
    if (formula_.is_explicit()) {
      y = base_;
      return {};
    }
    y += h * slope_;
    slope_is_known_ = true;
    return update_->solve(t + h, h * formula_.beta[k], base_, y, slope_);
  }

  void restart(double t, ConstVectorRef y) override {
    states_.clear();
    slopes_.clear();
    slope_is_known_ = false;
    if (update_) update_->forget_matrix();
    if (start_) start_->restart(t, y);
  }
  void serialise(StateArchive& archive) override {
    states_.serialise(archive);
    slopes_.serialise(archive);
    archive.visit("slope", slope_);
    archive.visit("slope is known", slope_is_known_);
    if (update_) update_->serialise(archive);
    if (start_) start_->serialise(archive);
  }

 private:
  const Formula formula_;
  const OdeSystem& system_;
  Work& work_;
  History states_, slopes_;
  Vector base_, slope_;
  bool slope_is_known_ = false;
  std::unique_ptr<ImplicitUpdate> update_;
  std::unique_ptr<Stepper> start_;
};

/// The formula in binary128. Implicit ones by fixed-point iteration down to rounding: for problems that are
/// not stiff.
std::vector<Float128> solve_extended(const schemes::MultistepFormula& formula, const Ivp& ivp,
                                     std::uint64_t steps) {
  const auto k = static_cast<std::size_t>(formula.steps());
  const bool is_explicit = formula.beta[k].value() == 0;
  const int order = std::max(1, schemes::order_of_accuracy(formula));
  std::vector<std::vector<Float128>> states, slopes;  // oldest first
  const OdeSystem& system = *ivp.system;
  return run_extended_steps(ivp, steps, [&](const Float128& t, const Float128& h, std::vector<Float128>& y) {
    const std::size_t n = y.size();
    std::vector<Float128> slope(n);
    system.rhs(t, y, slope);
    states.push_back(y);
    slopes.push_back(slope);
    if (states.size() < k) {
      extended_starting_step(system, is_explicit, order, t, h, y);
      return;
    }
    std::vector<Float128> known(n, Float128(0));
    for (std::size_t j = 0; j < k; ++j) {
      for (std::size_t i = 0; i < n; ++i) {
        known[i] += h * formula.beta[j].value() * slopes[j][i] - formula.alpha[j].value() * states[j][i];
      }
    }
    states.erase(states.begin());
    slopes.erase(slopes.begin());
    const Float128 weight = h * formula.beta[k].value();
    if (weight == 0) {
      y = known;
      return;
    }
    for (std::size_t i = 0; i < n; ++i) y[i] += h * slope[i];
    extended_fixed_point(system, Float128(t + h), known, weight, y, slope);
  });
}

}  // namespace

std::unique_ptr<Integrator> make_linear_multistep(const schemes::MultistepFormula& formula) {
  Formula numbers{.order = schemes::order_of_accuracy(formula)};
  for (const schemes::Coefficient& alpha : formula.alpha) numbers.alpha.push_back(schemes::as<double>(alpha));
  schemes::Rational sum = 0;
  for (std::size_t j = 0; j + 1 < formula.alpha.size(); ++j)
    sum -= schemes::as<schemes::Rational>(formula.alpha[j]);
  numbers.sum_before = sum.convert_to<double>();
  for (const schemes::Coefficient& beta : formula.beta) numbers.beta.push_back(schemes::as<double>(beta));
  MethodInfo info{.name = formula.name,
                  .title = formula.title,
                  .family = "linear multistep",
                  .order = numbers.order,
                  .order_with_velocity_forces = numbers.order,
                  .stages = 1,
                  .is_explicit = numbers.is_explicit(),
                  .is_multistep = numbers.steps() > 1,
                  .is_symmetric = schemes::is_symmetric(formula),
                  .is_a_stable = schemes::is_a_stable(formula),
                  .is_l_stable = schemes::is_l_stable(formula),
                  .formula = "sum_j alpha_j y_{n+j} = h sum_j beta_j f(t_{n+j}, y_{n+j})",
                  .reference = formula.reference};
  return std::make_unique<FixedStepIntegrator>(
      std::move(info),
      [numbers](const Ivp& ivp, double, Work& work) -> std::unique_ptr<Stepper> {
        return std::make_unique<LinearMultistepStepper>(numbers, ivp, work);
      },
      [formula](const Ivp& ivp, std::uint64_t steps) { return solve_extended(formula, ivp, steps); });
}

}  // namespace fw::integrators
