#include <arkode/arkode_erkstep.h>
#include <benchmark/benchmark.h>

#include <algorithm>
#include <ctime>
#include <stdexcept>
#include <vector>

#include "benchmarks/cloth.hpp"
#include "oracles/sundials/cvode.hpp"
#include "oracles/sundials/eigen_vector.hpp"

// SUNDIALS with our vector operations against the same library with its serial vector: the 30×30 cloth over
// one second (W3 of the performance notes), rtol = 1e-6 in the library's own meaning.

namespace fw::benchmarks {
namespace {

using oracles::VectorOperations;

Ivp cloth_ivp() {
  static const Cloth cloth = make_cloth(30, 1e3, 0.1);
  Ivp ivp;
  ivp.system = cloth.system;
  ivp.y0 = cloth.state;
  ivp.t1 = 1.0;
  return ivp;
}

constexpr AdaptiveStep tolerances{
    .relative_tolerance = 1e-6, .absolute_tolerance = 1e-9, .initial_step = 1e-4};

std::uint64_t run_cvode_adams(const Ivp& ivp, VectorOperations vector) {
  NullObserver observer;
  const Solution solution = oracles::make_cvode_adams({.tolerance_factor = 1.0, .vector = vector})
                                ->solve(ivp, tolerances, observer);
  if (!solution.status.ok()) throw std::runtime_error(solution.status.describe());
  return solution.work.rhs_evaluations;
}

struct Counted {
  const OdeSystem& system;
  std::uint64_t evaluations = 0;
};

int right_hand_side(sunrealtype t, N_Vector y, N_Vector slope, void* user_data) {
  auto& counted = *static_cast<Counted*>(user_data);
  const Index n = counted.system.size();
  VectorMap out = oracles::detail::mutable_view(slope, n);
  counted.system.rhs(t, oracles::detail::view(y, n), out);
  ++counted.evaluations;
  return 0;
}

/// ARKODE's engine for explicit pairs with the Dormand–Prince 5(4) table.
std::uint64_t run_arkode_erk(const Ivp& ivp, VectorOperations vector) {
  using namespace oracles::detail;
  const ContextPointer context = make_context();
  Vector state = ivp.y0;
  const VectorPointer y = wrap_vector(state, vector, context.get());
  Counted counted{*ivp.system};
  struct Deleter {
    void operator()(void* memory) const { ERKStepFree(&memory); }
  };
  const std::unique_ptr<void, Deleter> memory(ERKStepCreate(right_hand_side, ivp.t0, y.get(), context.get()));
  require(ERKStepSetUserData(memory.get(), &counted), "ERKStepSetUserData");
  require(ERKStepSetTableNum(memory.get(), ARKODE_DORMAND_PRINCE_7_4_5), "ERKStepSetTableNum");
  require(ERKStepSStolerances(memory.get(), tolerances.relative_tolerance, tolerances.absolute_tolerance),
          "ERKStepSStolerances");
  require(ERKStepSetInitStep(memory.get(), tolerances.initial_step), "ERKStepSetInitStep");
  require(ERKStepSetMaxNumSteps(memory.get(), -1), "ERKStepSetMaxNumSteps");
  require(ERKStepSetStopTime(memory.get(), ivp.t1), "ERKStepSetStopTime");
  double t = ivp.t0;
  while (t < ivp.t1) {
    require(ERKStepEvolve(memory.get(), ivp.t1, y.get(), &t, ARK_ONE_STEP), "ERKStepEvolve");
  }
  return counted.evaluations;
}

using Workload = std::uint64_t (*)(const Ivp&, VectorOperations);

/// The right-hand sides alone, as many as `run` needs: what no vector can save.
double seconds_of_right_hand_sides(const Ivp& ivp, std::uint64_t evaluations) {
  Vector slope(ivp.y0.size());
  const std::clock_t start = std::clock();
  for (std::uint64_t k = 0; k < evaluations; ++k) {
    ivp.system->rhs(0.0, ivp.y0, slope);
    benchmark::DoNotOptimize(slope.data());
  }
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

/// Processor time with the serial vector over that with ours. The two take turns and the fastest round of
/// each counts, so that other load on the machine hits both alike.
void ratio_to_serial_vector(benchmark::State& run, Workload workload) {
  const Ivp ivp = cloth_ivp();
  double eigen = 1e300, serial = 1e300, forces = 1e300;
  std::uint64_t evaluations = 0;
  const auto timed = [&](VectorOperations vector) {
    const std::clock_t start = std::clock();
    evaluations = workload(ivp, vector);
    return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  };
  for (auto _ : run) {
    serial = std::min(serial, timed(VectorOperations::serial));
    eigen = std::min(eigen, timed(VectorOperations::eigen));
    forces = std::min(forces, seconds_of_right_hand_sides(ivp, evaluations));
  }
  run.counters["rhs"] = static_cast<double>(evaluations);
  run.counters["eigen_seconds"] = eigen;
  run.counters["serial_seconds"] = serial;
  run.counters["rhs_seconds"] = forces;
  run.counters["ratio"] = serial / eigen;
}
BENCHMARK_CAPTURE(ratio_to_serial_vector, cvode_adams, run_cvode_adams)
    ->Iterations(5)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ratio_to_serial_vector, arkode_dormand_prince, run_arkode_erk)
    ->Iterations(5)
    ->Unit(benchmark::kMillisecond);

/// Single operations on vectors of the cloth's size (5400 entries).
void linear_sum(benchmark::State& run, VectorOperations vector) {
  using namespace oracles::detail;
  const ContextPointer context = make_context();
  const VectorPointer x = new_vector(5400, vector, context.get()),
                      y = new_vector(5400, vector, context.get());
  N_VConst(0.5, x.get());
  N_VConst(0.25, y.get());
  for (auto _ : run) N_VLinearSum(1.0, x.get(), 1.0, y.get(), y.get());
}
BENCHMARK_CAPTURE(linear_sum, eigen, VectorOperations::eigen);
BENCHMARK_CAPTURE(linear_sum, serial, VectorOperations::serial);

void wrms_norm(benchmark::State& run, VectorOperations vector) {
  using namespace oracles::detail;
  const ContextPointer context = make_context();
  const VectorPointer x = new_vector(5400, vector, context.get()),
                      y = new_vector(5400, vector, context.get());
  N_VConst(0.5, x.get());
  N_VConst(0.25, y.get());
  for (auto _ : run) benchmark::DoNotOptimize(N_VWrmsNorm(x.get(), y.get()));
}
BENCHMARK_CAPTURE(wrms_norm, eigen, VectorOperations::eigen);
BENCHMARK_CAPTURE(wrms_norm, serial, VectorOperations::serial);

void linear_combination_of_seven(benchmark::State& run, VectorOperations vector) {
  using namespace oracles::detail;
  const ContextPointer context = make_context();
  std::vector<VectorPointer> owners;
  std::vector<N_Vector> vectors;
  std::vector<double> factors(7, 0.125);
  for (int k = 0; k < 8; ++k) {
    owners.push_back(new_vector(5400, vector, context.get()));
    vectors.push_back(owners.back().get());
    N_VConst(0.5, vectors.back());
  }
  for (auto _ : run) N_VLinearCombination(7, factors.data(), vectors.data(), vectors.back());
}
BENCHMARK_CAPTURE(linear_combination_of_seven, eigen, VectorOperations::eigen);
BENCHMARK_CAPTURE(linear_combination_of_seven, serial, VectorOperations::serial);

}  // namespace
}  // namespace fw::benchmarks
