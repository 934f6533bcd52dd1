#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <limits>

#include "benchmarks/cloth.hpp"
#include "benchmarks/petsc_runge_kutta.hpp"
#include "integrators/tableau/explicit_runge_kutta.hpp"
#include "schemes/explicit_tableaus.hpp"
#include "schemes/high_order_explicit_tableaus.hpp"

namespace fw::benchmarks {
namespace {

/// The 30×30 cloth. Over one second it is W3 of the performance notes, but there its motion is chaotic:
/// neighbouring solutions part by an order of magnitude or more every tenth of a second, so that after a
/// second every end error is as large as the cloth, whatever the tolerance. Errors are measured after a tenth
/// of a second.
Ivp cloth_ivp(double end_time) {
  static const Cloth cloth = make_cloth(30, 1e3, 0.1);
  Ivp ivp;
  ivp.system = cloth.system;
  ivp.y0 = cloth.state;
  ivp.t1 = end_time;
  return ivp;
}

constexpr double end_of_errors = 0.1, end_of_run = 1.0;

AdaptiveStep tolerances(double relative) {
  // The same first step for both, so that nobody pays for choosing it.
  return {.relative_tolerance = relative, .absolute_tolerance = 1e-3 * relative, .initial_step = 1e-4};
}

std::unique_ptr<Integrator> method(const std::vector<schemes::ButcherTableau>& tableaus,
                                   const std::string& name) {
  const auto found = std::ranges::find(tableaus, name, &schemes::ButcherTableau::name);
  if (found == tableaus.end()) throw std::logic_error("no tableau " + name);
  return integrators::make_explicit_runge_kutta(*found, {});
}

Solution solve_by_federwerk(const Ivp& ivp, const AdaptiveStep& control) {
  static const std::unique_ptr<Integrator> integrator =
      method(schemes::explicit_tableaus(), "dormand_prince_54");
  NullObserver observer;
  return integrator->solve(ivp, control, observer);
}

/// The root mean square of the difference to a run of another pair, of order 8, at a tolerance of 1e-12, at
/// the time `end_of_errors` (two such runs, at 1e-12 and 1e-11, differ by 3e-10 there).
double end_error(const Solution& solution) {
  static const Vector reference = [] {
    NullObserver observer;
    return method(schemes::high_order_explicit_tableaus(), "dormand_prince_853")
        ->solve(cloth_ivp(end_of_errors), tolerances(1e-12), observer)
        .state;
  }();
  return (solution.state - reference).norm() / std::sqrt(static_cast<double>(reference.size()));
}

using Solver = Solution (*)(const Ivp&, const AdaptiveStep&);

/// A run and its processor time [s], to which other programs add nothing as they do to the time of the wall.
struct TimedRun {
  Solution solution;
  double seconds;
  TimedRun(Solver solve, double end_time, double relative_tolerance) {
    const Ivp ivp = cloth_ivp(end_time);
    const std::clock_t start = std::clock();
    solution = solve(ivp, tolerances(relative_tolerance));
    seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    if (!solution.status.ok()) throw std::runtime_error(solution.status.describe());
  }
};

/// One solver at rtol = 10^−range.
void cloth_run(benchmark::State& run, Solver solve, double end_time) {
  const AdaptiveStep control = tolerances(std::pow(10.0, -static_cast<double>(run.range(0))));
  Solution solution;
  for (auto _ : run) solution = solve(cloth_ivp(end_time), control);
  if (!solution.status.ok()) run.SkipWithError(solution.status.describe().c_str());
  if (end_time == end_of_errors) run.counters["end_error"] = end_error(solution);
  run.counters["accepted"] = static_cast<double>(solution.work.accepted_steps);
  run.counters["rejected"] = static_cast<double>(solution.work.rejected_steps);
  run.counters["rhs"] = static_cast<double>(solution.work.rhs_evaluations);
}
BENCHMARK_CAPTURE(cloth_run, federwerk_tenth_of_a_second, solve_by_federwerk, end_of_errors)
    ->DenseRange(5, 8)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(cloth_run, petsc_tenth_of_a_second, solve_by_petsc_5dp, end_of_errors)
    ->DenseRange(5, 8)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(cloth_run, federwerk_one_second, solve_by_federwerk, end_of_run)
    ->Arg(6)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(cloth_run, petsc_one_second, solve_by_petsc_5dp, end_of_run)
    ->Arg(6)
    ->Unit(benchmark::kMillisecond);

/// Times and end errors of a solver at rtol 1e-5 … 1e-8.
struct WorkPrecision {
  static constexpr std::array<double, 4> relative_tolerances = {1e-5, 1e-6, 1e-7, 1e-8};
  std::array<double, 4> error{};
  std::array<double, 4> seconds{1e300, 1e300, 1e300, 1e300};

  /// Keeps the fastest of all rounds.
  void measure(Solver solve, std::size_t k) {
    const TimedRun run(solve, end_of_errors, relative_tolerances[k]);
    error[k] = end_error(run.solution);
    seconds[k] = std::min(seconds[k], run.seconds);
  }

  /// What belongs to an end error: log–log interpolation between the measured ones, NaN outside of them.
  double at_error(double wanted, const std::array<double, 4>& values) const {
    for (std::size_t k = 0; k + 1 < error.size(); ++k) {
      if (error[k] >= wanted && wanted >= error[k + 1]) {
        const double weight = std::log(error[k] / wanted) / std::log(error[k] / error[k + 1]);
        return std::exp((1.0 - weight) * std::log(values[k]) + weight * std::log(values[k + 1]));
      }
    }
    return std::numeric_limits<double>::quiet_NaN();
  }
};

/// Time of federwerk over time of PETSc at equal end errors, namely PETSc's at rtol 1e-6 and 1e-7. The two
/// take turns in every round, and the fastest round of each counts, so that other load on the machine hits
/// both alike.
void ratio_to_petsc_at_equal_error(benchmark::State& run) {
  WorkPrecision federwerk, petsc;
  end_error(solve_by_federwerk(cloth_ivp(end_of_errors), tolerances(1e-4)));  // the reference, not timed
  for (auto _ : run) {
    for (std::size_t k = 0; k < petsc.error.size(); ++k) {
      federwerk.measure(solve_by_federwerk, k);
      petsc.measure(solve_by_petsc_5dp, k);
    }
  }
  run.counters["ratio_1e-6"] = federwerk.at_error(petsc.error[1], federwerk.seconds) / petsc.seconds[1];
  run.counters["ratio_1e-7"] = federwerk.at_error(petsc.error[2], federwerk.seconds) / petsc.seconds[2];
}
BENCHMARK(ratio_to_petsc_at_equal_error)->Iterations(5)->Unit(benchmark::kMillisecond);

/// W3: the whole second, PETSc at rtol 1e-6, federwerk at the tolerance that has the same error after a tenth
/// of it.
void ratio_to_petsc_over_one_second(benchmark::State& run) {
  WorkPrecision federwerk, petsc;
  for (std::size_t k = 0; k < petsc.error.size(); ++k) federwerk.measure(solve_by_federwerk, k);
  petsc.measure(solve_by_petsc_5dp, 1);
  const double tolerance = federwerk.at_error(petsc.error[1], WorkPrecision::relative_tolerances);
  double own = 1e300, foreign = 1e300;
  for (auto _ : run) {
    own = std::min(own, TimedRun(solve_by_federwerk, end_of_run, tolerance).seconds);
    foreign = std::min(foreign, TimedRun(solve_by_petsc_5dp, end_of_run, 1e-6).seconds);
  }
  run.counters["rtol"] = tolerance;
  run.counters["seconds"] = own;
  run.counters["petsc_seconds"] = foreign;
  run.counters["ratio"] = own / foreign;
}
BENCHMARK(ratio_to_petsc_over_one_second)->Iterations(5)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace fw::benchmarks
