#include "integrators/tableaus.hpp"

namespace fw::integrators {

namespace {

ButcherTableau explicit_euler() {
  return {.name = "explicit_euler",
          .title = "Explicit Euler",
          .A = Matrix{{0.0}},
          .b = Vector{{1.0}},
          .c = Vector{{0.0}},
          .reference = "[Zachmann 2011, S8; Hairer, Norsett, Wanner 1993, I.7]"};
}

ButcherTableau midpoint() {
  return {.name = "midpoint",
          .title = "Explicit midpoint rule (Runge 2)",
          .A = Matrix{{0.0, 0.0}, {0.5, 0.0}},
          .b = Vector{{0.0, 1.0}},
          .c = Vector{{0.0, 0.5}},
          .reference = "[Zachmann 2011, S15; Runge 1895; Hairer, Norsett, Wanner 1993, II.1]"};
}

ButcherTableau heun() {
  return {.name = "heun",
          .title = "Heun's method of order 2 (explicit trapezoidal rule)",
          .A = Matrix{{0.0, 0.0}, {1.0, 0.0}},
          .b = Vector{{0.5, 0.5}},
          .c = Vector{{0.0, 1.0}},
          .reference = "[Heun 1900; Hairer, Norsett, Wanner 1993, II.1]"};
}

ButcherTableau rk4() {
  return {.name = "rk4",
          .title = "Classical Runge-Kutta method of order 4",
          .A = Matrix{{0.0, 0.0, 0.0, 0.0}, {0.5, 0.0, 0.0, 0.0}, {0.0, 0.5, 0.0, 0.0}, {0.0, 0.0, 1.0, 0.0}},
          .b = Vector{{1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0}},
          .c = Vector{{0.0, 0.5, 0.5, 1.0}},
          .reference = "[Zachmann 2011, S15-S16; Kutta 1901; Hairer, Norsett, Wanner 1993, II.1]"};
}

std::vector<ButcherTableau> checked(std::vector<ButcherTableau> list) {
  for (const ButcherTableau& tableau : list) check_tableau(tableau);
  return list;
}

}  // namespace

const std::vector<ButcherTableau>& tableaus() {
  static const std::vector<ButcherTableau> list = checked({explicit_euler(), midpoint(), heun(), rk4()});
  return list;
}

}  // namespace fw::integrators
