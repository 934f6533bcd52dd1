#include "schemes/implicit_tableaus.hpp"

namespace fw::schemes {

namespace {

ButcherTableau implicit_euler() {
  return {.name = "implicit_euler",
          .title = "Implicit Euler (Newton to convergence)",
          .A = {{1}},
          .b = {1},
          .reference = "[Zachmann 2011, S22; Hairer, Wanner 1996, IV.3]"};
}

ButcherTableau implicit_midpoint() {
  return {.name = "implicit_midpoint",
          .title = "Implicit midpoint rule (Gauss, one stage)",
          .A = {{"1/2"}},
          .b = {1},
          .reference = "[Hairer, Lubich, Wanner 2006, II.1; Hairer, Wanner 1996, IV.5]"};
}

ButcherTableau trapezoidal() {
  return {.name = "trapezoidal",
          .title = "Implicit trapezoidal rule (Lobatto IIIA, two stages)",
          .A = {{}, {"1/2", "1/2"}},
          .b = {"1/2", "1/2"},
          .reference = "[Hairer, Lubich, Wanner 2006, II.1; Hairer, Wanner 1996, IV.3]"};
}

/// γ = (3 + √3)/6, the one of two choices that is A-stable.
ButcherTableau crouzeix3() {
  return {.name = "crouzeix3",
          .title = "Crouzeix' two-stage SDIRK method of order 3",
          .A = {{"(3+sqrt(3))/6"}, {"-sqrt(3)/3", "(3+sqrt(3))/6"}},
          .b = {"1/2", "1/2"},
          .reference = "[Crouzeix 1975; Norsett 1974; Hairer, Norsett, Wanner 1993, II.7]"};
}

ButcherTableau sdirk2() {
  return {.name = "sdirk2",
          .title = "Alexander's L-stable SDIRK method of order 2",
          .A = {{"1-sqrt(2)/2"}, {"sqrt(2)/2", "1-sqrt(2)/2"}},
          .b = {"sqrt(2)/2", "1-sqrt(2)/2"},
          .reference = "[Alexander 1977; Hairer, Wanner 1996, IV.6]"};
}

/// γ is the root of x³ − 3x² + 3x/2 − 1/6 in (1/6, 1/2), here to 40 digits; the rest follows from it.
ButcherTableau sdirk3() {
  const std::string g = "0.4358665215084589994160194511935568425293";
  const std::string b1 = "(0-6*" + g + "*" + g + "+16*" + g + "-1)/4";
  const std::string b2 = "(6*" + g + "*" + g + "-20*" + g + "+5)/4";
  return {.name = "sdirk3",
          .title = "Alexander's L-stable SDIRK method of order 3",
          .A = {{g}, {"(1-" + g + ")/2", g}, {b1, b2, g}},
          .b = {b1, b2, g},
          .reference = "[Alexander 1977; Hairer, Wanner 1996, IV.6]"};
}

ButcherTableau sdirk4() {
  return {.name = "sdirk4",
          .title = "L-stable SDIRK method of order 4(3), five stages",
          .A = {{"1/4"},
                {"1/2", "1/4"},
                {"17/50", "-1/25", "1/4"},
                {"371/1360", "-137/2720", "15/544", "1/4"},
                {"25/24", "-49/48", "125/16", "-85/12", "1/4"}},
          .b = {"25/24", "-49/48", "125/16", "-85/12", "1/4"},
          .b_embedded = {"59/48", "-17/96", "225/32", "-85/12", 0},
          .reference = "[Hairer, Wanner 1996, IV.6, table 6.5]"};
}

/// With γ = 2 − √2 the matrices of both halves agree.
ButcherTableau tr_bdf2() {
  return {.name = "tr_bdf2",
          .title = "TR-BDF2, trapezoidal rule and BDF2 in one step",
          .A = {{}, {"1-sqrt(2)/2", "1-sqrt(2)/2"}, {"sqrt(2)/4", "sqrt(2)/4", "1-sqrt(2)/2"}},
          .b = {"sqrt(2)/4", "sqrt(2)/4", "1-sqrt(2)/2"},
          .b_embedded = {"(4-sqrt(2))/12", "(4+3*sqrt(2))/12", "(2-sqrt(2))/6"},
          .reference = "[Bank et al. 1985; Hosea, Shampine 1996]"};
}

std::vector<ButcherTableau> checked(std::vector<ButcherTableau> list) {
  for (const ButcherTableau& tableau : list) check_tableau(tableau);
  return list;
}

}  // namespace

Coefficient quotient(const char* text) {
  constexpr double printed_precision = 1e-25;
  return Coefficient::approximation(text, printed_precision);
}

ButcherTableau esdirk3() {
  const Coefficient g = quotient("1767732205903/4055673282236");
  const CoefficientRow b = {quotient("1471266399579/7840856788654"), quotient("-4482444167858/7529755066697"),
                            quotient("11266239266428/11593286722821"), g};
  return {.name = "esdirk3",
          .title = "ESDIRK method of order 3(2), implicit part of ARK3(2)4L[2]SA",
          .A = {{},
                {g, g},
                {quotient("2746238789719/10658868560708"), quotient("-640167445237/6845629431997"), g},
                b},
          .b = b,
          .b_embedded = {quotient("2756255671327/12835298489170"), quotient("-10771552573575/22201958757719"),
                         quotient("9247589265047/10645013368117"), quotient("2193209047091/5459859503100")},
          .reference = "[Kennedy, Carpenter 2003]"};
}

ButcherTableau esdirk4() {
  const CoefficientRow b = {"82889/524892", 0, "15625/83664", "69875/102672", "-2260/8211", "1/4"};
  return {.name = "esdirk4",
          .title = "ESDIRK method of order 4(3), implicit part of ARK4(3)6L[2]SA",
          .A = {{},
                {"1/4", "1/4"},
                {"8611/62500", "-1743/31250", "1/4"},
                {"5012029/34652500", "-654441/2922500", "174375/388108", "1/4"},
                {"15267082809/155376265600", "-71443401/120774400", "730878875/902184768", "2285395/8070912",
                 "1/4"},
                b},
          .b = b,
          .b_embedded = {"4586570599/29645900160", 0, "178811875/945068544", "814220225/1159782912",
                         "-3700637/11593932", "61727/225920"},
          .reference = "[Kennedy, Carpenter 2003]"};
}

ButcherTableau esdirk5() {
  const Coefficient g = "41/200";
  const CoefficientRow b = {quotient("-872700587467/9133579230613"),
                            0,
                            0,
                            quotient("22348218063261/9555858737531"),
                            quotient("-1143369518992/8141816002931"),
                            quotient("-39379526789629/19018526304540"),
                            quotient("32727382324388/42900044865799"),
                            g};
  return {
      .name = "esdirk5",
      .title = "ESDIRK method of order 5(4), implicit part of ARK5(4)8L[2]SA",
      .A = {{},
            {g, g},
            {"41/400", quotient("-567603406766/11931857230679"), g},
            {quotient("683785636431/9252920307686"), 0, quotient("-110385047103/1367015193373"), g},
            {quotient("3016520224154/10081342136671"), 0, quotient("30586259806659/12414158314087"),
             quotient("-22760509404356/11113319521817"), g},
            {quotient("218866479029/1489978393911"), 0, quotient("638256894668/5436446318841"),
             quotient("-1179710474555/5321154724896"), quotient("-60928119172/8023461067671"), g},
            {quotient("1020004230633/5715676835656"), 0, quotient("25762820946817/25263940353407"),
             quotient("-2161375909145/9755907335909"), quotient("-211217309593/5846859502534"),
             quotient("-4269925059573/7827059040749"), g},
            b},
      .b = b,
      .b_embedded = {quotient("-975461918565/9796059967033"), 0, 0, quotient("78070527104295/32432590147079"),
                     quotient("-548382580838/3424219808633"), quotient("-33438840321285/15594753105479"),
                     quotient("3629800801594/4656183773603"), quotient("4035322873751/18575991585200")},
      .reference = "[Kennedy, Carpenter 2003]"};
}

const std::vector<ButcherTableau>& diagonally_implicit_tableaus() {
  static const std::vector<ButcherTableau> list =
      checked({implicit_euler(), implicit_midpoint(), trapezoidal(), crouzeix3(), sdirk2(), sdirk3(),
               sdirk4(), tr_bdf2(), esdirk3(), esdirk4(), esdirk5()});
  return list;
}

}  // namespace fw::schemes
