#include "schemes/implicit_tableaus.hpp"

namespace fw::schemes {

namespace {

ButcherTableau gauss2() {
  return {.name = "gauss2",
          .title = "Gauss-Legendre collocation, two stages",
          .A = {{"1/4", "1/4-sqrt(3)/6"}, {"1/4+sqrt(3)/6", "1/4"}},
          .b = {"1/2", "1/2"},
          .reference = "[Hammer, Hollingsworth 1955; Hairer, Wanner 1996, IV.5]"};
}

ButcherTableau gauss3() {
  return {.name = "gauss3",
          .title = "Gauss-Legendre collocation, three stages",
          .A = {{"5/36", "2/9-sqrt(15)/15", "5/36-sqrt(15)/30"},
                {"5/36+sqrt(15)/24", "2/9", "5/36-sqrt(15)/24"},
                {"5/36+sqrt(15)/30", "2/9+sqrt(15)/15", "5/36"}},
          .b = {"5/18", "4/9", "5/18"},
          .reference = "[Kuntzmann 1961; Butcher 1964; Hairer, Wanner 1996, IV.5]"};
}

ButcherTableau radau_ia2() {
  return {.name = "radau_ia2",
          .title = "Radau IA, two stages",
          .A = {{"1/4", "-1/4"}, {"1/4", "5/12"}},
          .b = {"1/4", "3/4"},
          .reference = "[Ehle 1969; Hairer, Wanner 1996, IV.5]"};
}

ButcherTableau radau_iia2() {
  return {.name = "radau_iia2",
          .title = "Radau IIA, two stages",
          .A = {{"5/12", "-1/12"}, {"3/4", "1/4"}},
          .b = {"3/4", "1/4"},
          .reference = "[Ehle 1969; Hairer, Wanner 1996, IV.5]"};
}

ButcherTableau radau_iia3() {
  const CoefficientRow b = {"(16-sqrt(6))/36", "(16+sqrt(6))/36", "1/9"};
  return {.name = "radau_iia3",
          .title = "Radau IIA, three stages",
          .A = {{"(88-7*sqrt(6))/360", "(296-169*sqrt(6))/1800", "(-2+3*sqrt(6))/225"},
                {"(296+169*sqrt(6))/1800", "(88+7*sqrt(6))/360", "(-2-3*sqrt(6))/225"},
                b},
          .b = b,
          .reference = "[Ehle 1969; Hairer, Wanner 1996, IV.5]"};
}

ButcherTableau lobatto_iiia3() {
  return {.name = "lobatto_iiia3",
          .title = "Lobatto IIIA, three stages",
          .A = {{}, {"5/24", "1/3", "-1/24"}, {"1/6", "2/3", "1/6"}},
          .b = {"1/6", "2/3", "1/6"},
          .reference = "[Ehle 1969; Hairer, Wanner 1996, IV.5]"};
}

ButcherTableau lobatto_iiia4() {
  const CoefficientRow b = {"1/12", "5/12", "5/12", "1/12"};
  return {.name = "lobatto_iiia4",
          .title = "Lobatto IIIA, four stages",
          .A = {{},
                {"(11+sqrt(5))/120", "(25-sqrt(5))/120", "(25-13*sqrt(5))/120", "(-1+sqrt(5))/120"},
                {"(11-sqrt(5))/120", "(25+13*sqrt(5))/120", "(25+sqrt(5))/120", "(-1-sqrt(5))/120"},
                b},
          .b = b,
          .reference = "[Ehle 1969; Hairer, Wanner 1996, IV.5]"};
}

ButcherTableau lobatto_iiib3() {
  return {.name = "lobatto_iiib3",
          .title = "Lobatto IIIB, three stages",
          .A = {{"1/6", "-1/6"}, {"1/6", "1/3"}, {"1/6", "5/6"}},
          .b = {"1/6", "2/3", "1/6"},
          .reference = "[Ehle 1969; Hairer, Wanner 1996, IV.5]"};
}

ButcherTableau lobatto_iiic2() {
  return {.name = "lobatto_iiic2",
          .title = "Lobatto IIIC, two stages",
          .A = {{"1/2", "-1/2"}, {"1/2", "1/2"}},
          .b = {"1/2", "1/2"},
          .reference = "[Chipman 1971; Axelsson 1972; Hairer, Wanner 1996, IV.5]"};
}

ButcherTableau lobatto_iiic3() {
  const CoefficientRow b = {"1/6", "2/3", "1/6"};
  return {.name = "lobatto_iiic3",
          .title = "Lobatto IIIC, three stages",
          .A = {{"1/6", "-1/3", "1/6"}, {"1/6", "5/12", "-1/12"}, b},
          .b = b,
          .reference = "[Chipman 1971; Hairer, Wanner 1996, IV.5]"};
}

std::vector<ButcherTableau> checked(std::vector<ButcherTableau> list) {
  for (const ButcherTableau& tableau : list) check_tableau(tableau);
  return list;
}

}  // namespace

const std::vector<ButcherTableau>& fully_implicit_tableaus() {
  static const std::vector<ButcherTableau> list =
      checked({gauss2(), gauss3(), radau_ia2(), radau_iia2(), radau_iia3(), lobatto_iiia3(), lobatto_iiia4(),
               lobatto_iiib3(), lobatto_iiic2(), lobatto_iiic3()});
  return list;
}

}  // namespace fw::schemes
