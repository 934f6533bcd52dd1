#include "schemes/explicit_tableaus.hpp"

#include "schemes/high_order_explicit_tableaus.hpp"

namespace fw::schemes {

namespace {

ButcherTableau explicit_euler() {
  return {.name = "explicit_euler",
          .title = "Explicit Euler",
          .A = {{}},
          .b = {1},
          .reference = "[Zachmann 2011, S8; Hairer, Norsett, Wanner 1993, I.7]"};
}

ButcherTableau midpoint() {
  return {.name = "midpoint",
          .title = "Explicit midpoint rule (Runge 2)",
          .A = {{}, {"1/2"}},
          .b = {0, 1},
          .reference = "[Zachmann 2011, S15; Runge 1895; Hairer, Norsett, Wanner 1993, II.1]"};
}

ButcherTableau heun() {
  return {.name = "heun",
          .title = "Heun's method of order 2 (explicit trapezoidal rule)",
          .A = {{}, {1}},
          .b = {"1/2", "1/2"},
          .reference = "[Heun 1900; Hairer, Norsett, Wanner 1993, II.1]"};
}

ButcherTableau ralston2() {
  return {.name = "ralston2",
          .title = "Ralston's method of order 2 (least bound of the error)",
          .A = {{}, {"2/3"}},
          .b = {"1/4", "3/4"},
          .reference = "[Ralston 1962]"};
}

ButcherTableau heun3() {
  return {.name = "heun3",
          .title = "Heun's method of order 3",
          .A = {{}, {"1/3"}, {0, "2/3"}},
          .b = {"1/4", 0, "3/4"},
          .reference = "[Heun 1900; Hairer, Norsett, Wanner 1993, II.1]"};
}

ButcherTableau kutta3() {
  return {.name = "kutta3",
          .title = "Kutta's method of order 3",
          .A = {{}, {"1/2"}, {-1, 2}},
          .b = {"1/6", "2/3", "1/6"},
          .reference = "[Kutta 1901; Butcher 2016, 232]"};
}

ButcherTableau ralston3() {
  return {.name = "ralston3",
          .title = "Ralston's method of order 3 (least bound of the error)",
          .A = {{}, {"1/2"}, {0, "3/4"}},
          .b = {"2/9", "1/3", "4/9"},
          .reference = "[Ralston 1962]"};
}

ButcherTableau ssprk3() {
  return {.name = "ssprk3",
          .title = "Strong-stability-preserving method of order 3 (Shu-Osher)",
          .A = {{}, {1}, {"1/4", "1/4"}},
          .b = {"1/6", "1/6", "2/3"},
          .reference = "[Shu, Osher 1988; Gottlieb, Shu, Tadmor 2001]"};
}

ButcherTableau rk4() {
  return {.name = "rk4",
          .title = "Classical Runge-Kutta method of order 4",
          .A = {{}, {"1/2"}, {0, "1/2"}, {0, 0, 1}},
          .b = {"1/6", "1/3", "1/3", "1/6"},
          .reference = "[Zachmann 2011, S15-S16; Kutta 1901; Hairer, Norsett, Wanner 1993, II.1]"};
}

ButcherTableau three_eighths() {
  return {.name = "three_eighths",
          .title = "Kutta's 3/8 rule of order 4",
          .A = {{}, {"1/3"}, {"-1/3", 1}, {1, -1, 1}},
          .b = {"1/8", "3/8", "3/8", "1/8"},
          .reference = "[Kutta 1901; Hairer, Norsett, Wanner 1993, II.1]"};
}

/// c₂ = 2/5, c₃ = 7/8 − 3√5/16 minimise Ralston's bound.
ButcherTableau ralston4() {
  return {.name = "ralston4",
          .title = "Ralston's method of order 4 (least bound of the error)",
          .A = {{},
                {"2/5"},
                {"(-2889+1428*sqrt(5))/1024", "(3785-1620*sqrt(5))/1024"},
                {"(-3365+2094*sqrt(5))/6040", "(-975-3046*sqrt(5))/2552", "(467040+203968*sqrt(5))/240845"}},
          .b = {"(263+24*sqrt(5))/1812", "(125-1000*sqrt(5))/3828", "1024*(3346+1623*sqrt(5))/5924787",
                "(30-4*sqrt(5))/123"},
          .reference = "[Ralston 1962]"};
}

ButcherTableau bogacki_shampine_32() {
  return {.name = "bogacki_shampine_32",
          .title = "Bogacki-Shampine pair of orders 3(2)",
          .A = {{}, {"1/2"}, {0, "3/4"}, {"2/9", "1/3", "4/9"}},
          .b = {"2/9", "1/3", "4/9", 0},
          .b_embedded = {"7/24", "1/4", "1/3", "1/8"},
          .reference = "[Bogacki, Shampine 1989]"};
}

ButcherTableau cash_karp_54() {
  return {.name = "cash_karp_54",
          .title = "Cash-Karp pair of orders 5(4)",
          .A = {{},
                {"1/5"},
                {"3/40", "9/40"},
                {"3/10", "-9/10", "6/5"},
                {"-11/54", "5/2", "-70/27", "35/27"},
                {"1631/55296", "175/512", "575/13824", "44275/110592", "253/4096"}},
          .b = {"37/378", 0, "250/621", "125/594", 0, "512/1771"},
          .b_embedded = {"2825/27648", 0, "18575/48384", "13525/55296", "277/14336", "1/4"},
          .reference = "[Cash, Karp 1990]"};
}

/// Fehlberg meant the solution of order 4 to be continued; continuing the one of order 5 (local
/// extrapolation) is what codes do.
ButcherTableau fehlberg_54() {
  return {.name = "fehlberg_54",
          .title = "Fehlberg's pair RKF45 with local extrapolation, orders 5(4)",
          .A = {{},
                {"1/4"},
                {"3/32", "9/32"},
                {"1932/2197", "-7200/2197", "7296/2197"},
                {"439/216", -8, "3680/513", "-845/4104"},
                {"-8/27", 2, "-3544/2565", "1859/4104", "-11/40"}},
          .b = {"16/135", 0, "6656/12825", "28561/56430", "-9/50", "2/55"},
          .b_embedded = {"25/216", 0, "1408/2565", "2197/4104", "-1/5", 0},
          .reference = "[Fehlberg 1969; Hairer, Norsett, Wanner 1993, II.4]"};
}

/// Dense output of order 4: the polynomials of Shampine, which minimise the error's constant.
ButcherTableau dormand_prince_54() {
  return {.name = "dormand_prince_54",
          .title = "Dormand-Prince pair of orders 5(4)",
          .A = {{},
                {"1/5"},
                {"3/40", "9/40"},
                {"44/45", "-56/15", "32/9"},
                {"19372/6561", "-25360/2187", "64448/6561", "-212/729"},
                {"9017/3168", "-355/33", "46732/5247", "49/176", "-5103/18656"},
                {"35/384", 0, "500/1113", "125/192", "-2187/6784", "11/84"}},
          .b = {"35/384", 0, "500/1113", "125/192", "-2187/6784", "11/84", 0},
          .b_embedded = {"5179/57600", 0, "7571/16695", "393/640", "-92097/339200", "187/2100", "1/40"},
          .dense = {{1, "-8048581381/2820520608", "8663915743/2820520608", "-12715105075/11282082432"},
                    {},
                    {0, "131558114200/32700410799", "-68118460800/10900136933", "87487479700/32700410799"},
                    {0, "-1754552775/470086768", "14199869525/1410260304", "-10690763975/1880347072"},
                    {0, "127303824393/49829197408", "-318862633887/49829197408", "701980252875/199316789632"},
                    {0, "-282668133/205662961", "2019193451/616988883", "-1453857185/822651844"},
                    {0, "40617522/29380423", "-110615467/29380423", "69997945/29380423"}},
          .reference = "[Dormand, Prince 1980; Shampine 1986; Hairer, Norsett, Wanner 1993, II.5-II.6]"};
}

/// Dense output of order 4. The stages' coefficients are those of the source; it prints the polynomials with
/// 16 digits, here they are the solution of their order conditions for its b₂(θ) and b₇(θ).
ButcherTableau tsitouras_54() {
  return {
      .name = "tsitouras_54",
      .title = "Tsitouras pair of orders 5(4)",
      .A = {{},
            {"0.161"},
            {"-0.008480655492356988544426874250230774675121", "0.3354806554923569885444268742502307746751"},
            {"2.897153057105493432130432594192938764925", "-6.359448489975074843148159912383825625953",
             "4.362295432869581411017727318190886861028"},
            {"5.325864828439256604428877920840511317836", "-11.74888356406282787774717033978577296189",
             "7.495539342889836208304604784564358155659", "-0.0924950663617552492565020793320719161135"},
            {"5.861455442946420028659251486982647890394", "-12.92096931784710929170611868178335939542",
             "8.159367898576158643180400794539253485182", "-0.07158497328140099722453054252582973869127",
             "-0.02826905039406838290900305721271224146718"},
            {"0.09646076681806522951816731316512876333712", "0.01",
             "0.479889650414499574775249532290596519913", "1.379008574103741893192274821856872770756",
             "-3.290069515436080679901047585711363850116", "2.324710524099773982415355918398765796109"}},
      .b = {"0.09646076681806522951816731316512876333712", "0.01",
            "0.479889650414499574775249532290596519913", "1.379008574103741893192274821856872770756",
            "-3.290069515436080679901047585711363850116", "2.324710524099773982415355918398765796109", 0},
      .b_embedded = {"0.09468075576583945807478876255758922856118",
                     "0.009183565540343253096776363936645313759814",
                     "0.4877705284247615707855642599631228241517",
                     "1.234297566930478985655109673884237654036", "-2.70771234998352545488110997505932167069",
                     "1.866628418170587035753719399566211498666", "1/66"},
      .dense = {{1, "-2.763706197274825868672988363027682259932", "2.913255461821912655418645978715879573212",
                 "-1.053088497729021557227490302523068549943"},
                {0, "0.1317", "-0.2234", "0.1017"},
                {0, "3.930296236894751517409293669459985498088", "-5.941033872131504735717589209757584916523",
                 "2.490627285651252793083545072588195938349"},
                {0, "-12.41107716693367703873047339671185493681", "30.33818863028232165023004608085120095664",
                 "-16.54810288924490271830729786228247324908"},
                {0, "37.50931341651103917897843911106474125196", "-88.17890489476640107756106856497493790438",
                 "47.37952196281928121868158186819883280231"},
                {0, "-27.89652628919728778898427102078518955331", "65.09189467479367150762996571516544229105",
                 "-34.87065786149660973623033877598148694164"},
                {0, "1.5", -4, "2.5"}},
      .reference = "[Tsitouras 2011]"};
}

}  // namespace

const std::vector<ButcherTableau>& explicit_tableaus() {
  static const std::vector<ButcherTableau> list = [] {
    std::vector<ButcherTableau> all{explicit_euler(), midpoint(),    heun(),
                                    ralston2(),       heun3(),       kutta3(),
                                    ralston3(),       ssprk3(),      rk4(),
                                    three_eighths(),  ralston4(),    bogacki_shampine_32(),
                                    cash_karp_54(),   fehlberg_54(), dormand_prince_54(),
                                    tsitouras_54()};
    const std::vector<ButcherTableau>& high = high_order_explicit_tableaus();
    all.insert(all.end(), high.begin(), high.end());
    for (const ButcherTableau& tableau : all) check_tableau(tableau);
    return all;
  }();
  return list;
}

}  // namespace fw::schemes
