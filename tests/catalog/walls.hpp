#pragma once

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <string>

#include "mechanics/mass_spring_system.hpp"
#include "ode/ivp.hpp"

namespace fw::catalog {

/// A particle of 1 kg flies along x at `speed` and meets a solid of stiffness k after 0.05 s, head on. A second
/// one rests far away, so that norms over all particles are no help.
struct Wall {
  enum class Shape { plane, sphere, box };
  Shape shape = Shape::box;
  double thickness = 0.002;  ///< of the box, diameter of the ball [m]
  double stiffness = 1e9;    ///< [N/m]
  double speed = 10.0;       ///< [m/s]
  double end = 0.2;          ///< [s]

  double frequency() const { return std::sqrt(stiffness); }
  double impact() const { return 0.05; }
  double face() const { return speed * impact(); }
  /// The box is too soft: the particle passes its middle and is pushed out at the other side.
  bool is_passed() const { return shape == Shape::box && speed / frequency() > 0.5 * thickness; }
  /// A ball that is passed through its centre has no force there.
  bool has_closed_form() const {
    return shape != Shape::sphere || speed / frequency() < 0.45 * thickness;
  }
  double duration() const {
    return is_passed() ? 2.0 * std::asin(0.5 * thickness * frequency() / speed) / frequency()
                       : std::numbers::pi / frequency();
  }
  double end_speed() const { return is_passed() ? speed : -speed; }
  double end_position() const {
    const double rest = end - impact() - duration();
    if (rest < 0.0) return face() + speed / frequency() * std::sin(frequency() * (end - impact()));
    return face() + (is_passed() ? thickness : 0.0) + end_speed() * rest;
  }
  std::string name() const {
    return fmt::format("{} {} m, k = {:g}, v = {}",
                       shape == Shape::plane    ? "plane"
                       : shape == Shape::sphere ? "sphere"
                                                : "box",
                       thickness, stiffness, speed);
  }

  mechanics::MassSpringModel model() const {
    mechanics::MassSpringModel model;
    model.mass = {1.0, 1.0};
    mechanics::Obstacle obstacle{mechanics::Plane{{face(), 0.0, 0.0}, {-1.0, 0.0, 0.0}}, stiffness, 0.0};
    if (shape == Shape::sphere) {
      obstacle.shape = mechanics::Sphere{{face() + 0.5 * thickness, 0.0, 0.0}, 0.5 * thickness};
    } else if (shape == Shape::box) {
      obstacle.shape = mechanics::Box{{face(), -1.0, -1.0}, {face() + thickness, 1.0, 1.0}};
    }
    model.obstacles = {obstacle};
    return model;
  }
  Ivp ivp() const {
    Ivp ivp;
    ivp.system = std::make_shared<const mechanics::MassSpringSystem>(model());
    ivp.t1 = end;
    ivp.y0 = Vector::Zero(12);
    ivp.y0[3] = -3.0;
    ivp.y0[4] = 5.0;
    ivp.y0[6] = speed;
    return ivp;
  }
};

}  // namespace fw::catalog
