#include "study/jacobian/jacobian_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "study/jacobian/jacobian_row.hpp"

namespace fw::study {

namespace {

using mechanics::MassSpringSystem;

/// The largest rise of the total energy over that at the start, and the largest distance from the origin.
class RiseOfEnergy final : public Observer {
 public:
  explicit RiseOfEnergy(const MassSpringSystem& system) : system_(system) {}

  bool observe(const StepView& view) override {
    const Index n = system_.degrees_of_freedom();
    const Energies energies = system_.energies(view.time, view.state.head(n), view.state.tail(n));
    if (view.index == 0) {
      start_ = energies.total();
      // Gravity's energy has no zero of its own.
      double stored = 0.0;
      for (const NamedValue& energy : energies.list()) {
        if (energy.name != "gravitational") stored += energy.value;
      }
      scale_ = stored > 0.0 ? stored : 1.0;
    }
    largest_gain = std::max(largest_gain, (energies.total() - start_) / scale_);
    largest_coordinate = std::max(largest_coordinate, view.state.head(n).cwiseAbs().maxCoeff());
    return true;
  }

  double largest_gain = 0.0, largest_coordinate = 0.0;

 private:
  const MassSpringSystem& system_;
  double start_ = 0.0, scale_ = 1.0;
};

/// A rise of energy that is no more than what a nonlinear solver leaves.
constexpr double unseen_gain = 1e-9;

}  // namespace

CaseResult run_compressed(const StudyProblem& problem, const std::string& call, const Integrator& integrator,
                          double compression, const CompressedRunSettings& settings,
                          const RunContext& context) {
  Compression start = settings.start;
  start.compression = compression;
  const Ivp ivp = compressed(problem.problem.ivp, start);
  const auto& system = dynamic_cast<const MassSpringSystem&>(*ivp.system);
  JacobianRow row{.subject = problem.label, .part = "runs", .variant = call};
  row.unknowns = system.degrees_of_freedom();
  row.samples = static_cast<std::int64_t>(settings.steps.size());
  row.compression = compression;
  row.largest_gain = 0.0;
  row.failed_runs = 0.0;
  std::vector<double> end, gain, coordinate;
  std::vector<std::string> status;
  std::string first_failure;
  std::int64_t gaining = 0;
  for (const double step : settings.steps) {
    RiseOfEnergy watch(system);
    const Solution solution = context.solve(integrator, ivp, FixedStep{.step = step}, watch);
    status.emplace_back(to_string(solution.status.code));
    end.push_back(solution.time);
    gain.push_back(watch.largest_gain);
    coordinate.push_back(watch.largest_coordinate);
    if (!solution.status.ok()) {
      row.failed_runs += 1.0;
      if (first_failure.empty()) first_failure = fmt::format("; at h = {:.3g} s {}", step, status.back());
    }
    if (gain.back() > unseen_gain) ++gaining;
    if (gain.back() > row.largest_gain) {
      row.largest_gain = gain.back();
      row.worst_step = step;
    }
  }
  CaseResult result;
  result.reason =
      fmt::format("{} of {} runs reach the end, {} gain energy{}{}; no theory predicts a number",
                  row.samples - static_cast<std::int64_t>(row.failed_runs), row.samples, gaining,
                  gaining > 0 ? fmt::format(", at most {:.3g} times that at the start (h = {:.3g} s)",
                                            row.largest_gain, row.worst_step)
                              : std::string(),
                  first_failure);
  result.columns = {{"step", "s", settings.steps, {}, {}},
                    {"status", "", status, {}, {}},
                    {"end_time", "s", end, {}, {}},
                    {"energy_gain", "1", gain, {}, {}},
                    {"largest_coordinate", "m", coordinate, {}, {}}};
  result.summary = cells_of(row);
  return result;
}

}  // namespace fw::study
