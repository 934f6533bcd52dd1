#include "catalog/declared_options.hpp"
#include "catalog/oracle_methods.hpp"
#include "catalog/oracle_options.hpp"
#include "core/error.hpp"
#include "schemes/additive_tableaus.hpp"
#include "schemes/explicit_tableaus.hpp"
#include "schemes/implicit_tableaus.hpp"

namespace fw::catalog {

namespace {

using oracles::ArkodeOptions;

constexpr const char* dormand_prince_table = "dormand_prince_7_4_5";

/// A method of ARKODE with one of its tables or one tableau of a family of ours.
template <class Tableau>
MethodEntry arkode(const std::string& name, ArkodeCall defaults, const std::vector<Tableau>& (*family)(),
                   std::unique_ptr<Integrator> (*make_of_table)(const std::string&, const ArkodeOptions&),
                   std::unique_ptr<Integrator> (*make_of_tableau)(const Tableau&, const ArkodeOptions&)) {
  for (const Tableau& tableau : family()) defaults.tableaus.push_back(tableau.name);
  const auto theory = [=](const MethodOptions& given) {
    const ArkodeCall call = read_options(given, defaults);
    if (!call.tableau.empty()) return analysis::theory_on_linear_systems({named(family(), call.tableau)});
    // ARKODE's default table of explicit methods; the names of others are its own [Reynolds et al. 2023].
    if (!given.contains("table") && defaults.table == dormand_prince_table) {
      return analysis::theory_on_linear_systems({named(schemes::explicit_tableaus(), "dormand_prince_54")});
    }
    return analysis::Theory{};
  };
  return {name, declared_options(defaults), theory, [=](const MethodOptions& given) {
            if (given.contains("table") && given.contains("tableau")) {
              throw InputError("options table and tableau: found both, expected one of them");
            }
            const ArkodeCall call = read_options(given, defaults);
            return call.tableau.empty() ? make_of_table(call.table, call.options)
                                        : make_of_tableau(named(family(), call.tableau), call.options);
          }};
}

MethodEntry arkode_erk() {
  return arkode<schemes::ButcherTableau>(
      "sundials:arkode_erk", {.tables = oracles::arkode_explicit_tables(), .table = dormand_prince_table},
      schemes::explicit_tableaus, oracles::make_arkode_erk, oracles::make_arkode_erk);
}

MethodEntry arkode_dirk() {
  return arkode<schemes::ButcherTableau>("sundials:arkode_dirk",
                                         {.tables = oracles::arkode_diagonally_implicit_tables(),
                                          .is_implicit = true,
                                          .table = "ark548l2sa_dirk_8_4_5",
                                          .options = oracles::implicit_arkode_options},
                                         schemes::diagonally_implicit_tableaus, oracles::make_arkode_dirk,
                                         oracles::make_arkode_dirk);
}

MethodEntry arkode_imex() {
  return arkode<schemes::AdditiveTableau>("sundials:arkode_imex",
                                          {.tables = oracles::arkode_additive_tables(),
                                           .is_implicit = true,
                                           .table = "ark548l2sa_8_4_5",
                                           .options = oracles::implicit_arkode_options},
                                          schemes::additive_tableaus, oracles::make_arkode_imex,
                                          oracles::make_arkode_imex);
}

}  // namespace

std::vector<MethodEntry> arkode_methods() {
  return {arkode_erk(), arkode_dirk(), arkode_imex(),
          declared_method("sundials:arkode_mri", oracles::MriOptions{}, oracles::make_arkode_mri),
          declared_method("sundials:ida", oracles::IdaOptions{}, oracles::make_ida)};
}

}  // namespace fw::catalog
