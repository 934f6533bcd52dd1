#include "study/kinds/step_construction.hpp"

#include <algorithm>

namespace fw::study {

namespace {

/// The exact flow through (t, y) on [from, to], by the classical Runge–Kutta method with steps that no
/// picture shows.
void add_flow(const OdeSystem& system, double t, double y, double from, double to, std::vector<double>& times,
              std::vector<double>& values) {
  constexpr int points = 33, substeps = 16;
  const auto slope = [&](double time, double value) {
    Vector state(1), rate(1);
    state[0] = value;
    system.rhs(time, state, rate);
    return rate[0];
  };
  // From the point to the start of the interval, then through it.
  double time = t, value = y;
  const auto advance = [&](double target, int steps) {
    const double h = (target - time) / steps;
    for (int k = 0; k < steps; ++k) {
      const double k1 = slope(time, value), k2 = slope(time + 0.5 * h, value + 0.5 * h * k1);
      const double k3 = slope(time + 0.5 * h, value + 0.5 * h * k2), k4 = slope(time + h, value + h * k3);
      value += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
      time += h;
    }
    time = target;
  };
  if (time != from) advance(from, points * substeps);
  for (int k = 0; k < points; ++k) {
    const double target = from + (to - from) * k / (points - 1);
    if (k > 0) advance(target, substeps);
    times.push_back(time);
    values.push_back(value);
  }
}

}  // namespace

void add_step_construction(const Ivp& given, const Integrator& integrator, const StepControl& control,
                           std::int64_t steps, CaseResult& result) {
  if (steps == 0) return;
  TrajectoryRecorder recorder;
  Ivp ivp = given;
  if (const auto* fixed = std::get_if<FixedStep>(&control)) {
    ivp.t1 = std::min(ivp.t1, ivp.t0 + static_cast<double>(steps) * fixed->step);
  }
  integrator.solve(ivp, control, recorder);
  std::vector<double> start_time, start, end_time, end, slope, start_slope, end_slope, flow_time, flow;
  Vector rate(1);
  const auto count = std::min(static_cast<std::size_t>(steps), recorder.times().size() - 1);
  for (std::size_t n = 0; n < count; ++n) {
    const double t0 = recorder.times()[n], t1 = recorder.times()[n + 1];
    const double y0 = recorder.states()[n][0], y1 = recorder.states()[n + 1][0];
    start_time.push_back(t0);
    start.push_back(y0);
    end_time.push_back(t1);
    end.push_back(y1);
    slope.push_back((y1 - y0) / (t1 - t0));
    ivp.system->rhs(t0, recorder.states()[n], rate);
    start_slope.push_back(rate[0]);
    ivp.system->rhs(t1, recorder.states()[n + 1], rate);
    end_slope.push_back(rate[0]);
    add_flow(*ivp.system, t0, y0, t0, t1, flow_time, flow);
    add_flow(*ivp.system, t1, y1, t0, t1, flow_time, flow);
  }
  const std::uint64_t points = count == 0 ? 0 : flow.size() / (2 * count);
  result.columns.push_back({"construction_start_time", "s", start_time, {}, {}});
  result.columns.push_back({"construction_start", "SI", start, {}, {}});
  result.columns.push_back({"construction_end_time", "s", end_time, {}, {}});
  result.columns.push_back({"construction_end", "SI", end, {}, {}});
  result.columns.push_back({"construction_slope", "SI/s", slope, {}, {}});
  result.columns.push_back({"construction_start_slope", "SI/s", start_slope, {}, {}});
  result.columns.push_back({"construction_end_slope", "SI/s", end_slope, {}, {}});
  result.columns.push_back({"construction_flow_time", "s", flow_time, {count, 2, points}, {}});
  result.columns.push_back({"construction_flow", "SI", flow, {count, 2, points}, {}});
}

}  // namespace fw::study
