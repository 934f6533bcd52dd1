#include "catalog/oscillator_theory.hpp"

#include <map>

#include "catalog/method_options.hpp"
#include "catalog/methods.hpp"
#include "integrators/generalised_alpha.hpp"
#include "schemes/chebyshev_recurrence.hpp"

namespace fw::catalog {

namespace {

using analysis::amplification_factors;
using analysis::AmplificationFactors;

/// The scheme with coefficients that does the same on linear systems with forces f(q).
const std::map<std::string, std::string>& linear_twins() {
  static const std::map<std::string, std::string> twins = {
      {"implicit_euler_linearised", "implicit_euler"},  // Newton's first iteration is exact
      {"average_vector_field",
       "implicit_midpoint"},  // the averaged force of a linear one is that of the midpoint
      {"discrete_gradient", "implicit_midpoint"},
  };
  return twins;
}

AmplificationFactors of_parameters(const MethodCall& call) {
  const MethodOptions& options = call.options;
  if (call.name == "newmark") {
    return amplification_factors(integrators::AlphaParameters{.beta = number(options, "beta", 0.25),
                                                              .gamma = number(options, "gamma", 0.5)});
  }
  if (call.name == "hht_alpha") {
    const double alpha = number(options, "alpha", -0.1);
    return amplification_factors(integrators::AlphaParameters{
        .alpha_f = -alpha, .beta = 0.25 * (1.0 - alpha) * (1.0 - alpha), .gamma = 0.5 - alpha});
  }
  if (call.name == "generalised_alpha") {
    return amplification_factors(integrators::chung_hulbert_parameters(number(options, "rho_infinity", 0.8)));
  }
  return {};
}

}  // namespace

schemes::SchemeData equivalent_scheme(const std::string& text) {
  const MethodCall call = parse_method_call(text);
  if (call.name == "verlet" || call.name == "verlet_backward_velocity")
    return find_method("velocity_verlet").data;
  if (const auto stages = call.options.find("stages"); stages != call.options.end()) {
    if (stages->second == "auto") return {};
    return schemes::chebyshev_tableau(call.name == "rkc1" ? 1 : 2, std::stoi(stages->second));
  }
  return find_method(call.name).data;
}

AmplificationFactors oscillator_theory(const std::string& text) {
  const MethodCall call = parse_method_call(text);
  if (const auto twin = linear_twins().find(call.name); twin != linear_twins().end()) {
    return amplification_factors(find_method(twin->second).data);
  }
  if (call.name == "gautschi" || call.name == "exponential_rosenbrock_euler") {
    return analysis::exact_amplification_factors();
  }
  if (AmplificationFactors factors = of_parameters(call)) return factors;
  return amplification_factors(equivalent_scheme(text));
}

}  // namespace fw::catalog
