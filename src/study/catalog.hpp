#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "analysis/theory/oscillator_amplification.hpp"
#include "analysis/theory/scheme_growth.hpp"
#include "ode/integrator.hpp"
#include "problems/problem_entry.hpp"
#include "schemes/scheme_data.hpp"

namespace fw::study {

/// Finds methods and problems by name. Implemented by catalog/, which knows every one of them; a study knows
/// only this.
class Catalog {
 public:
  virtual ~Catalog() = default;

  /// The integrator of a call such as "rk4" or "implicit_euler_linearised[linear_solver=cholesky]". Throws
  /// InputError for an unknown name (with the nearest one) or option.
  virtual std::unique_ptr<Integrator> method(const std::string& call) const = 0;

  /// The coefficients that define the scheme of a call; std::monostate where it is not given by any, or where
  /// an option changes what the scheme is.
  virtual schemes::SchemeData scheme_data(const std::string& call) const = 0;

  /// The names of all methods, in the order of the list.
  virtual std::vector<std::string> method_names() const = 0;

  /// The coefficients of the method of a call, or of the scheme that it is on forces f(q) (`verlet` is
  /// velocity Verlet); std::monostate where it is not given by coefficients.
  virtual schemes::SchemeData equivalent_scheme(const std::string& call) const = 0;

  /// What the method of a call is on linear systems, damped or not, by coefficients or a rule from the
  /// literature; neither where nothing but its own steps would tell.
  virtual analysis::LinearScheme linear_scheme(const std::string& call) const { return {scheme_data(call)}; }

  /// What theory says of the method of a call on linear oscillators; empty where it says nothing.
  virtual analysis::AmplificationFactors oscillator_theory(const std::string& call) const = 0;

  /// The problem of that name. Throws InputError for an unknown name, parameter or value.
  virtual Problem problem(const std::string& name, const ProblemParameters& parameters) const = 0;
};

}  // namespace fw::study
