#pragma once

#include "conformance/seeded_bug.hpp"
#include "integrators/tableau/additive_runge_kutta.hpp"
#include "integrators/tableau/diagonally_implicit_runge_kutta.hpp"
#include "integrators/tableau/explicit_runge_kutta.hpp"
#include "integrators/tableau/fully_implicit_runge_kutta.hpp"
#include "integrators/tableau/linear_multistep.hpp"
#include "integrators/tableau/nystrom.hpp"
#include "integrators/tableau/rosenbrock.hpp"
#include "integrators/tableau/splitting.hpp"
#include "schemes/splitting_schemes.hpp"

namespace fw::conformance {

namespace detail {

inline const auto run_explicit = [](const schemes::ButcherTableau& t) {
  return integrators::make_explicit_runge_kutta(t);
};
inline const auto run_diagonal = [](const schemes::ButcherTableau& t) {
  return integrators::make_diagonally_implicit_runge_kutta(t);
};
inline const auto run_implicit = [](const schemes::ButcherTableau& t) {
  return integrators::make_fully_implicit_runge_kutta(t);
};
inline const auto run_rosenbrock = [](const schemes::RosenbrockTableau& t) {
  return integrators::make_rosenbrock(t);
};
inline const auto run_nystrom = [](const schemes::NystromTableau& t) { return integrators::make_nystrom(t); };
inline const auto run_splitting = [](const schemes::SplittingScheme& s) {
  return integrators::make_splitting(s);
};
inline const auto run_additive = [](const schemes::AdditiveTableau& t) {
  return integrators::make_additive_runge_kutta(t);
};
inline const auto run_multistep = [](const schemes::MultistepFormula& f) {
  return integrators::make_linear_multistep(f);
};

/// Adds a number to a coefficient.
inline void shift(schemes::Coefficient& coefficient, const char* by) {
  coefficient = schemes::Coefficient(Float128(coefficient.value() + schemes::Coefficient(by).value()));
}

/// A composition of position Verlet steps with `by` added to one of its weights; the middle one balances the
/// sum.
inline schemes::SplittingScheme with_shifted_weight(const schemes::SplittingScheme& scheme, std::size_t which,
                                                    const char* by) {
  const auto half = static_cast<std::ptrdiff_t>(scheme.kick.size() / 2);
  schemes::CoefficientRow weights(scheme.kick.begin(), scheme.kick.begin() + half);
  shift(weights[which], by);
  return schemes::from_symmetric_weights(
      {.name = scheme.name, .title = scheme.title, .reference = scheme.reference}, weights);
}

}  // namespace detail

/// Wrong numbers that the code runs with.
inline std::vector<SeededBug> wrong_coefficients_in_the_code() {
  using namespace detail;
  using schemes::AdditiveTableau;
  using schemes::ButcherTableau;
  using schemes::MultistepFormula;
  using schemes::NystromTableau;
  using schemes::RosenbrockTableau;
  using schemes::SplittingScheme;
  const char* order = "order, forces f(t, q)";
  const char* damped_order = "order, forces f(t, q, v)";
  const char* flow_order = "order, y' = f(t, y)";
  const char* tableau = "tableau of the running code";
  const char* stability = "stability function";
  std::vector<SeededBug> bugs;
  bugs.push_back(coefficient_bug<ButcherTableau>("rk4_wrong_coefficient_in_a", "a_32 = 0.49 for 0.5", "rk4",
                                                 run_explicit, [](ButcherTableau& t) { t.A[2][1] = "0.49"; },
                                                 {order, damped_order, flow_order, tableau, stability}));
  bugs.push_back(coefficient_bug<ButcherTableau>(
      "rk4_swapped_weights", "b_1 and b_2 exchanged", "rk4", run_explicit,
      [](ButcherTableau& t) { std::swap(t.b[0], t.b[1]); },
      {order, damped_order, flow_order, "polynomial exactness", tableau, stability}));
  bugs.push_back(coefficient_bug<ButcherTableau>(
      "dormand_prince_853_digit", "a_87 wrong in its tenth digit", "dormand_prince_853", run_explicit,
      [](ButcherTableau& t) { shift(t.A[7][6], "1/10000000000"); }, {tableau}));
  bugs.push_back(coefficient_bug<ButcherTableau>(
      "bogacki_shampine_wrong_embedded_weights", "two entries of b^ exchanged", "bogacki_shampine_32",
      run_explicit, [](ButcherTableau& t) { std::swap(t.b_embedded[1], t.b_embedded[2]); },
      {"order of the error estimate"}));
  bugs.push_back(coefficient_bug<ButcherTableau>(
      "dormand_prince_wrong_dense_output", "one number of b_4(theta) wrong in its third digit",
      "dormand_prince_54", run_explicit, [](ButcherTableau& t) { shift(t.dense[3][1], "1/200"); },
      {"dense output"}));
  bugs.push_back(coefficient_bug<ButcherTableau>(
      "gauss3_wrong_surd_sign", "a_13 = 5/36 + sqrt(15)/30", "gauss3", run_implicit,
      [](ButcherTableau& t) { t.A[0][2] = "5/36+sqrt(15)/30"; },
      {order, damped_order, flow_order, tableau, stability, "symplectic", "reversible in time"}));
  bugs.push_back(coefficient_bug<ButcherTableau>(
      "trapezoidal_uneven_weights", "0.49 and 0.51 for 1/2 and 1/2", "trapezoidal", run_diagonal,
      [](ButcherTableau& t) {
        t.A[1] = t.b = {"0.49", "0.51"};
      },
      {order, damped_order, flow_order, "polynomial exactness", tableau, stability, "reversible in time"}));
  bugs.push_back(coefficient_bug<ButcherTableau>("sdirk4_swapped_weights", "b_2 and b_3 exchanged", "sdirk4",
                                                 run_diagonal,
                                                 [](ButcherTableau& t) { std::swap(t.b[1], t.b[2]); },
                                                 {order, flow_order, "polynomial exactness", stability}));
  bugs.push_back(coefficient_bug<SplittingScheme>(
      "forest_ruth_swapped_kicks", "kicks in the order 1 - 2 theta, theta, theta", "forest_ruth",
      run_splitting, [](SplittingScheme& s) { std::swap(s.kick[0], s.kick[1]); },
      {order, damped_order, "oscillator matrix", "reversible in time"}));
  bugs.push_back(coefficient_bug<SplittingScheme>(
      "yoshida6_weight_digit", "w_1 wrong in its sixth digit", "yoshida6", run_splitting,
      [](SplittingScheme& s) { s = with_shifted_weight(s, 0, "1/100000"); }, {order, "oscillator matrix"}));
  bugs.push_back(coefficient_bug<SplittingScheme>(
      "forest_ruth_weight_digit", "theta wrong in its sixth digit", "forest_ruth", run_splitting,
      [](SplittingScheme& s) { s = with_shifted_weight(s, 0, "1/100000"); }, {"oscillator matrix"}));
  bugs.push_back(coefficient_bug<SplittingScheme>(
      "position_verlet_uneven_drifts", "drifts 0.6 and 0.4: not symmetric", "position_verlet", run_splitting,
      [](SplittingScheme& s) {
        s.drift = {"0.6", "0.4"};
      },
      {order, damped_order, "oscillator matrix", "reversible in time"}));
  bugs.push_back(coefficient_bug<RosenbrockTableau>(
      "ros3p_wrong_gamma", "gamma_21 = -0.9 for -1", "ros3p", run_rosenbrock,
      [](RosenbrockTableau& t) { t.gamma[1][0] = "-9/10"; }, {order, flow_order, stability}));
  bugs.push_back(coefficient_bug<NystromTableau>(
      "nystrom4_wrong_position_coefficient", "a_32 = 1/3 for 1/2", "nystrom4", run_nystrom,
      [](NystromTableau& t) { t.A_position[2][1] = "1/3"; }, {order, "oscillator matrix"}));
  bugs.push_back(coefficient_bug<NystromTableau>("nystrom4_wrong_position_weights",
                                                 "the weights of the velocity in the position",
                                                 "nystrom4_general", run_nystrom,
                                                 [](NystromTableau& t) {
                                                   t.b_position = {"1/6", "1/6", "1/12", "1/12"};
                                                 },
                                                 {order, damped_order, "oscillator matrix"}));
  bugs.push_back(coefficient_bug<AdditiveTableau>(
      "ark4_wrong_coupling", "1/20 moved between two entries of the explicit part", "ark436", run_additive,
      [](AdditiveTableau& t) {
        shift(t.explicit_part.A[3][0], "1/20");
        shift(t.explicit_part.A[3][1], "-1/20");
      },
      {order, damped_order}));
  bugs.push_back(
      coefficient_bug<MultistepFormula>("bdf2_three_halves", "3/2 in place of 4/3", "bdf2", run_multistep,
                                        [](MultistepFormula& f) { f.alpha[1] = "-3/2"; },
                                        {order, damped_order, flow_order, "recurrence of the formula"}));
  bugs.push_back(coefficient_bug<MultistepFormula>(
      "adams_bashforth4_sign", "+59/24 for -59/24, balanced by the next", "adams_bashforth4", run_multistep,
      [](MultistepFormula& f) {
        f.beta[2] = "59/24";
        f.beta[1] = "-81/24";
      },
      {order, damped_order, flow_order, "recurrence of the formula"}));
  return bugs;
}

/// Wrong numbers in the catalogue: what the code does is what is listed, but not what is claimed.
inline std::vector<SeededBug> wrong_coefficients_in_the_data() {
  using namespace detail;
  using schemes::AdditiveTableau;
  using schemes::ButcherTableau;
  using schemes::MultistepFormula;
  using schemes::NystromTableau;
  using schemes::RosenbrockTableau;
  using schemes::SplittingScheme;
  const char* order = "order, forces f(t, q)";
  const char* flow_order = "order, y' = f(t, y)";
  std::vector<SeededBug> bugs;
  bugs.push_back(data_bug<ButcherTableau>("listed_rk4_with_wrong_weights", "b = (1/6, 1/4, 5/12, 1/6)", "rk4",
                                          run_explicit,
                                          [](ButcherTableau& t) {
                                            t.b[1] = "1/4";
                                            t.b[2] = "5/12";
                                          },
                                          {order, flow_order}));
  bugs.push_back(data_bug<ButcherTableau>("listed_dormand_prince_with_a_wrong_digit",
                                          "a_65 = -5103/18656 printed as -5103/18665", "dormand_prince_54",
                                          run_explicit, [](ButcherTableau& t) { t.A[5][4] = "-5103/18665"; },
                                          {order, flow_order}));
  bugs.push_back(
      data_bug<ButcherTableau>("listed_bogacki_shampine_with_wrong_embedded_weights",
                               "two entries of b^ exchanged", "bogacki_shampine_32", run_explicit,
                               [](ButcherTableau& t) { std::swap(t.b_embedded[1], t.b_embedded[2]); },
                               {"order of the error estimate"}));
  bugs.push_back(data_bug<ButcherTableau>("listed_gauss3_with_wrong_surd", "a_13 = 5/36 + sqrt(15)/30",
                                          "gauss3", run_implicit,
                                          [](ButcherTableau& t) { t.A[0][2] = "5/36+sqrt(15)/30"; },
                                          {order, flow_order, "symplectic", "reversible in time"}));
  bugs.push_back(data_bug<SplittingScheme>(
      "listed_forest_ruth_with_a_wrong_digit", "theta wrong in its sixth digit", "forest_ruth", run_splitting,
      [](SplittingScheme& s) { s = with_shifted_weight(s, 0, "1/100000"); },
      {order, "order, forces f(t, q, v)"}));
  bugs.push_back(data_bug<MultistepFormula>("listed_bdf3_with_a_wrong_sign",
                                            "+2/11 for -2/11, balanced by the next", "bdf3", run_multistep,
                                            [](MultistepFormula& f) {
                                              f.alpha[0] = "2/11";
                                              f.alpha[1] = "5/11";
                                            },
                                            {order, flow_order}));
  bugs.push_back(data_bug<RosenbrockTableau>(
      "listed_ros3p_with_wrong_gamma", "gamma_21 = -0.9 for -1", "ros3p", run_rosenbrock,
      [](RosenbrockTableau& t) { t.gamma[1][0] = "-9/10"; }, {order, flow_order}));
  bugs.push_back(data_bug<NystromTableau>("listed_nystrom5_with_a_wrong_coefficient", "a_43 = 10/35 for 9/35",
                                          "nystrom5", run_nystrom,
                                          [](NystromTableau& t) { t.A_position[3][2] = "10/35"; }, {order}));
  bugs.push_back(data_bug<AdditiveTableau>("listed_ark4_with_wrong_coupling",
                                           "1/20 moved between two entries of the explicit part", "ark436",
                                           run_additive,
                                           [](AdditiveTableau& t) {
                                             shift(t.explicit_part.A[3][0], "1/20");
                                             shift(t.explicit_part.A[3][1], "-1/20");
                                           },
                                           {order}));
  return bugs;
}

}  // namespace fw::conformance
