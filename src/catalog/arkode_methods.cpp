#include <fmt/ranges.h>

#include "catalog/method_options.hpp"
#include "catalog/oracle_methods.hpp"
#include "oracles/sundials/arkode.hpp"
#include "oracles/sundials/arkode_mri.hpp"
#include "oracles/sundials/ida.hpp"
#include "schemes/additive_tableaus.hpp"
#include "schemes/explicit_tableaus.hpp"
#include "schemes/implicit_tableaus.hpp"
#include "text/closest_name.hpp"

namespace fw::catalog {

namespace {

using oracles::ArkodeOptions;

std::vector<OptionInfo> arkode_options(const std::string& table, const std::string& tableaus,
                                       const ArkodeOptions& defaults, bool is_implicit) {
  std::vector<OptionInfo> list = {
      {"table", table, "one of ARKODE's own tables, see docs/oracles.md"},
      {"tableau", "", fmt::format("one of our {} tableaus, in place of the table", tableaus)},
      {"tolerance_factor", fmt::format("{}", defaults.tolerance_factor),
       "ARKODE's own tolerances as a fraction of those given"}};
  if (is_implicit) {
    list.push_back({"newton_coefficient", fmt::format("{}", defaults.newton_coefficient),
                    "with chosen steps: what Newton's iteration may leave, as a fraction of the tolerances"});
    list.push_back({"newton_tolerance", fmt::format("{}", defaults.newton_tolerance),
                    "with constant steps: what it may leave, relative to the state"});
  }
  return list;
}

ArkodeOptions read_options(const MethodOptions& options, ArkodeOptions chosen) {
  chosen.tolerance_factor = positive_number(options, "tolerance_factor", chosen.tolerance_factor);
  chosen.newton_coefficient = positive_number(options, "newton_coefficient", chosen.newton_coefficient);
  chosen.newton_tolerance = positive_number(options, "newton_tolerance", chosen.newton_tolerance);
  return chosen;
}

/// The tableau of that name out of a family of ours.
template <class Tableau>
const Tableau& find_tableau(const std::vector<Tableau>& family, const std::string& name) {
  std::vector<std::string> names;
  for (const Tableau& tableau : family) {
    if (tableau.name == name) return tableau;
    names.push_back(tableau.name);
  }
  throw InputError(fmt::format("option tableau: found \"{}\", expected one of {}{}", name,
                               fmt::join(names, ", "), did_you_mean(name, names)));
}

constexpr const char* dormand_prince_table = "dormand_prince_7_4_5";

/// A method of ARKODE with one of its tables or one tableau of a family of ours.
template <class Tableau>
MethodEntry arkode(const std::string& name, const std::string& default_table,
                   const std::vector<Tableau>& (*family)(), std::vector<OptionInfo> options,
                   const ArkodeOptions& defaults,
                   std::unique_ptr<Integrator> (*make_of_table)(const std::string&, const ArkodeOptions&),
                   std::unique_ptr<Integrator> (*make_of_tableau)(const Tableau&, const ArkodeOptions&)) {
  const auto theory = [=](const MethodOptions& given) {
    const std::string table = text(given, "table"), tableau = text(given, "tableau");
    if (!tableau.empty()) return analysis::theory_on_linear_systems({find_tableau(family(), tableau)});
    // ARKODE's default table of explicit methods; the names of others are its own [Reynolds et al. 2023].
    if (table.empty() && default_table == dormand_prince_table) {
      return analysis::theory_on_linear_systems({find_tableau(family(), "dormand_prince_54")});
    }
    return analysis::Theory{};
  };
  return {name, std::move(options), theory, [=](const MethodOptions& given) {
            const std::string table = text(given, "table"), tableau = text(given, "tableau");
            if (!table.empty() && !tableau.empty()) {
              throw InputError("options table and tableau: found both, expected one of them");
            }
            const ArkodeOptions chosen = read_options(given, defaults);
            if (!tableau.empty()) return make_of_tableau(find_tableau(family(), tableau), chosen);
            return make_of_table(table.empty() ? default_table : table, chosen);
          }};
}

MethodEntry arkode_erk() {
  const ArkodeOptions defaults;
  const std::string table = dormand_prince_table;
  return arkode<schemes::ButcherTableau>("sundials:arkode_erk", table, schemes::explicit_tableaus,
                                         arkode_options(table, "explicit", defaults, false), defaults,
                                         oracles::make_arkode_erk, oracles::make_arkode_erk);
}

MethodEntry arkode_dirk() {
  const ArkodeOptions defaults = oracles::implicit_arkode_options;
  const std::string table = "ark548l2sa_dirk_8_4_5";
  return arkode<schemes::ButcherTableau>("sundials:arkode_dirk", table, schemes::diagonally_implicit_tableaus,
                                         arkode_options(table, "diagonally implicit", defaults, true),
                                         defaults, oracles::make_arkode_dirk, oracles::make_arkode_dirk);
}

MethodEntry arkode_imex() {
  const ArkodeOptions defaults = oracles::implicit_arkode_options;
  const std::string table = "ark548l2sa_8_4_5";
  return arkode<schemes::AdditiveTableau>("sundials:arkode_imex", table, schemes::additive_tableaus,
                                          arkode_options(table, "additive", defaults, true), defaults,
                                          oracles::make_arkode_imex, oracles::make_arkode_imex);
}

MethodEntry arkode_mri() {
  const oracles::MriOptions defaults;
  return {"sundials:arkode_mri",
          {{"coupling", defaults.coupling, fmt::format("{}", fmt::join(oracles::arkode_couplings(), ", "))},
           {"inner", "explicit", "explicit or implicit: how stiff forces are integrated"},
           {"inner_table", "", "one of ARKODE's own tables for them"},
           {"inner_steps", fmt::format("{}", defaults.inner_steps),
            "constant inner steps per step; 0: chosen by inner_tolerance"},
           {"inner_tolerance", fmt::format("{}", defaults.inner_tolerance), "relative to the state"}},
          {},
          [defaults](const MethodOptions& options) {
            oracles::MriOptions chosen = defaults;
            if (const std::string coupling = text(options, "coupling"); !coupling.empty()) {
              chosen.coupling = coupling;
            }
            chosen.inner_is_implicit =
                choose<bool>(options, "inner", false, {{"explicit", false}, {"implicit", true}});
            chosen.inner_table = text(options, "inner_table");
            chosen.inner_steps = count(options, "inner_steps", defaults.inner_steps);
            chosen.inner_tolerance = positive_number(options, "inner_tolerance", defaults.inner_tolerance);
            return oracles::make_arkode_mri(chosen);
          }};
}

MethodEntry ida() {
  const oracles::IdaOptions defaults;
  return {"sundials:ida",
          {{"tolerance_factor", fmt::format("{}", defaults.tolerance_factor),
            "IDA's own tolerances as a fraction of those given"}},
          {},
          [defaults](const MethodOptions& options) {
            return oracles::make_ida({.tolerance_factor = positive_number(options, "tolerance_factor",
                                                                          defaults.tolerance_factor)});
          }};
}

}  // namespace

std::vector<MethodEntry> arkode_methods() {
  return {arkode_erk(), arkode_dirk(), arkode_imex(), arkode_mri(), ida()};
}

}  // namespace fw::catalog
