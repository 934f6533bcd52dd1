#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "store/trajectory_writer.hpp"
#include "study/result.hpp"

namespace fw::store::test {

/// A chain of `n` masses with n − 1 springs.
inline mechanics::MassSpringModel chain(int n) {
  mechanics::MassSpringModel model;
  model.fixed = {0};
  for (int i = 0; i < n; ++i) {
    model.mass.push_back(1.0 + 0.5 * i);
    if (i == 0) continue;
    model.springs.first.push_back(i - 1);
    model.springs.second.push_back(i);
    model.springs.stiffness.push_back(100.0 + i);
    model.springs.damping.push_back(0.5 * i);
    model.springs.rest_length.push_back(0.9 + 0.01 * i);
  }
  return model;
}

/// Entry i of frame f is f + i/1000, so that every number of the file is known.
inline Vector known_state(int n, int frame) {
  Vector state(6 * n);
  for (Index i = 0; i < state.size(); ++i) state[i] = frame + static_cast<double>(i) / 1000.0;
  return state;
}

/// Quantities that are told apart and known from the first entries of the state: elastic 2 + q₀, obstacle 4 +
/// v₀.
inline const FrameQuantities known_quantities = {
    .list = {{"kinetic_energy", "J"},
             {"potential_energy", "J"},
             {"total_energy", "J"},
             {"elastic_energy", "J"},
             {"gravitational_energy", "J"},
             {"obstacle_energy", "J"},
             {"linear_momentum", "kg*m/s", 3},
             {"angular_momentum", "kg*m^2/s", 3}},
    .evaluate = [](double t, ConstVectorRef q, ConstVectorRef v, std::span<double> values) {
      const double kinetic = 1.0 + t, elastic = 2.0 + q[0], gravitational = 3.0, obstacle = 4.0 + v[0];
      const double potential = elastic + gravitational + obstacle;
      const std::array known{
          kinetic, potential, kinetic + potential, elastic, gravitational, obstacle, t, 5.0, 6.0, 7.0,
          t,       8.0};
      std::copy(known.begin(), known.end(), values.begin());
    }};

inline FileHeader header() {
  return {.kind = "trajectory",
          .title = "Feder mit Dämpfer, Größe 1",
          .command_line = "federwerk simulate 'a b.toml'",
          .spec = "title = \"Feder\"\nx = [1, 2]\n",
          .seed = -7};
}

/// Writes `frames` frames of a chain of `n` at t = 0, 0.5, 1, ….
inline void write_trajectory(const std::filesystem::path& path, int n, int frames,
                             const Status& status = {StatusCode::success, ""}) {
  TrajectoryWriter writer(path, header(), chain(n), known_quantities, frames);
  writer.describe_frames({"ends of steps", "even"});
  for (int f = 0; f < frames; ++f) writer.frame(0.5 * f, known_state(n, f));
  Work work;
  work.rhs_evaluations = 4000000001ULL;
  work.accepted_steps = 12;
  work.seconds = 0.25;
  writer.finish(status, work);
}

/// A case with columns of every type, two dimensions, non-finite numbers and umlauts.
inline study::CaseResult sample_case(int i) {
  const double inf = std::numeric_limits<double>::infinity();
  study::CaseResult result;
  result.id = "pendel-rk" + std::to_string(i);
  result.key =
      std::string(63, 'a') + static_cast<char>('0' + i % 10) + (i >= 10 ? std::to_string(i / 10) : "");
  result.columns = {
      {"step", "s", std::vector<double>{0.1, 0.05, std::nan(""), -inf, 5e-324}, {}, {}},
      {"error",
       "m",
       std::vector<double>{1.0, 2.0, 3.0, 4.0, 5.0 + i, 6.0},
       {2, 3},
       {{"norm", "größter Fehler"}}},
      {"used", "1", std::vector<std::int64_t>{0, 1, std::numeric_limits<std::int64_t>::min()}, {}, {}},
      {"note", "", std::vector<std::string>{"Überschwinger", "", "ß"}, {}, {}},
      {"nothing", "J", std::vector<double>{}, {}, {}},
  };
  result.verdict = static_cast<study::Verdict>(i % 3);
  result.reason = "Ordnung " + std::to_string(i) + " ± 0.1";
  result.summary = {{"method", "", "rk" + std::to_string(i)},
                    {"order", "1", i == 1 ? std::nan("") : 4.0 + i},
                    {"rhs_evaluations", "1", std::int64_t{100} + i},
                    {"seconds", "s", 0.5}};
  return result;
}

inline study::StudyResult sample_study(int cases) {
  study::StudyResult result;
  result.kind = "convergence";
  result.title = "Ordnung der Verfahren für Federn";
  result.spec = "kind = \"convergence\"\n";
  result.seed = 42;
  for (int i = 0; i < cases; ++i) result.cases.push_back(sample_case(i));
  return result;
}

}  // namespace fw::store::test
