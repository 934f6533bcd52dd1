#include <benchmark/benchmark.h>

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "benchmarks/cloth.hpp"

namespace fw::benchmarks {
namespace {

/// The textbook loop over a vector of Eigen vectors: what a reader would write first, and the unit of
/// comparison.
void textbook_forces(const mechanics::MassSpringModel& model, const std::vector<Eigen::Vector3d>& x,
                     const std::vector<Eigen::Vector3d>& v, std::vector<Eigen::Vector3d>& f) {
  for (auto& force : f) force.setZero();
  const mechanics::Springs& springs = model.springs;
  for (std::size_t s = 0; s < springs.size(); ++s) {
    const auto i = static_cast<std::size_t>(springs.first[s]),
               j = static_cast<std::size_t>(springs.second[s]);
    const Eigen::Vector3d d = x[j] - x[i];
    const double length = d.norm();
    const Eigen::Vector3d r = d / length;
    const Eigen::Vector3d force = (springs.stiffness[s] * (length - springs.rest_length[s]) +
                                   springs.damping[s] * (v[j] - v[i]).dot(r)) *
                                  r;
    f[i] += force;
    f[j] -= force;
  }
}

void textbook(benchmark::State& run) {
  const Cloth cloth = make_cloth(static_cast<int>(run.range(0)));
  const auto n = static_cast<std::size_t>(cloth.system->particle_count());
  std::vector<Eigen::Vector3d> x(n), v(n), f(n);
  for (std::size_t i = 0; i < n; ++i) {
    x[i] = cloth.state.segment<3>(static_cast<Index>(3 * i));
    v[i] = cloth.state.segment<3>(static_cast<Index>(3 * (n + i)));
  }
  for (auto _ : run) {
    textbook_forces(cloth.system->model(), x, v, f);
    benchmark::DoNotOptimize(f.data());
  }
  run.SetItemsProcessed(run.iterations() * cloth.springs());
}
BENCHMARK(textbook)->Arg(100)->Arg(500)->Unit(benchmark::kMillisecond);

void mass_spring_force(benchmark::State& run) {
  const Cloth cloth = make_cloth(static_cast<int>(run.range(0)));
  const Index n = cloth.state.size() / 2;
  Vector f(n);
  for (auto _ : run) {
    cloth.system->force(0.0, cloth.state.head(n), cloth.state.tail(n), f);
    benchmark::DoNotOptimize(f.data());
  }
  run.SetItemsProcessed(run.iterations() * cloth.springs());
}
BENCHMARK(mass_spring_force)->Arg(100)->Arg(500)->Unit(benchmark::kMillisecond);

void tangent_product(benchmark::State& run) {
  const Cloth cloth = make_cloth(static_cast<int>(run.range(0)));
  const Index n = cloth.state.size() / 2;
  const Vector dq = Vector::Ones(n), dv = Vector::Ones(n);
  Vector out(n);
  for (auto _ : run) {
    cloth.system->tangent_product(0.0, cloth.state.head(n), cloth.state.tail(n), dq, dv, out);
    benchmark::DoNotOptimize(out.data());
  }
  run.SetItemsProcessed(run.iterations() * cloth.springs());
}
BENCHMARK(tangent_product)->Arg(100)->Unit(benchmark::kMillisecond);

void assemble_stiffness(benchmark::State& run) {
  const Cloth cloth = make_cloth(static_cast<int>(run.range(0)));
  const Index n = cloth.state.size() / 2;
  SparseMatrix K = cloth.system->tangent_pattern();
  for (auto _ : run) {
    cloth.system->stiffness(0.0, cloth.state.head(n), cloth.state.tail(n), TangentModel::exact, K);
    benchmark::DoNotOptimize(K.valuePtr());
  }
  run.SetItemsProcessed(run.iterations() * cloth.springs());
}
BENCHMARK(assemble_stiffness)->Arg(100)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace fw::benchmarks
