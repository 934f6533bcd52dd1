#include "catalog/declared_options.hpp"
#include "catalog/oracle_methods.hpp"
#include "catalog/oracle_options.hpp"
#include "schemes/composed_tableau.hpp"
#include "schemes/explicit_tableaus.hpp"
#include "schemes/implicit_tableaus.hpp"
#include "schemes/prince_dormand_tableau.hpp"

namespace fw::catalog {

namespace {

/// The tables that GSL's manual names [Galassi et al. 2009, ch. 27]. rk2 advances by its formula of order 3;
/// rk4 and the implicit ones estimate errors by step doubling and go on with the two half steps.
schemes::SchemeData table_of(const std::string& stepper) {
  const auto explicit_table = [](const char* name) { return named(schemes::explicit_tableaus(), name); };
  const auto twice = [](const schemes::ButcherTableau& table) { return schemes::repeated(table, 2); };
  if (stepper == "rk2") return explicit_table("kutta3");
  if (stepper == "rk4") return twice(explicit_table("rk4"));
  if (stepper == "rkf45") return explicit_table("fehlberg_54");
  if (stepper == "rkck") return explicit_table("cash_karp_54");
  if (stepper == "rk8pd") return schemes::prince_dormand_87();
  if (stepper == "rk1imp") return twice(named(schemes::diagonally_implicit_tableaus(), "implicit_euler"));
  if (stepper == "rk2imp") return twice(named(schemes::diagonally_implicit_tableaus(), "implicit_midpoint"));
  if (stepper == "rk4imp") return twice(named(schemes::fully_implicit_tableaus(), "gauss2"));
  return {};
}

}  // namespace

std::vector<MethodEntry> gsl_methods() {
  std::vector<MethodEntry> list;
  for (const oracles::GslStepper& stepper : oracles::gsl_steppers()) {
    list.push_back(declared_method(
        "gsl:" + stepper.name, oracles::GslOptions{.tolerance_factor = stepper.tolerance_factor},
        [name = stepper.name](const oracles::GslOptions& options) {
          return oracles::make_gsl_stepper(name, options);
        },
        [name = stepper.name](const oracles::GslOptions&) {
          return analysis::theory_on_linear_systems({table_of(name)});
        }));
  }
  return list;
}

}  // namespace fw::catalog
