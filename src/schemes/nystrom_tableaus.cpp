#include "schemes/nystrom_tableaus.hpp"

namespace fw::schemes {

namespace {

NystromTableau nystrom4() {
  return {.name = "nystrom4",
          .title = "Nystrom's method of order 4 for position forces",
          .c = {0, "1/2", 1},
          .A_position = {{}, {"1/8"}, {0, "1/2"}},
          .b_position = {"1/6", "1/3", 0},
          .b_velocity = {"1/6", "2/3", "1/6"},
          .reference = "[Nystrom 1925; Hairer, Norsett, Wanner 1993, II.14]"};
}

NystromTableau nystrom4_general() {
  return {.name = "nystrom4_general",
          .title = "Nystrom's method of order 4 for forces that depend on velocity",
          .c = {0, "1/2", "1/2", 1},
          .A_position = {{}, {"1/8"}, {"1/8", 0}, {0, 0, "1/2"}},
          .A_velocity = {{}, {"1/2"}, {0, "1/2"}, {0, 0, 1}},
          .b_position = {"1/6", "1/6", "1/6", 0},
          .b_velocity = {"1/6", "1/3", "1/3", "1/6"},
          .reference = "[Nystrom 1925; Hairer, Norsett, Wanner 1993, II.14]"};
}

NystromTableau nystrom5() {
  return {.name = "nystrom5",
          .title = "Nystrom's method of order 5 for position forces",
          .c = {0, "1/5", "2/3", 1},
          .A_position = {{}, {"1/50"}, {"-1/27", "7/27"}, {"3/10", "-2/35", "9/35"}},
          .b_position = {"1/24", "25/84", "9/56", 0},
          .b_velocity = {"1/24", "125/336", "27/56", "5/48"},
          .reference = "[Nystrom 1925; Hairer, Norsett, Wanner 1993, II.14]"};
}

/// The last stage is the new state, so that its force serves the next step.
NystromTableau dormand_prince_rkn_64() {
  return {.name = "dormand_prince_rkn_64",
          .title = "Dormand-El-Mikkawy-Prince Nystrom pair of orders 6(4)",
          .c = {0, "(209-sqrt(8581))/900", "(209-sqrt(8581))/450", "(209+sqrt(8581))/450", "9/10", 1},
          .A_position = {{},
                         {"(26131-209*sqrt(8581))/810000"},
                         {"(26131-209*sqrt(8581))/607500", "(26131-209*sqrt(8581))/303750"},
                         {"(980403512254+7781688431*sqrt(8581))/11694469921875",
                          "-(1262884486208+15385481287*sqrt(8581))/11694469921875",
                          "(7166233891441+78694563299*sqrt(8581))/46777879687500"},
                         {"-9*(329260+3181*sqrt(8581))/27040000", "27*(35129+3331*sqrt(8581))/13520000",
                          "-27*(554358343+31040327*sqrt(8581))/464060480000",
                          "153*(8555257-67973*sqrt(8581))/2745920000"},
                         {"329/4212", 0, "(84119543+366727*sqrt(8581))/409622616",
                          "(84119543-366727*sqrt(8581))/409622616", "200/17901"}},
          .b_position = {"329/4212", 0, "(84119543+366727*sqrt(8581))/409622616",
                         "(84119543-366727*sqrt(8581))/409622616", "200/17901", 0},
          .b_velocity = {"329/4212", 0, "(389225579+96856*sqrt(8581))/1024056540",
                         "(389225579-96856*sqrt(8581))/1024056540", "2000/17901", "1/20"},
          .b_position_embedded = {"(2701+23*sqrt(8581))/4563", "-(9829+131*sqrt(8581))/9126",
                                  "5*(1798+17*sqrt(8581))/9126", 0, 0, 0},
          .b_velocity_embedded = {"115/2106", 0, "(84119543+366727*sqrt(8581))/256014135",
                                  "(84119543-366727*sqrt(8581))/256014135", "6950/17901", "-1/10"},
          .reference = "[Dormand, El-Mikkawy, Prince 1987]"};
}

/// The last stage is the new state, so that its force serves the next step.
NystromTableau dormand_prince_rkn_86() {
  return {.name = "dormand_prince_rkn_86",
          .title = "Dormand-El-Mikkawy-Prince Nystrom pair of orders 8(6)",
          .c = {0, "1/20", "1/10", "3/10", "1/2", "7/10", "9/10", 1, 1},
          .A_position = {{},
                         {"1/800"},
                         {"1/600", "1/300"},
                         {"9/200", "-9/100", "9/100"},
                         {"-66701/197352", "28325/32892", "-2665/5482", "2170/24669"},
                         {"227015747/304251000", "-54897451/30425100", "12942349/10141700", "-9499/304251",
                          "539/9250"},
                         {"-1131891597/901789000", "41964921/12882700", "-6663147/3220675", "270954/644135",
                          "-108/5875", "114/1645"},
                         {"13836959/3667458", "-17731450/1833729", "1063919505/156478208",
                          "-33213845/39119552", "13335/28544", "-705/14272", "1645/57088"},
                         {"223/7938", 0, "1175/8064", "925/6048", "41/448", "925/14112", "1175/72576"}},
          .b_position = {"223/7938", 0, "1175/8064", "925/6048", "41/448", "925/14112", "1175/72576", 0, 0},
          .b_velocity = {"223/7938", 0, "5875/36288", "4625/21168", "41/224", "4625/21168", "5875/36288",
                         "223/7938", 0},
          .b_position_embedded = {"7987313/109941300", 0, "1610737/44674560", "10023263/33505920",
                                  "-497221/12409600", "10023263/78180480", "1610737/402071040", 0, 0},
          .b_velocity_embedded = {"7987313/109941300", 0, "1610737/40207104", "10023263/23454144",
                                  "-497221/6204800", "10023263/23454144", "1610737/40207104",
                                  "-4251941/54970650", "3/20"},
          .reference = "[Dormand, El-Mikkawy, Prince 1987]"};
}

/// Positions by Lobatto IIIA with the matrix A, velocities by Lobatto IIIB with Â, 3 stages: ā = A Â, a = Â,
/// b̄ = bᵀÂ. The pair with 2 stages is velocity Verlet.
NystromTableau lobatto_iiia_iiib3() {
  return {.name = "lobatto_iiia_iiib3",
          .title = "Lobatto IIIA-IIIB pair with 3 stages",
          .c = {0, "1/2", 1},
          .A_position = {{}, {"1/12", "1/24"}, {"1/6", "1/3"}},
          .A_velocity = {{"1/6", "-1/6"}, {"1/6", "1/3"}, {"1/6", "5/6"}},
          .b_position = {"1/6", "1/3", 0},
          .b_velocity = {"1/6", "2/3", "1/6"},
          .reference = "[Sun 1993; Jay 1996; Hairer, Lubich, Wanner 2006, II.2, VI.4]"};
}

}  // namespace

const std::vector<NystromTableau>& nystrom_tableaus() {
  static const std::vector<NystromTableau> list{nystrom4(), nystrom4_general(), nystrom5(),
                                                dormand_prince_rkn_64(), dormand_prince_rkn_86()};
  return list;
}

const std::vector<NystromTableau>& implicit_nystrom_tableaus() {
  static const std::vector<NystromTableau> list{lobatto_iiia_iiib3()};
  return list;
}

}  // namespace fw::schemes
