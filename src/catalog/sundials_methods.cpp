#include "catalog/declared_options.hpp"
#include "catalog/oracle_methods.hpp"
#include "catalog/oracle_options.hpp"

namespace fw::catalog {

namespace {

using oracles::CvodeFormula;
using oracles::CvodeIteration;

MethodEntry cvode(CvodeFormula formula) {
  const bool is_bdf = formula == CvodeFormula::bdf;
  const auto make = is_bdf ? oracles::make_cvode_bdf : oracles::make_cvode_adams;
  CvodeCall defaults{.formula = formula};
  defaults.options.iteration = is_bdf ? CvodeIteration::newton : CvodeIteration::fixed_point;
  defaults.options.maximum_order = is_bdf ? 5 : 12;
  return declared_method(make({})->info().name, defaults,
                         [make](const CvodeCall& call) { return make(call.options); });
}

}  // namespace

std::vector<MethodEntry> sundials_methods() {
  return {cvode(CvodeFormula::bdf), cvode(CvodeFormula::adams)};
}

}  // namespace fw::catalog
