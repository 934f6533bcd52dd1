#include "schemes/splitting_schemes.hpp"

namespace fw::schemes {

namespace {

/// row, then row without its last entry backwards.
CoefficientRow palindrome_about_last(CoefficientRow row) {
  for (std::size_t i = row.size() - 1; i-- > 0;) row.push_back(row[i]);
  return row;
}

/// row, then row backwards.
CoefficientRow palindrome(CoefficientRow row) {
  for (std::size_t i = row.size(); i-- > 0;) row.push_back(row[i]);
  return row;
}

/// One more entry, such that the palindrome about it sums to 1.
CoefficientRow with_middle(CoefficientRow row) {
  std::string rest = "1";
  for (const Coefficient& entry : row) rest += "-2*(" + entry.text() + ")";
  row.emplace_back(rest);
  return palindrome_about_last(std::move(row));
}

/// One more entry, such that the palindrome that repeats it sums to 1.
CoefficientRow with_middle_pair(CoefficientRow row) {
  std::string rest = "1/2";
  for (const Coefficient& entry : row) rest += "-(" + entry.text() + ")";
  row.emplace_back(rest);
  return palindrome(std::move(row));
}

/// 0, row, 0: the drifts of a scheme that begins and ends with a kick.
CoefficientRow between_kicks(CoefficientRow row) {
  row.insert(row.begin(), 0);
  row.emplace_back(0);
  return row;
}

SplittingScheme symplectic_euler() {
  return {.name = "symplectic_euler",
          .title = "Symplectic (semi-implicit) Euler",
          .drift = {0, 1},
          .kick = {1},
          .reference = "[Zachmann 2011, S9; Hairer, Lubich, Wanner 2006, I.1]"};
}

SplittingScheme symplectic_euler_b() {
  return {.name = "symplectic_euler_b",
          .title = "Symplectic Euler, drift before kick (the adjoint)",
          .drift = {1, 0},
          .kick = {1},
          .reference = "[Hairer, Lubich, Wanner 2006, I.1, II.3]"};
}

SplittingScheme velocity_verlet() {
  return {.name = "velocity_verlet",
          .title = "Velocity Verlet",
          .drift = {0, 1, 0},
          .kick = {"1/2", "1/2"},
          .reference = "[Swope et al. 1982; Hairer, Lubich, Wanner 2003]"};
}

SplittingScheme position_verlet() {
  return {.name = "position_verlet",
          .title = "Position Verlet (drift-kick-drift leapfrog)",
          .drift = {"1/2", "1/2"},
          .kick = {1},
          .reference = "[Tuckerman, Berne, Martyna 1992; Hairer, Lubich, Wanner 2003]"};
}

/// The least error constant of two stages.
SplittingScheme mclachlan_atela_2() {
  return {.name = "mclachlan_atela_2",
          .title = "McLachlan-Atela, order 2 with two stages",
          .drift = {0, "sqrt(2)/2", "1-sqrt(2)/2"},
          .kick = {"1-sqrt(2)/2", "sqrt(2)/2"},
          .reference = "[McLachlan, Atela 1992]"};
}

SplittingScheme ruth3() {
  return {.name = "ruth3",
          .title = "Ruth's scheme of order 3",
          .drift = {0, "2/3", "-2/3", 1},
          .kick = {"7/24", "3/4", "-1/24"},
          .reference = "[Ruth 1983]"};
}

/// a₁ solves the condition of order 3 with a₂ = 1/(4a₁) − a₁/2, a₃ = 1 − a₁ − a₂, b_i = a_{4−i}.
SplittingScheme mclachlan_atela_3() {
  const std::string a1 = "0.9196615230173998570508976381533827895633";
  const std::string a2 = "(1/(4*" + a1 + ")-" + a1 + "/2)";
  const std::string a3 = "(1-" + a1 + "-" + a2 + ")";
  return {.name = "mclachlan_atela_3",
          .title = "McLachlan-Atela, order 3 with three stages",
          .drift = {0, a1, a2, a3},
          .kick = {a3, a2, a1},
          .reference = "[McLachlan, Atela 1992]"};
}

SplittingScheme mclachlan_atela_4() {
  return {
      .name = "mclachlan_atela_4",
      .title = "McLachlan-Atela, order 4 with four stages (Nystrom type)",
      .drift = {0, "0.5153528374311229363637785875736096314659",
                "-0.08578201941297364601642501233896208684673", "0.4415830236164665242501950012872512655567",
                "0.1288461583653841854024514234781011898241"},
      .kick = {"0.1344961992774310892106592549373127421199", "-0.2248198030794208059452273636186488508399",
               "0.7563200005156682912642907949644689394951", "0.3340036032863214254702773137168671692249"},
      .reference = "[McLachlan, Atela 1992]"};
}

/// w = 1/(2 − 2^{1/3}).
SplittingScheme forest_ruth() {
  return from_symmetric_weights({.name = "forest_ruth",
                                 .title = "Forest-Ruth (Yoshida 4), order 4 by triple jump",
                                 .reference = "[Forest, Ruth 1990; Yoshida 1990; Creutz, Gocksch 1989]"},
                                {"1.351207191959657634047687808971460826922"});
}

/// w = 1/(4 − 4^{1/3}).
SplittingScheme suzuki4() {
  return from_symmetric_weights(
      {.name = "suzuki4",
       .title = "Suzuki's fractal of order 4",
       .reference = "[Suzuki 1990; Hairer, Lubich, Wanner 2006, II.4]"},
      {"0.4144907717943757371423540628607614957118", "0.4144907717943757371423540628607614957118"});
}

SplittingScheme pefrl() {
  const std::string xi = "0.1786178958448090670599037670811929367843";
  const std::string lambda = "-0.2123418310626054038318904580688403927837";
  const std::string chi = "-0.06626458266981849627801562176460284253787";
  return {.name = "pefrl",
          .title = "Position-extended Forest-Ruth-like scheme (PEFRL), order 4",
          .drift = with_middle({xi, chi}),
          .kick = palindrome({"(1-2*(" + lambda + "))/2", lambda}),
          .reference = "[Omelyan, Mryglod, Folk 2002]"};
}

SplittingScheme mclachlan4() {
  return {.name = "mclachlan4",
          .title = "McLachlan's scheme of order 4 with five stages",
          .drift = with_middle_pair({"(14-sqrt(19))/108", "(20-7*sqrt(19))/108"}),
          .kick = {"2/5", "-1/10", "2/5", "-1/10", "2/5"},
          .reference = "[McLachlan 1995]"};
}

SplittingScheme blanes_moan4() {
  return {.name = "blanes_moan4",
          .title = "Blanes-Moan S6, order 4 with six stages",
          .drift = with_middle({"0.07920369643119566943366349588826887330802",
                                "0.3531729060497739884810613115731210565304",
                                "-0.04206508035771953536811029830251703872041"}),
          .kick = with_middle_pair(
              {"0.2095151066133620212740726400295010169021", "-0.1438517731798180082751150578565277256482"}),
          .reference = "[Blanes, Moan 2002]"};
}

SplittingScheme blanes_moan_rkn4() {
  return {.name = "blanes_moan_rkn4",
          .title = "Blanes-Moan SRKN6b, order 4 with six stages (Nystrom type)",
          .drift = between_kicks(with_middle_pair(
              {"0.2452989571842711626039324260014008804072", "0.604872665711079974960892697643076245221"})),
          .kick = with_middle({"0.08298440641740501883834747894225011249475",
                               "0.3963098014983680770949115282636867393961",
                               "-0.03905630492234843517086529076537924228761"}),
          .reference = "[Blanes, Moan 2002]"};
}

/// Solution A of three.
SplittingScheme yoshida6() {
  return from_symmetric_weights(
      {.name = "yoshida6",
       .title = "Yoshida's composition of order 6 (solution A)",
       .reference = "[Yoshida 1990; Hairer, Lubich, Wanner 2006, V.3]"},
      {"0.7845136104775572638194976338663498757768", "0.2355732133593581336847931829785346016865",
       "-1.177679984178871006946415680964315734639"});
}

SplittingScheme kahan_li6() {
  return from_symmetric_weights(
      {.name = "kahan_li6",
       .title = "Kahan-Li composition of order 6 with nine stages",
       .reference = "[Kahan, Li 1997; Hairer, Lubich, Wanner 2006, V.3]"},
      {"0.3921614440073141392792505574226714038049", "0.3325991367893594385997486375000496468816",
       "-0.7062461725576393598099648195492564593955", "0.08221359629355080023149044810205633110329"});
}

SplittingScheme blanes_moan6() {
  return {.name = "blanes_moan6",
          .title = "Blanes-Moan S10, order 6 with ten stages",
          .drift = with_middle(
              {"0.05026276440039268602122165440207410940601", "0.4135143004283438150630637201338844389753",
               "0.04507988979439806296889705212451347116172", "-0.1880548538195689147991284889188705424878",
               "0.5419606784507801348314147409330724963482"}),
          .kick = with_middle_pair(
              {"0.1488164479010432319209010055355775888774", "-0.1323858657677836474488454265989399215745",
               "0.06730760469218445815025789659260104689936", "0.4326664025781735975276679708835452980582"}),
          .reference = "[Blanes, Moan 2002]"};
}

SplittingScheme blanes_moan_rkn6() {
  return {.name = "blanes_moan_rkn6",
          .title = "Blanes-Moan SRKN11b, order 6 with eleven stages (Nystrom type)",
          .drift = between_kicks(with_middle(
              {"0.1232297759462711515610863803333667525905", "0.2905537977995582703664141693279161833302",
               "-0.127049212625416915662505053827485934473", "-0.246331761062075404194973489104062862596",
               "0.3572088727959277526198603496193104628369"})),
          .kick = with_middle_pair(
              {"0.04146499851826284329877813391470493672394", "0.1981286719180665411367264731814969606125",
               "-0.04000619210415268688882836353594483937569", "0.07525398430158034112787887852704275554175",
               "-0.01151138742068777006244320150128919955259"}),
          .reference = "[Blanes, Moan 2002]"};
}

/// Solution D of five, as printed good to 12 digits only.
SplittingScheme yoshida8() {
  return from_symmetric_weights(
      {.name = "yoshida8",
       .title = "Yoshida's composition of order 8 (solution D)",
       .reference = "[Yoshida 1990; Hairer, Lubich, Wanner 2006, V.3]"},
      {"0.9148442462297915667487934898475096045181", "0.2536933365662113541461460206899420760977",
       "-1.444852236860605157694730657537390354956", "-0.1582406353680501752040667767597542477554",
       "1.938139137622525986579186487443641760954", "-1.960610232975310807607633376399663640792",
       "0.102799849391796440698115131601225862911"});
}

SplittingScheme kahan_li8() {
  return from_symmetric_weights(
      {.name = "kahan_li8",
       .title = "Kahan-Li composition of order 8 with seventeen stages",
       .reference = "[Kahan, Li 1997; Hairer, Lubich, Wanner 2006, V.3]"},
      {"0.1302024830888900808788176320967005223572", "0.5611629817751083845619644077001505672662",
       "-0.3894749626448472864080785982352483888361", "0.1588419065551556008962107457071524814121",
       "-0.3959038941332375773362315393479389360268", "0.184539640978315707091832541533375462819",
       "0.2583743876863220472939791099949394718131", "0.2950117236093102988709662402182281129765"});
}

}  // namespace

SplittingScheme from_symmetric_weights(SplittingScheme names, const CoefficientRow& weights) {
  names.kick = with_middle(weights);
  names.drift.clear();
  std::string previous = "0";
  for (const Coefficient& weight : names.kick) {
    names.drift.emplace_back("((" + previous + ")+(" + weight.text() + "))/2");
    previous = weight.text();
  }
  names.drift.emplace_back("(" + previous + ")/2");
  return names;
}

const std::vector<SplittingScheme>& splitting_schemes() {
  static const std::vector<SplittingScheme> list{symplectic_euler(),
                                                 symplectic_euler_b(),
                                                 velocity_verlet(),
                                                 position_verlet(),
                                                 mclachlan_atela_2(),
                                                 ruth3(),
                                                 mclachlan_atela_3(),
                                                 mclachlan_atela_4(),
                                                 forest_ruth(),
                                                 suzuki4(),
                                                 pefrl(),
                                                 mclachlan4(),
                                                 blanes_moan4(),
                                                 blanes_moan_rkn4(),
                                                 yoshida6(),
                                                 kahan_li6(),
                                                 blanes_moan6(),
                                                 blanes_moan_rkn6(),
                                                 yoshida8(),
                                                 kahan_li8()};
  return list;
}

}  // namespace fw::schemes
