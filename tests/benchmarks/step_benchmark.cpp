#include <benchmark/benchmark.h>

#include "benchmarks/cloth.hpp"
#include "catalog/methods.hpp"

namespace fw::benchmarks {
namespace {

/// Ten steps of a scheme on the N×N cloth.
void ten_steps(benchmark::State& run, const char* method, double step) {
  const Cloth cloth = make_cloth(static_cast<int>(run.range(0)));
  const auto integrator = catalog::make_method(method);
  Ivp ivp;
  ivp.system = cloth.system;
  ivp.y0 = cloth.state;
  ivp.t1 = 10 * step;
  for (auto _ : run) {
    NullObserver observer;
    const Solution solution = integrator->solve(ivp, FixedStep{.step = step}, observer);
    if (!solution.status.ok()) run.SkipWithError(solution.status.describe().c_str());
  }
  run.SetItemsProcessed(run.iterations() * 10);
}
BENCHMARK_CAPTURE(ten_steps, symplectic_euler, "symplectic_euler", 1e-6)
    ->Arg(100)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ten_steps, velocity_verlet, "velocity_verlet", 1e-6)
    ->Arg(100)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ten_steps, rk4, "rk4", 1e-6)->Arg(100)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ten_steps, linearised,
                  "implicit_euler_linearised[tangent=psd_projection,linear_tolerance=1e-8]", 1.0 / 60.0)
    ->Arg(30)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace fw::benchmarks
