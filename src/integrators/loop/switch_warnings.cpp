#include "integrators/loop/switch_warnings.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace fw::integrators {

namespace {

/// The largest h·√(k/m) at which a contact of π/(h √(k/m)) = 31 steps is resolved: where the kinks fall between
/// steps changes the velocity of rebound by about its square, 1 %.
constexpr double longest_step = 0.1;

std::string in_all(std::uint64_t count) {
  return count > 1 ? fmt::format("; {} times in all, this is the first", count) : "";
}

}  // namespace

void SwitchWarnings::Trouble::add(const Switch<double>& found, double start, double length) {
  if (count++ > 0) return;
  time = start + found.offset;
  step = length;
  frequency = found.frequency;
  speed = found.speed;
  thickness = found.thickness;
  place = place_of(found);
}

void SwitchWarnings::Trouble::serialise(StateArchive& archive) {
  archive.visit("times met", count);
  archive.visit("first time", time);
  archive.visit("step", step);
  archive.visit("frequency", frequency);
  archive.visit("speed", speed);
  archive.visit("thickness", thickness);
  archive.visit("place", place);
}

void SwitchWarnings::start(const SwitchingSurfaces& surfaces, const StatePath<double>& path) {
  now_ = path.start;
  step_ = path.length;
  surfaces.acting(path.from, *this);
}

void SwitchWarnings::look(const SwitchingSurfaces& surfaces, const StatePath<double>& path) {
  now_ = path.start;
  step_ = path.length;
  surfaces.find(path, *this);
}

void SwitchWarnings::add(const Switch<double>& found) {
  if (found.thickness == 0.0) return;  // not of a solid
  if (found.to != 0 && found.from == 0 && found.frequency * step_ > longest_step) {
    stiff_.add(found, now_, step_);
  }
  if (found.to != found.at_end) crossed_.add(found, now_, step_);
}

std::vector<std::string> SwitchWarnings::sentences() const {
  std::vector<std::string> list;
  if (stiff_.count > 0) {
    list.push_back(fmt::format(
        "contact of {} at t = {:.6g} s: h sqrt(k/m) is {:.3g}, expected at most {}: the contact lasts "
        "pi sqrt(m/k) = {:.3g} s, the step is {:.3g} s; give a step of at most {:.3g} s, or tolerances to a "
        "method that chooses its steps{}",
        stiff_.place, stiff_.time, stiff_.frequency * stiff_.step, longest_step, std::numbers::pi / stiff_.frequency,
        stiff_.step, longest_step / stiff_.frequency, in_all(stiff_.count)));
  }
  if (crossed_.count > 0) {
    list.push_back(fmt::format(
        "{} at t = {:.6g} s: the particle enters and leaves the solid within one step: it moves {:.3g} m per "
        "step, the solid is {}; a shorter step or a method that chooses its steps is needed{}",
        crossed_.place, crossed_.time, crossed_.speed * crossed_.step,
        std::isfinite(crossed_.thickness) ? fmt::format("{:.3g} m thick", crossed_.thickness) : "a half space",
        in_all(crossed_.count)));
  }
  return list;
}

void SwitchWarnings::serialise(StateArchive& archive) {
  stiff_.serialise(archive);
  crossed_.serialise(archive);
}

}  // namespace fw::integrators
