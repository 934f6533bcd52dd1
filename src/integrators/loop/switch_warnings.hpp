#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/state_archive.hpp"
#include "ode/switching_surfaces.hpp"

namespace fw::integrators {

/// Watches a run with constant steps for contacts that the step is too long for and for solids that a particle
/// crosses within one step: such runs are not wrong by rounding, and end well all the same.
class SwitchWarnings final : public SwitchSink<double> {
 public:
  /// What acts already at the start of the first step.
  void start(const SwitchingSurfaces& surfaces, const StatePath<double>& path);
  /// A step.
  void look(const SwitchingSurfaces& surfaces, const StatePath<double>& path);

  /// A sentence per kind of trouble, with the first place, its numbers and how often it was met.
  std::vector<std::string> sentences() const;

  void add(const Switch<double>& found) override;
  void serialise(StateArchive& archive);

 private:
  /// What was met first, and how often.
  struct Trouble {
    std::uint64_t count = 0;
    double time = 0.0, step = 0.0, frequency = 0.0, speed = 0.0, thickness = 0.0;
    std::string place;
    void add(const Switch<double>& found, double start, double length);
    void serialise(StateArchive& archive);
  };

  double step_ = 0.0, now_ = 0.0;  ///< length and start of the present step [s]
  Trouble stiff_, crossed_;
};

}  // namespace fw::integrators
