#pragma once

#include <string>
#include <vector>

#include "oracles/sundials/arkode_objects.hpp"
#include "schemes/additive_tableau.hpp"
#include "schemes/butcher_tableau.hpp"

namespace fw::oracles::detail {

/// The coefficients of a run in ARKODE: a table for the explicit part, the implicit part, or both.
struct ArkodeTables {
  std::string name;  ///< of the tableau, ours or ARKODE's
  ButcherTablePointer explicit_part;
  ButcherTablePointer implicit_part;
  int order = 0;
  int embedded_order = 0;  ///< 0: no error estimate, constant steps only
};

/// One of our tableaus in ARKODE's form, `order` and `embedded_order` as derived from it.
ButcherTablePointer make_table(const schemes::ButcherTableau& tableau, int order, int embedded_order);

/// Our tableaus by name: of `explicit_tableaus()`, `diagonally_implicit_tableaus()`, `additive_tableaus()`.
/// InputError with the nearest name.
ArkodeTables explicit_tables(const schemes::ButcherTableau& tableau);
ArkodeTables diagonally_implicit_tables(const schemes::ButcherTableau& tableau);
ArkodeTables additive_tables(const schemes::AdditiveTableau& tableau);

/// ARKODE's own tables by their names without the prefix, in lower case: "dormand_prince_7_4_5"
/// (stages, order of the embedding, order). InputError with the nearest name.
ArkodeTables built_in_explicit_tables(const std::string& name);
ArkodeTables built_in_diagonally_implicit_tables(const std::string& name);
/// "ark436l2sa_6_3_4": the pair of an explicit and a diagonally implicit table.
ArkodeTables built_in_additive_tables(const std::string& name);

/// MRIStep's explicit couplings: "mri_gark_erk33a" and so on.
CouplingPointer built_in_coupling(const std::string& name);

}  // namespace fw::oracles::detail
