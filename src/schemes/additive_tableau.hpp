#pragma once

#include <string>

#include "schemes/butcher_tableau.hpp"

namespace fw::schemes {

/// An additive (implicit–explicit) Runge–Kutta method for ẏ = f_E(t, y) + f_I(t, y): an explicit tableau for
/// f_E and a diagonally implicit one for f_I with the same nodes c [Ascher, Ruuth, Spiteri 1997; Kennedy,
/// Carpenter 2003].
struct AdditiveTableau {
  std::string name{};
  std::string title{};
  ButcherTableau explicit_part{};
  ButcherTableau implicit_part{};
  std::string reference{};

  int stages() const { return explicit_part.stages(); }
  bool has_embedded_solution() const { return !explicit_part.b_embedded.empty(); }
};

}  // namespace fw::schemes
