#include "catalog/method_options.hpp"
#include "catalog/oracle_methods.hpp"
#include "oracles/gsl/odeiv2.hpp"

namespace fw::catalog {

std::vector<MethodEntry> gsl_methods() {
  std::vector<MethodEntry> list;
  for (const oracles::GslStepper& stepper : oracles::gsl_steppers()) {
    list.push_back({"gsl:" + stepper.name,
                    {{"tolerance_factor", fmt::format("{}", stepper.tolerance_factor),
                      "GSL's own tolerances as a fraction of those given"}},
                    {},
                    [stepper](const MethodOptions& options) {
                      return oracles::make_gsl_stepper(
                          stepper.name, {.tolerance_factor = positive_number(options, "tolerance_factor",
                                                                             stepper.tolerance_factor)});
                    }});
  }
  return list;
}

}  // namespace fw::catalog
