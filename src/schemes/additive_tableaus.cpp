#include "schemes/additive_tableaus.hpp"

#include <utility>

#include "schemes/implicit_tableaus.hpp"

namespace fw::schemes {

namespace {

/// A method of Kennedy and Carpenter: the weights of both parts are those of the implicit one.
AdditiveTableau kennedy_carpenter(std::string name, std::string title, ButcherTableau implicit_part,
                                  std::vector<CoefficientRow> explicit_rows) {
  AdditiveTableau tableau{
      .name = std::move(name), .title = std::move(title), .reference = "[Kennedy, Carpenter 2003]"};
  tableau.explicit_part = {.name = tableau.name + ", explicit part",
                           .title = tableau.title,
                           .A = std::move(explicit_rows),
                           .b = implicit_part.b,
                           .b_embedded = implicit_part.b_embedded,
                           .reference = tableau.reference};
  tableau.implicit_part = std::move(implicit_part);
  return tableau;
}

AdditiveTableau imex_euler() {
  return {.name = "imex_euler",
          .title = "Implicit-explicit Euler",
          .explicit_part = {.name = "imex_euler, explicit part", .A = {{}, {1}}, .b = {1, 0}},
          .implicit_part = {.name = "imex_euler, implicit part", .A = {{}, {0, 1}}, .b = {0, 1}},
          .reference = "[Ascher, Ruuth, Spiteri 1997]"};
}

AdditiveTableau ark324() {
  return kennedy_carpenter(
      "ark324", "ARK3(2)4L[2]SA, additive Runge-Kutta of order 3(2)", esdirk3(),
      {{},
       {quotient("1767732205903/2027836641118")},
       {quotient("5535828885825/10492691773637"), quotient("788022342437/10882634858940")},
       {quotient("6485989280629/16251701735622"), quotient("-4246266847089/9704473918619"),
        quotient("10755448449292/10357097424841")}});
}

AdditiveTableau ark436() {
  return kennedy_carpenter(
      "ark436", "ARK4(3)6L[2]SA, additive Runge-Kutta of order 4(3)", esdirk4(),
      {{},
       {"1/2"},
       {"13861/62500", "6889/62500"},
       {quotient("-116923316275/2393684061468"), quotient("-2731218467317/15368042101831"),
        quotient("9408046702089/11113171139209")},
       {quotient("-451086348788/2902428689909"), quotient("-2682348792572/7519795681897"),
        quotient("12662868775082/11960479115383"), quotient("3355817975965/11060851509271")},
       {quotient("647845179188/3216320057751"), quotient("73281519250/8382639484533"),
        quotient("552539513391/3454668386233"), quotient("3354512671639/8306763924573"), "4040/17871"}});
}

AdditiveTableau ark548() {
  return kennedy_carpenter(
      "ark548", "ARK5(4)8L[2]SA, additive Runge-Kutta of order 5(4)", esdirk5(),
      {{},
       {"41/100"},
       {quotient("367902744464/2072280473677"), quotient("677623207551/8224143866563")},
       {quotient("1268023523408/10340822734521"), 0, quotient("1029933939417/13636558850479")},
       {quotient("14463281900351/6315353703477"), 0, quotient("66114435211212/5879490589093"),
        quotient("-54053170152839/4284798021562")},
       {quotient("14090043504691/34967701212078"), 0, quotient("15191511035443/11219624916014"),
        quotient("-18461159152457/12425892160975"), quotient("-281667163811/9011619295870")},
       {quotient("19230459214898/13134317526959"), 0, quotient("21275331358303/2942455364971"),
        quotient("-38145345988419/4862620318723"), "-1/8", "-1/8"},
       {quotient("-19977161125411/11928030595625"), 0, quotient("-40795976796054/6384907823539"),
        quotient("177454434618887/12078138498510"), quotient("782672205425/8267701900261"),
        quotient("-69563011059811/9646580694205"), quotient("7356628210526/4942186776405")}});
}

}  // namespace

const std::vector<AdditiveTableau>& additive_tableaus() {
  static const std::vector<AdditiveTableau> list = {imex_euler(), ark324(), ark436(), ark548()};
  return list;
}

}  // namespace fw::schemes
