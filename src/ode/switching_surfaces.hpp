#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "core/extended_precision.hpp"

namespace fw {

/// A step of a second-order system as a path: the states y = (q, v) at its ends, between them the cubic
/// polynomial with these positions and velocities. Its error is O(h⁴), and O(s²) at the distance s from the
/// start however wrong the end is.
template <class Scalar>
struct StatePath {
  Scalar start{};             ///< t_n [s]
  Scalar length{};            ///< h [s], > 0
  const Scalar* from = nullptr;  ///< y_n
  const Scalar* to = nullptr;    ///< y_{n+1}
};

/// A place on a path where the force of one element changes its formula: it has a kink or a jump there.
///
/// Between switches an element is in a *phase*, in which its force is smooth: 0 where it does not act (outside
/// of an obstacle, a slack rope), other numbers for the formulas that it has.
template <class Scalar>
struct Switch {
  Scalar offset{};       ///< time since the start of the step [s], in (0, h]: the first place in the new phase
  int from = 0;          ///< phase before
  int to = 0;            ///< phase after
  int at_end = 0;        ///< phase at the end of the step: differs from `to` where it switches again
  double jump = 0.0;     ///< bound on the jump of a node's acceleration [m/s²]
  double rate = 0.0;     ///< bound on the jump of its time derivative [m/s³]
  double frequency = 0.0;  ///< ω = √(k/m) of the formula after the switch [1/s]; 0: no force
  double speed = 0.0;    ///< the largest speed of the nodes over the step [m/s]
  double thickness = 0.0;  ///< of the solid [m]; 0: none, infinite: a half space
  std::string_view kind{};  ///< of the elements, "obstacles" for example
  std::size_t number = 0;   ///< of the obstacle or the spring
  std::array<int, 2> nodes{-1, -1};  ///< particles; the second one is −1 where there is one only
};

/// Takes the switches that are found.
template <class Scalar>
class SwitchSink {
 public:
  virtual ~SwitchSink() = default;
  virtual void add(const Switch<Scalar>& found) = 0;
};

/// What a system knows of the surfaces in phase space across which its right-hand side has kinks or jumps.
/// Immutable while it is asked; allocates nothing.
class SwitchingSurfaces {
 public:
  virtual ~SwitchingSurfaces() = default;

  /// The first switch of each element that switches on the path, with a bound on the whole path between the
  /// ends: a thin solid is found also where both ends are outside. Penetrations below the rounding of
  /// coordinates are none. The order is that of the elements.
  virtual void find(const StatePath<double>& path, SwitchSink<double>& sink) const = 0;
  virtual void find(const StatePath<Float128>& path, SwitchSink<Float128>& sink) const = 0;

  /// The elements whose phase at y is not 0, as switches from 0 with offset 0.
  virtual void acting(const double* y, SwitchSink<double>& sink) const = 0;
};

/// "obstacles[0] and particle 3", "springs[2] between particles 4 and 5".
template <class Scalar>
std::string place_of(const Switch<Scalar>& found) {
  std::string text = std::string(found.kind) + "[" + std::to_string(found.number) + "]";
  if (found.nodes[1] < 0) return text + " and particle " + std::to_string(found.nodes[0]);
  return text + " between particles " + std::to_string(found.nodes[0]) + " and " + std::to_string(found.nodes[1]);
}

}  // namespace fw
