#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "analysis/theory/method_theory.hpp"
#include "ode/integrator.hpp"
#include "ode/second_order_system.hpp"
#include "problems/problem_entry.hpp"

namespace fw::study {

/// Finds methods and problems by name. Implemented by catalog/, which knows every one of them; a study knows
/// only this.
class Catalog {
 public:
  virtual ~Catalog() = default;

  /// The integrator of a call such as "rk4" or "implicit_euler_linearised[linear_solver=cholesky]". Throws
  /// InputError for an unknown name (with the nearest one) or option.
  virtual std::unique_ptr<Integrator> method(const std::string& call) const = 0;

  /// What theory says of the method of a call with its options: coefficients, what it is on linear systems,
  /// its modified energy. Throws as `method` does.
  virtual analysis::Theory theory(const std::string& call) const = 0;

  /// The names of all methods, in the order of the list.
  virtual std::vector<std::string> method_names() const = 0;

  /// The problem of that name. Throws InputError for an unknown name, parameter or value.
  virtual Problem problem(const std::string& name, const ProblemParameters& parameters) const = 0;

  /// The positions of a static equilibrium of `system`, looked for from `position`. Throws InputError with the
  /// reason where none is found.
  virtual Vector equilibrium(const SecondOrderSystem& system, ConstVectorRef position) const;
};

}  // namespace fw::study
