#include "integrators/loop/switch_guard.hpp"

#include <limits>

namespace fw::integrators {

SwitchGuard::SwitchGuard(const Ivp& ivp, const StepSource& source, const SolveOptions& options)
    : system_(*ivp.system), has_surfaces_(system_.switching_surfaces() != nullptr) {
  if (const AdaptiveStep* tolerances = source.tolerances(); tolerances == nullptr) {
    warnings_.emplace();
  } else if (options.cut_at_switches) {
    cutter_.emplace(tolerances->absolute_tolerance, tolerances->relative_tolerance,
                    smallest_switch_width(ivp.t0, ivp.t1));
  }
}

double SwitchGuard::limit() const {
  return cutter_ ? cutter_->limit() : std::numeric_limits<double>::infinity();
}

SwitchGuard::Verdict SwitchGuard::judge(const LoopStep& step, ConstVectorRef y, ConstVectorRef y_new) {
  const SwitchingSurfaces* surfaces = system_.switching_surfaces();  // elements come and go
  if (surfaces == nullptr) return Verdict::accepted;
  const StatePath<double> path{step.start, step.end - step.start, y.data(), y_new.data()};
  if (!(path.length > 0.0)) return Verdict::accepted;
  if (cutter_) return cutter_->judge(*surfaces, path);
  if (warnings_) {
    if (!has_started_) warnings_->start(*surfaces, path);
    has_started_ = true;
    warnings_->look(*surfaces, path);
  }
  return Verdict::accepted;
}

std::string SwitchGuard::last() const {
  return cutter_ ? place_of(cutter_->last()) : std::string();
}

void SwitchGuard::report(Solution& solution) const {
  if (cutter_) solution.switches = cutter_->crossed();
  if (warnings_) solution.warnings = warnings_->sentences();
}

void SwitchGuard::serialise(StateArchive& archive) {
  if (!has_surfaces_) return;
  archive.visit("watch of switches has started", has_started_);
  if (cutter_) cutter_->serialise(archive);
  if (warnings_) warnings_->serialise(archive);
}

}  // namespace fw::integrators
