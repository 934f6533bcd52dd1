#include "catalog/method_options.hpp"
#include "catalog/oracle_methods.hpp"
#include "oracles/sundials/cvode.hpp"

namespace fw::catalog {

namespace {

using oracles::CvodeFormula;
using oracles::CvodeIteration;
using oracles::CvodeLinearSolver;
using oracles::VectorOperations;

oracles::CvodeOptions cvode_options(CvodeFormula formula, const MethodOptions& options) {
  oracles::CvodeOptions chosen;
  chosen.tolerance_factor = positive_number(options, "tolerance_factor", chosen.tolerance_factor);
  if (options.contains("nonlinear_solver")) {
    chosen.iteration =
        choose(options, "nonlinear_solver", CvodeIteration::newton,
               {{"newton", CvodeIteration::newton}, {"fixed_point", CvodeIteration::fixed_point}});
  }
  chosen.linear_solver = choose(options, "linear_solver", chosen.linear_solver,
                                {{"klu", CvodeLinearSolver::klu}, {"spgmr", CvodeLinearSolver::spgmr}});
  const auto whole = [&options](const std::string& name, int least, int most, int fallback) {
    const auto option = options.find(name);
    return option == options.end() ? fallback : whole_number(name, option->second, least, most);
  };
  chosen.krylov_dimension = whole("krylov_dimension", 1, 10'000, chosen.krylov_dimension);
  chosen.maximum_order = whole("max_order", 1, formula == CvodeFormula::bdf ? 5 : 12, chosen.maximum_order);
  chosen.vector = choose(options, "vector", chosen.vector,
                         {{"eigen", VectorOperations::eigen}, {"serial", VectorOperations::serial}});
  if (formula == CvodeFormula::bdf) {
    chosen.stability_limit_detection =
        choose(options, "stability_limit_detection", false, {{"on", true}, {"off", false}});
  }
  return chosen;
}

MethodEntry cvode(CvodeFormula formula) {
  const bool is_bdf = formula == CvodeFormula::bdf;
  const auto make = is_bdf ? oracles::make_cvode_bdf : oracles::make_cvode_adams;
  const oracles::CvodeOptions defaults;
  std::vector<OptionInfo> list = {
      {"tolerance_factor", fmt::format("{}", defaults.tolerance_factor),
       "CVODE's own tolerances as a fraction of those given"},
      {"nonlinear_solver", is_bdf ? "newton" : "fixed_point", "newton or fixed_point"},
      {"linear_solver", "klu", "of Newton's iteration: klu, or spgmr (GMRES with particle blocks)"},
      {"krylov_dimension", fmt::format("{}", defaults.krylov_dimension), "of spgmr, >= 1"},
      {"max_order", is_bdf ? "5" : "12", is_bdf ? "1 to 5" : "1 to 12"},
      {"vector", "eigen", "vector operations: eigen (ours) or serial (SUNDIALS')"}};
  if (is_bdf) {
    list.push_back({"stability_limit_detection", "off", "on or off"});
  }
  return {make({})->info().name, list, {}, [formula, make](const MethodOptions& options) {
            return make(cvode_options(formula, options));
          }};
}

}  // namespace

std::vector<MethodEntry> sundials_methods() {
  return {cvode(CvodeFormula::bdf), cvode(CvodeFormula::adams)};
}

}  // namespace fw::catalog
