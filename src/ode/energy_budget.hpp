#pragma once

#include <cstdint>

#include "ode/energies.hpp"

namespace fw {

/// How large the energies of a run are, and what the numerical method adds to them.
///
/// A total has no size of its own: it is zero wherever the zeros of its potentials let it be. The size here is
///
///   scale = max over time of  T + |V_e| + |V_g − V_g(0)|,
///
/// with the kinetic energy T, the energies V_e that vanish in a state of rest (springs, anchors, obstacles) and
/// those of outer fields V_g (gravity), of which only differences mean anything. It does not change when the
/// scene is moved. Rounding is in proportion to something else, the sizes of the numbers that are added:
///
///   magnitude = max over time of  T + |V_e| + |V_g| + √(Σ_i (f_i q_i)²),
///
/// whose last term is what independent roundings of coordinates far from the origin move the potentials by.
class EnergyBudget {
 public:
  /// The energies of the next state; the first call is the start.
  void add(const Energies& energies);
  /// Work that came in from outside at most, since the state before [J], ≥ 0; before the state that it led to.
  void add_work(double most) { work_ += most; }
  /// The same where only these three are known [J].
  void add(double kinetic, double at_rest_zero, double outer);
  /// What rounding does to a state [J]: `virial` = √(Σ_i (f_i q_i)²) over the coordinates, and `jitter` =
  /// Σ_i m_i (ε q_i/h)², the energy of velocities that move a coordinate by its last digit per step.
  void add_rounding(double virial, double jitter);

  double start() const { return start_; }    ///< total at the start [J]
  double change() const { return change_; }  ///< of the total since the start, of the last state [J]
  double scale() const { return scale_; }    ///< [J]
  double magnitude() const { return sum_ + virial_; }  ///< [J]
  /// Largest change of the total beyond what came in from outside [J], ≥ 0.
  double gain() const { return gain_; }

  /// By how much the energy has multiplied without any source: scale/(scale − gain), 1 where nothing was gained.
  double growth_factor() const;
  /// Whether 99 % of the energy and more has come from nowhere, over two steps
  /// or more and beyond what rounding does to a system at rest. What outer sources other than gravity give is told by `add_work`;
  /// dampers can only take.
  bool has_exploded() const;

 private:
  std::uint64_t states_ = 0;
  double start_ = 0.0, outer_start_ = 0.0, change_ = 0.0;
  double scale_ = 0.0, sum_ = 0.0, virial_ = 0.0, jitter_ = 0.0, gain_ = 0.0, work_ = 0.0;
};

}  // namespace fw
