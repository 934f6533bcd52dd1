#include "schemes/multistep_formulas.hpp"

namespace fw::schemes {

namespace {

constexpr const char* adams_reference =
    "[Hairer, Nørsett, Wanner 1993, III.1; Bashforth, Adams 1883; Moulton 1926]";
constexpr const char* bdf_reference =
    "[Curtiss, Hirschfelder 1952; Gear 1971; Hairer, Nørsett, Wanner 1993, III.1]";

std::vector<MultistepFormula> make_list() {
  return {
      {.name = "adams_bashforth2",
       .title = "Adams-Bashforth of order 2 (2 steps)",
       .alpha = {0, -1, 1},
       .beta = {"-1/2", "3/2", 0},
       .reference = adams_reference},
      {.name = "adams_bashforth3",
       .title = "Adams-Bashforth of order 3 (3 steps)",
       .alpha = {0, 0, -1, 1},
       .beta = {"5/12", "-16/12", "23/12", 0},
       .reference = adams_reference},
      {.name = "adams_bashforth4",
       .title = "Adams-Bashforth of order 4 (4 steps)",
       .alpha = {0, 0, 0, -1, 1},
       .beta = {"-9/24", "37/24", "-59/24", "55/24", 0},
       .reference = adams_reference},
      {.name = "adams_bashforth5",
       .title = "Adams-Bashforth of order 5 (5 steps)",
       .alpha = {0, 0, 0, 0, -1, 1},
       .beta = {"251/720", "-1274/720", "2616/720", "-2774/720", "1901/720", 0},
       .reference = adams_reference},
      {.name = "adams_moulton2",
       .title = "Adams-Moulton of order 2 (1 step, the trapezoidal rule)",
       .alpha = {-1, 1},
       .beta = {"1/2", "1/2"},
       .reference = adams_reference},
      {.name = "adams_moulton3",
       .title = "Adams-Moulton of order 3 (2 steps)",
       .alpha = {0, -1, 1},
       .beta = {"-1/12", "8/12", "5/12"},
       .reference = adams_reference},
      {.name = "adams_moulton4",
       .title = "Adams-Moulton of order 4 (3 steps)",
       .alpha = {0, 0, -1, 1},
       .beta = {"1/24", "-5/24", "19/24", "9/24"},
       .reference = adams_reference},
      {.name = "adams_moulton5",
       .title = "Adams-Moulton of order 5 (4 steps)",
       .alpha = {0, 0, 0, -1, 1},
       .beta = {"-19/720", "106/720", "-264/720", "646/720", "251/720"},
       .reference = adams_reference},
      {.name = "bdf2",
       .title = "Backward differentiation formula of order 2",
       .alpha = {"1/3", "-4/3", 1},
       .beta = {0, 0, "2/3"},
       .reference = bdf_reference},
      {.name = "bdf3",
       .title = "Backward differentiation formula of order 3",
       .alpha = {"-2/11", "9/11", "-18/11", 1},
       .beta = {0, 0, 0, "6/11"},
       .reference = bdf_reference},
      {.name = "bdf4",
       .title = "Backward differentiation formula of order 4",
       .alpha = {"3/25", "-16/25", "36/25", "-48/25", 1},
       .beta = {0, 0, 0, 0, "12/25"},
       .reference = bdf_reference},
      {.name = "bdf5",
       .title = "Backward differentiation formula of order 5",
       .alpha = {"-12/137", "75/137", "-200/137", "300/137", "-300/137", 1},
       .beta = {0, 0, 0, 0, 0, "60/137"},
       .reference = bdf_reference},
      {.name = "bdf6",
       .title = "Backward differentiation formula of order 6",
       .alpha = {"10/147", "-72/147", "225/147", "-400/147", "450/147", "-360/147", 1},
       .beta = {0, 0, 0, 0, 0, 0, "60/147"},
       .reference = bdf_reference},
  };
}

}  // namespace

const std::vector<MultistepFormula>& multistep_formulas() {
  static const std::vector<MultistepFormula> list = make_list();
  return list;
}

}  // namespace fw::schemes
