#include "catalog/method_options.hpp"
#include "catalog/oracle_methods.hpp"
#include "oracles/sundials/cvode.hpp"

namespace fw::catalog {

namespace {

MethodEntry cvode_bdf() {
  const oracles::CvodeOptions defaults;
  return {oracles::make_cvode_bdf()->info().name,
          {{"tolerance_factor", fmt::format("{}", defaults.tolerance_factor),
            "CVODE's own tolerances as a fraction of those given"}},
          {},
          [defaults](const MethodOptions& options) {
            return oracles::make_cvode_bdf({.tolerance_factor = positive_number(options, "tolerance_factor",
                                                                                defaults.tolerance_factor)});
          }};
}

}  // namespace

std::vector<MethodEntry> sundials_methods() {
  return {cvode_bdf()};
}

}  // namespace fw::catalog
