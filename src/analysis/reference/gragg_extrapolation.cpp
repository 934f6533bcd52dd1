#include "analysis/reference/gragg_extrapolation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "integrators/loop/switch_cutter.hpp"

namespace fw::analysis {
namespace {

using State = std::vector<Float128>;

/// The increment over one basic step H, computed row by row.
class Tableau {
 public:
  Tableau(const OdeSystem& system, const ExtrapolationTableau& scheme, Work& work)
      : system_(system), scheme_(scheme), work_(work), size_(static_cast<std::size_t>(system.size())) {
    rows_.assign(scheme.rows(), State(size_));
    for (State* state : {&start_slope_, &before_, &now_, &slope_, &argument_}) state->resize(size_);
    if (!rows_.empty()) previous_best_.resize(size_);
  }

  void start(const Float128& t, const State& y) {
    work_.rhs_evaluations += 1;
    system_.rhs(t, y, std::span<Float128>(start_slope_));
  }
  const State& start_slope() const { return start_slope_; }

  /// Row j: Gragg's modified midpoint rule with its smoothing step, then Aitken–Neville along the row.
  /// rows_[k] holds T_{j,k} afterwards; the rule works on increments z = y − y(t), which saves digits.
  void compute_row(std::size_t j, const Float128& t, const State& y, const Float128& H) {
    const int n = scheme_.substeps[j];
    const Float128 h = H / n;
    for (std::size_t i = 0; i < size_; ++i) {
      before_[i] = 0;
      now_[i] = h * start_slope_[i];
    }
    for (int m = 1; m < n; ++m) {
      evaluate(t + m * h, y);
      for (std::size_t i = 0; i < size_; ++i) {
        const Float128 next = before_[i] + 2 * h * slope_[i];
        before_[i] = now_[i];
        now_[i] = next;
      }
    }
    evaluate(t + H, y);
    for (std::size_t i = 0; i < size_; ++i) {
      // Entry T_{j-1,k-1} is needed one column later than it is overwritten.
      Float128 value = (before_[i] + now_[i] + h * slope_[i]) / 2;
      Float128 upper = 0;
      if (j > 0) {
        upper = rows_[0][i];
        rows_[0][i] = value;
        for (std::size_t k = 1; k <= j; ++k) {
          previous_best_[i] = value;  // T_{j,k−1}
          value += (value - upper) / scheme_.divisor[j][k];
          upper = rows_[k][i];
          rows_[k][i] = value;
        }
      } else {
        rows_[0][i] = value;
      }
    }
  }

  /// T_{j,j}.
  const State& best(std::size_t j) const { return rows_[j]; }
  /// T_{j,j−1}.
  const State& second_best() const { return previous_best_; }

 private:
  void evaluate(const Float128& t, const State& y) {
    for (std::size_t i = 0; i < size_; ++i) argument_[i] = y[i] + now_[i];
    work_.rhs_evaluations += 1;
    system_.rhs(t, argument_, std::span<Float128>(slope_));
  }

  const OdeSystem& system_;
  const ExtrapolationTableau& scheme_;
  Work& work_;
  std::size_t size_;
  std::vector<State> rows_;
  State previous_best_, start_slope_, before_, now_, slope_, argument_;
};

/// The estimated error of y + T_{j,j} in units of the tolerance: max_i |T_{j,j} − T_{j,j−1}|_i / tolerance_i,
/// where tolerance_i = tolerance · largest |y_i| so far, plus what binary128 can resolve of the largest
/// component. Not a number where the state overflowed.
double error_in_tolerances(const State& y, const State& scale, const State& best, const State& second_best,
                           double tolerance) {
  const std::size_t size = y.size();
  Float128 largest = 0;
  for (std::size_t i = 0; i < size; ++i)
    largest = std::max(largest, std::max(scale[i], Float128(abs(y[i] + best[i]))));
  const Float128 resolution = 64 * float128_epsilon * largest + Float128(std::numeric_limits<double>::min());
  Float128 error = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const Float128 component_scale = std::max(scale[i], Float128(abs(y[i] + best[i])));
    const Float128 component = abs(best[i] - second_best[i]) / (tolerance * component_scale + resolution);
    if (!(component <= error)) error = component;  // also takes over what is not a number
    if (!isfinite(error)) return std::numeric_limits<double>::quiet_NaN();
  }
  return static_cast<double>(error);
}

/// Whether row after row up to the last one may bring the error below the tolerance. The last row gained the
/// factor q = error/error_before; for a smooth right-hand side row r gains q·(n_row/n_r)² by theory. A
/// hundredfold is left to the estimate.
bool may_still_converge(const ExtrapolationTableau& scheme, std::size_t row, double error_before,
                        double error) {
  double predicted = std::log(error);
  for (std::size_t r = row + 1; r < scheme.rows(); ++r) {
    predicted +=
        std::log(error / error_before) + 2.0 * std::log(double(scheme.substeps[row]) / scheme.substeps[r]);
  }
  return predicted <= std::log(100.0);
}

/// How a step that was computed came out: the row at which it ended and that row's error.
struct Attempt {
  std::size_t row = 0;
  double error = std::numeric_limits<double>::quiet_NaN();  ///< in tolerances; not a number after an overflow
};

/// Computes rows for a step H from (t, y) until one passes the error test, or none can any more.
Attempt attempt_step(Tableau& tableau, const ExtrapolationSettings& settings, const Float128& t,
                     const State& y, const Float128& H, const State& scale) {
  // Rows before the fifth are not trusted to have converged: their two values may agree by accident.
  const std::size_t last_row = settings.tableau.rows() - 1;
  const std::size_t first_trusted_row = std::min<std::size_t>(4, last_row);
  Attempt attempt;
  for (std::size_t row = 0; row <= last_row; ++row) {
    tableau.compute_row(row, t, y, H);
    if (row + 1 < first_trusted_row) continue;
    const double error_before = attempt.error;
    attempt = {row,
               error_in_tolerances(y, scale, tableau.best(row), tableau.second_best(), settings.tolerance)};
    if (!std::isfinite(attempt.error)) break;
    if (row < first_trusted_row) continue;
    if (attempt.error <= 1.0 || !may_still_converge(settings.tableau, row, error_before, attempt.error))
      break;
  }
  return attempt;
}

/// By which factor the step after an accepted one may differ from it. A step is meant to end with one row to
/// spare.
double growth(const Attempt& attempt, std::size_t last_row) {
  if (attempt.error > 1.0) return 2.0;  // forced
  const double order = 2.0 * static_cast<double>(attempt.row) + 1.0;
  const double factor = std::clamp(0.8 * std::pow(std::max(attempt.error, 1e-30), -1.0 / order), 0.2, 4.0);
  if (attempt.row == last_row) return factor;
  if (attempt.row + 1 == last_row) return std::clamp(factor, 1.0, 1.1);
  return std::max(factor, 1.5);
}

/// y += increment by compensated summation; `carry` is what the additions to y have lost so far.
void add_compensated(State& y, State& carry, const State& increment) {
  for (std::size_t i = 0; i < y.size(); ++i) {
    const Float128 addend = increment[i] + carry[i];
    const Float128 sum = y[i] + addend;
    carry[i] = abs(y[i]) >= abs(addend) ? Float128((y[i] - sum) + addend) : Float128((addend - sum) + y[i]);
    y[i] = sum;
  }
}

/// The largest velocity met, or what crosses the positions in the interval.
double velocity_scale(const State& scale, double interval) {
  const auto half = scale.begin() + static_cast<std::ptrdiff_t>(scale.size() / 2);
  const auto velocity = static_cast<double>(*std::max_element(half, scale.end()));
  return velocity > 0.0 ? velocity : static_cast<double>(*std::max_element(scale.begin(), half)) / interval;
}

using Cutter = integrators::SwitchCutter<Float128>;

/// Cuts steps at the switches that the system announces.
class Cuts {
 public:
  Cuts(const OdeSystem& system, double tolerance, double t0, double t1)
      : surfaces_(system.switching_surfaces()), tolerance_(tolerance), interval_(t1 - t0) {
    if (surfaces_ != nullptr) {
      cutter_.emplace(0.0, tolerance, 1e4 * float128_epsilon * std::max(std::abs(t0), std::abs(t1)));
    }
  }

  Float128 limit() const { return cutter_ ? cutter_->limit() : Float128(std::numeric_limits<double>::infinity()); }
  Cutter::Verdict judge(const Float128& t, const Float128& H, const State& y, const State& increment,
                        const State& scale) {
    if (!cutter_) return Cutter::Verdict::accepted;
    y_new_.resize(y.size());
    for (std::size_t i = 0; i < y.size(); ++i) y_new_[i] = y[i] + increment[i];
    cutter_->set_absolute_tolerance(tolerance_ * velocity_scale(scale, interval_));
    return cutter_->judge(*surfaces_, {t, H, y.data(), y_new_.data()});
  }
  std::string last() const { return place_of(cutter_->last()); }

 private:
  const SwitchingSurfaces* surfaces_;
  double tolerance_, interval_;
  std::optional<Cutter> cutter_;
  State y_new_;
};

double first_step(const State& y, const State& slope, double largest_step) {
  double state_norm = 0.0, slope_norm = 0.0;
  for (std::size_t i = 0; i < y.size(); ++i) {
    state_norm = std::max(state_norm, std::abs(static_cast<double>(y[i])));
    slope_norm = std::max(slope_norm, std::abs(static_cast<double>(slope[i])));
  }
  const double guess = 0.1 * state_norm / slope_norm;
  return std::isfinite(guess) && guess > 0.0 ? std::min(guess, largest_step) : largest_step;
}

}  // namespace

ExtrapolationTableau harmonic_extrapolation(int rows) {
  ExtrapolationTableau scheme;
  for (int j = 0; j < rows; ++j) {
    scheme.substeps.push_back(2 * (j + 1));
    std::vector<Float128> divisor(static_cast<std::size_t>(j) + 1, 0);
    for (int k = 1; k <= j; ++k) {
      const Float128 ratio = Float128(j + 1) / Float128(j - k + 1);
      divisor[static_cast<std::size_t>(k)] = ratio * ratio - 1;
    }
    scheme.divisor.push_back(std::move(divisor));
  }
  return scheme;
}

ExtrapolationRun integrate_by_extrapolation(const Ivp& ivp, std::span<const double> times,
                                            const ExtrapolationSettings& settings) {
  ExtrapolationRun run;
  Tableau tableau(*ivp.system, settings.tableau, run.work);
  const std::size_t last_row = settings.tableau.rows() - 1;
  State y = initial_state_extended(ivp);
  State carry(y.size(), 0);
  for (const Float128& component : y) run.scale.push_back(abs(component));

  Float128 t = ivp.t0;
  const double end = times.empty() ? ivp.t0 : times.back();
  const Float128 interval = Float128(end) - ivp.t0;
  const Float128 smallest_step = 32 * float128_epsilon * std::max(std::abs(ivp.t0), std::abs(end));
  Float128 proposal = 0;
  bool slope_is_current = false;
  int rejections_in_a_row = 0;
  Cuts cuts(*ivp.system, settings.tolerance, ivp.t0, end);
  const auto fail = [&](StatusCode code, const std::string& what) {
    run.status = {code, fmt::format("{} at t = {:.6g} of {:.6g}", what, static_cast<double>(t), end)};
    return run;
  };

  for (const double target : times) {
    const Float128 largest_step = std::min(Float128(interval / settings.least_steps),
                                           Float128((target - t) / settings.least_steps_per_output));
    while (t < target) {
      if (run.work.accepted_steps + run.work.rejected_steps >= settings.step_limit) {
        return fail(StatusCode::step_limit, fmt::format("{} steps taken", settings.step_limit));
      }
      if (!slope_is_current) {
        tableau.start(t, y);
        slope_is_current = true;
        if (proposal == 0) proposal = first_step(y, tableau.start_slope(), static_cast<double>(largest_step));
      }
      // A step never leaves a remainder much shorter than itself.
      const Float128 remaining = target - t;
      const Float128 wish = std::max(smallest_step, std::min(proposal, largest_step));
      const bool reaches_target = wish >= remaining;
      const Float128 t_wished = reaches_target
                                    ? Float128(target)
                                    : Float128(t + (2 * wish > remaining ? Float128(remaining / 2) : wish));
      const Float128 t_new = std::min(t_wished, cuts.limit());
      const Float128 H = t_new - t;
      const bool is_shortened = H < proposal;

      const Attempt attempt = attempt_step(tableau, settings, t, y, H, run.scale);
      const bool is_finite = std::isfinite(attempt.error);
      const bool is_smallest = H <= 2 * smallest_step;
      if (is_finite && (attempt.error <= 1.0 || is_smallest)) {
        if (attempt.error > 1.0 && ++run.forced_steps > settings.forced_step_limit) {
          return fail(StatusCode::step_too_small, "the error test still fails with the smallest steps");
        }
        const Cutter::Verdict verdict = cuts.judge(t, H, y, tableau.best(attempt.row), run.scale);
        if (verdict == Cutter::Verdict::again) {
          run.work.rejected_steps += 1;
          continue;
        }
        if (verdict == Cutter::Verdict::chatters) {
          return fail(StatusCode::step_too_small, fmt::format("the right-hand side switches without end, last at {},", cuts.last()));
        }
        add_compensated(y, carry, tableau.best(attempt.row));
        for (std::size_t i = 0; i < y.size(); ++i) run.scale[i] = std::max(run.scale[i], Float128(abs(y[i])));
        t = t_new;
        run.work.accepted_steps += 1;
        slope_is_current = false;
        rejections_in_a_row = 0;
        const Float128 next = H * growth(attempt, last_row);
        proposal = std::min(interval, is_shortened ? std::max(proposal, next) : next);
        if (verdict == Cutter::Verdict::crossed) proposal = std::min(proposal, Float128(cuts.limit() - t));
      } else {
        run.work.rejected_steps += 1;
        if (is_smallest)
          return fail(StatusCode::non_finite, "the state is no longer finite after a smallest step");
        // The estimate tells little where a step was given up early: shrink faster the longer that goes on.
        constexpr double shrink[] = {0.7, 0.5, 0.3, 0.1};
        proposal = H * (is_finite ? shrink[std::min(rejections_in_a_row, 3)] : 0.1);
        rejections_in_a_row += 1;
      }
    }
    run.states.push_back(y);
  }
  return run;
}

}  // namespace fw::analysis
