#include "oracles/sundials/arkode_tables.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "oracles/sundials/arkode_table_names.hpp"
#include "schemes/order_conditions.hpp"
#include "text/closest_name.hpp"

namespace fw::oracles {

namespace {

using ExplicitTable = std::pair<std::string, ARKODE_ERKTableID>;
using ImplicitTable = std::pair<std::string, ARKODE_DIRKTableID>;
using Coupling = std::pair<std::string, ARKODE_MRITableID>;

struct AdditivePair {
  std::string first;
  std::pair<ARKODE_ERKTableID, ARKODE_DIRKTableID> second;
};

const std::vector<ExplicitTable>& explicit_list() {
  static const std::vector<ExplicitTable> list = {{"heun_euler_2_1_2", ARKODE_HEUN_EULER_2_1_2},
                                                  {"bogacki_shampine_4_2_3", ARKODE_BOGACKI_SHAMPINE_4_2_3},
                                                  {"ark324l2sa_erk_4_2_3", ARKODE_ARK324L2SA_ERK_4_2_3},
                                                  {"zonneveld_5_3_4", ARKODE_ZONNEVELD_5_3_4},
                                                  {"ark436l2sa_erk_6_3_4", ARKODE_ARK436L2SA_ERK_6_3_4},
                                                  {"sayfy_aburub_6_3_4", ARKODE_SAYFY_ABURUB_6_3_4},
                                                  {"cash_karp_6_4_5", ARKODE_CASH_KARP_6_4_5},
                                                  {"fehlberg_6_4_5", ARKODE_FEHLBERG_6_4_5},
                                                  {"dormand_prince_7_4_5", ARKODE_DORMAND_PRINCE_7_4_5},
                                                  {"ark548l2sa_erk_8_4_5", ARKODE_ARK548L2SA_ERK_8_4_5},
                                                  {"verner_8_5_6", ARKODE_VERNER_8_5_6},
                                                  {"fehlberg_13_7_8", ARKODE_FEHLBERG_13_7_8},
                                                  {"knoth_wolke_3_3", ARKODE_KNOTH_WOLKE_3_3},
                                                  {"ark437l2sa_erk_7_3_4", ARKODE_ARK437L2SA_ERK_7_3_4},
                                                  {"ark548l2sab_erk_8_4_5", ARKODE_ARK548L2SAb_ERK_8_4_5}};
  return list;
}

const std::vector<ImplicitTable>& implicit_list() {
  static const std::vector<ImplicitTable> list = {{"sdirk_2_1_2", ARKODE_SDIRK_2_1_2},
                                                  {"billington_3_3_2", ARKODE_BILLINGTON_3_3_2},
                                                  {"trbdf2_3_3_2", ARKODE_TRBDF2_3_3_2},
                                                  {"kvaerno_4_2_3", ARKODE_KVAERNO_4_2_3},
                                                  {"ark324l2sa_dirk_4_2_3", ARKODE_ARK324L2SA_DIRK_4_2_3},
                                                  {"cash_5_2_4", ARKODE_CASH_5_2_4},
                                                  {"cash_5_3_4", ARKODE_CASH_5_3_4},
                                                  {"sdirk_5_3_4", ARKODE_SDIRK_5_3_4},
                                                  {"kvaerno_5_3_4", ARKODE_KVAERNO_5_3_4},
                                                  {"ark436l2sa_dirk_6_3_4", ARKODE_ARK436L2SA_DIRK_6_3_4},
                                                  {"kvaerno_7_4_5", ARKODE_KVAERNO_7_4_5},
                                                  {"ark548l2sa_dirk_8_4_5", ARKODE_ARK548L2SA_DIRK_8_4_5},
                                                  {"ark437l2sa_dirk_7_3_4", ARKODE_ARK437L2SA_DIRK_7_3_4},
                                                  {"ark548l2sab_dirk_8_4_5", ARKODE_ARK548L2SAb_DIRK_8_4_5},
                                                  {"esdirk324l2sa_4_2_3", ARKODE_ESDIRK324L2SA_4_2_3},
                                                  {"esdirk325l2sa_5_2_3", ARKODE_ESDIRK325L2SA_5_2_3},
                                                  {"esdirk32i5l2sa_5_2_3", ARKODE_ESDIRK32I5L2SA_5_2_3},
                                                  {"esdirk436l2sa_6_3_4", ARKODE_ESDIRK436L2SA_6_3_4},
                                                  {"esdirk43i6l2sa_6_3_4", ARKODE_ESDIRK43I6L2SA_6_3_4},
                                                  {"qesdirk436l2sa_6_3_4", ARKODE_QESDIRK436L2SA_6_3_4},
                                                  {"esdirk437l2sa_7_3_4", ARKODE_ESDIRK437L2SA_7_3_4},
                                                  {"esdirk547l2sa_7_4_5", ARKODE_ESDIRK547L2SA_7_4_5},
                                                  {"esdirk547l2sa2_7_4_5", ARKODE_ESDIRK547L2SA2_7_4_5}};
  return list;
}

const std::vector<AdditivePair>& additive_list() {
  static const std::vector<AdditivePair> list = {
      {"ark324l2sa_4_2_3", {ARKODE_ARK324L2SA_ERK_4_2_3, ARKODE_ARK324L2SA_DIRK_4_2_3}},
      {"ark436l2sa_6_3_4", {ARKODE_ARK436L2SA_ERK_6_3_4, ARKODE_ARK436L2SA_DIRK_6_3_4}},
      {"ark437l2sa_7_3_4", {ARKODE_ARK437L2SA_ERK_7_3_4, ARKODE_ARK437L2SA_DIRK_7_3_4}},
      {"ark548l2sa_8_4_5", {ARKODE_ARK548L2SA_ERK_8_4_5, ARKODE_ARK548L2SA_DIRK_8_4_5}},
      {"ark548l2sab_8_4_5", {ARKODE_ARK548L2SAb_ERK_8_4_5, ARKODE_ARK548L2SAb_DIRK_8_4_5}}};
  return list;
}

const std::vector<Coupling>& coupling_list() {
  static const std::vector<Coupling> list = {{"mis_kw3", ARKODE_MIS_KW3},
                                             {"mri_gark_erk33a", ARKODE_MRI_GARK_ERK33a},
                                             {"mri_gark_erk45a", ARKODE_MRI_GARK_ERK45a}};
  return list;
}

template <class Entry>
std::vector<std::string> names(const std::vector<Entry>& list) {
  std::vector<std::string> result;
  for (const Entry& entry : list) result.push_back(entry.first);
  return result;
}

template <class Entry>
auto find(const std::vector<Entry>& list, const char* what, const std::string& name) {
  for (const Entry& entry : list) {
    if (entry.first == name) return entry.second;
  }
  throw InputError(fmt::format("unknown {} \"{}\" of ARKODE{}", what, name, did_you_mean(name, names(list))));
}

}  // namespace

std::vector<std::string> arkode_explicit_tables() {
  return names(explicit_list());
}
std::vector<std::string> arkode_diagonally_implicit_tables() {
  return names(implicit_list());
}
std::vector<std::string> arkode_additive_tables() {
  return names(additive_list());
}
std::vector<std::string> arkode_couplings() {
  return names(coupling_list());
}

namespace detail {

namespace {

ButcherTablePointer load(ARKODE_ERKTableID id) {
  return own<ButcherTablePointer>(ARKodeButcherTable_LoadERK(id), "ARKodeButcherTable_LoadERK");
}
ButcherTablePointer load(ARKODE_DIRKTableID id) {
  return own<ButcherTablePointer>(ARKodeButcherTable_LoadDIRK(id), "ARKodeButcherTable_LoadDIRK");
}

}  // namespace

ButcherTablePointer make_table(const schemes::ButcherTableau& tableau, int order, int embedded_order) {
  schemes::TableauValues<double> values = schemes::values<double>(tableau);
  return own<ButcherTablePointer>(
      ARKodeButcherTable_Create(values.stages, order, embedded_order, values.c.data(), values.a.data(),
                                values.b.data(),
                                values.b_embedded.empty() ? nullptr : values.b_embedded.data()),
      "ARKodeButcherTable_Create");
}

ArkodeTables explicit_tables(const schemes::ButcherTableau& tableau) {
  if (shape(tableau) != schemes::TableauShape::explicit_stages) {
    throw std::logic_error("tableau \"" + tableau.name + "\" is not explicit");
  }
  ArkodeTables tables{.name = tableau.name,
                      .explicit_part = nullptr,
                      .implicit_part = nullptr,
                      .order = schemes::order_of_accuracy(tableau),
                      .embedded_order = schemes::embedded_order(tableau)};
  tables.explicit_part = make_table(tableau, tables.order, tables.embedded_order);
  return tables;
}

ArkodeTables diagonally_implicit_tables(const schemes::ButcherTableau& tableau) {
  if (shape(tableau) != schemes::TableauShape::diagonal_implicit) {
    throw std::logic_error("tableau \"" + tableau.name + "\" is not diagonally implicit");
  }
  ArkodeTables tables{.name = tableau.name,
                      .explicit_part = nullptr,
                      .implicit_part = nullptr,
                      .order = schemes::order_of_accuracy(tableau),
                      .embedded_order = schemes::embedded_order(tableau)};
  tables.implicit_part = make_table(tableau, tables.order, tables.embedded_order);
  return tables;
}

ArkodeTables additive_tables(const schemes::AdditiveTableau& tableau) {
  ArkodeTables tables{.name = tableau.name,
                      .explicit_part = nullptr,
                      .implicit_part = nullptr,
                      .order = schemes::order_of_accuracy(tableau),
                      .embedded_order = schemes::embedded_order(tableau)};
  tables.explicit_part = make_table(tableau.explicit_part, tables.order, tables.embedded_order);
  tables.implicit_part = make_table(tableau.implicit_part, tables.order, tables.embedded_order);
  return tables;
}

ArkodeTables built_in_explicit_tables(const std::string& name) {
  ArkodeTables tables{.name = name,
                      .explicit_part = load(find(explicit_list(), "explicit table", name)),
                      .implicit_part = nullptr};
  tables.order = tables.explicit_part->q;
  tables.embedded_order = tables.explicit_part->p;
  return tables;
}

ArkodeTables built_in_diagonally_implicit_tables(const std::string& name) {
  ArkodeTables tables{.name = name,
                      .explicit_part = nullptr,
                      .implicit_part = load(find(implicit_list(), "diagonally implicit table", name))};
  tables.order = tables.implicit_part->q;
  tables.embedded_order = tables.implicit_part->p;
  return tables;
}

ArkodeTables built_in_additive_tables(const std::string& name) {
  const auto [explicit_id, implicit_id] = find(additive_list(), "pair of additive tables", name);
  ArkodeTables tables{.name = name, .explicit_part = load(explicit_id), .implicit_part = load(implicit_id)};
  tables.order = tables.implicit_part->q;
  tables.embedded_order = tables.implicit_part->p;
  return tables;
}

CouplingPointer built_in_coupling(const std::string& name) {
  return own<CouplingPointer>(MRIStepCoupling_LoadTable(find(coupling_list(), "coupling", name)),
                              "MRIStepCoupling_LoadTable");
}

}  // namespace detail

}  // namespace fw::oracles
