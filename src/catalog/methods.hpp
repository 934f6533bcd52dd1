#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "catalog/method_call.hpp"
#include "ode/integrator.hpp"
#include "schemes/scheme_data.hpp"

namespace fw::catalog {

/// One line of the list of methods.
struct MethodEntry {
  MethodInfo info;
  std::vector<OptionInfo> options;
  schemes::SchemeData data;  ///< the coefficients that define it, if it is defined so
  /// Makes the integrator. Throws InputError for a bad option value; unknown options are checked before.
  std::function<std::unique_ptr<Integrator>(const MethodOptions&)> make;
};

/// Every method, hand-written ones first, then the oracles. The only place where one is registered.
const std::vector<MethodEntry>& methods();

/// The entry of that name; throws InputError with the nearest name.
const MethodEntry& find_method(const std::string& name);

/// The integrator of a call such as "rk4" or "implicit_euler_linearised[linear_solver=cholesky]".
std::unique_ptr<Integrator> make_method(const std::string& call);

}  // namespace fw::catalog
