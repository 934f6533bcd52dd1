#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <ostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "catalog/methods.hpp"
#include "conformance/mutants.hpp"
#include "schemes/scheme_data.hpp"

namespace fw::conformance {

/// A mistake in a scheme, compiled in as a test double beside its right twin.
struct SeededBug {
  std::string name{};
  std::string description{};
  /// The scheme with the mistake, or without it: the twin under the same checks.
  std::function<std::unique_ptr<Integrator>(bool mutated)> make{};
  schemes::SchemeData data{};                       ///< of the right scheme
  std::optional<schemes::SchemeData> wrong_data{};  ///< where the mistake is in the listed coefficients
  std::vector<std::string> caught_by{};             ///< properties that must fail
  std::string
      twin{};  ///< the scheme of the catalogue that is the twin; empty where the twin is written by hand
};

/// For the list of tests.
inline void PrintTo(const SeededBug& bug, std::ostream* out) {
  *out << bug.description;
}

inline std::unique_ptr<Integrator> right_scheme(const std::string& call) {
  return catalog::make_method(call);
}

/// The tableau of that name out of the catalogue.
template <class Tableau>
Tableau tableau_of(const std::string& name) {
  return std::get<Tableau>(catalog::theory_of_call(name).coefficients);
}

/// A mistake in the running code alone: claims and data are those of `name`.
inline SeededBug code_bug(std::string name, std::string description, const std::string& twin,
                          std::function<std::unique_ptr<Integrator>()> mutant,
                          std::vector<std::string> caught_by) {
  return {.name = std::move(name),
          .description = std::move(description),
          .make =
              [twin, mutant = std::move(mutant)](bool mutated) {
                std::unique_ptr<Integrator> right = right_scheme(twin);
                return mutated ? with_claims(right->info(), mutant()) : std::move(right);
              },
          .data = catalog::theory_of_call(twin).coefficients,
          .caught_by = std::move(caught_by),
          .twin = twin};
}

/// A wrong number in the coefficients that the code runs with; the listed ones are right.
template <class Tableau, class Make, class Damage>
SeededBug coefficient_bug(std::string name, std::string description, const std::string& twin, Make make,
                          Damage damage, std::vector<std::string> caught_by) {
  return code_bug(
      std::move(name), std::move(description), twin,
      [twin, make, damage] {
        Tableau tableau = tableau_of<Tableau>(twin);
        damage(tableau);
        return make(tableau);
      },
      std::move(caught_by));
}

/// A wrong number in the catalogue itself: code and listed data agree, the claims are those of the right
/// scheme.
template <class Tableau, class Make, class Damage>
SeededBug data_bug(std::string name, std::string description, const std::string& twin, Make make,
                   Damage damage, std::vector<std::string> caught_by) {
  Tableau wrong = tableau_of<Tableau>(twin);
  damage(wrong);
  SeededBug bug = coefficient_bug<Tableau>(std::move(name), std::move(description), twin, make, damage,
                                           std::move(caught_by));
  bug.wrong_data = std::move(wrong);
  return bug;
}

/// A claim that is not true of a right scheme.
template <class Change>
SeededBug claim_bug(std::string name, std::string description, const std::string& twin, Change change,
                    std::vector<std::string> caught_by) {
  return {.name = std::move(name),
          .description = std::move(description),
          .make =
              [twin, change](bool mutated) {
                std::unique_ptr<Integrator> right = right_scheme(twin);
                if (!mutated) return right;
                MethodInfo claims = right->info();
                change(claims);
                return with_claims(claims, std::move(right));
              },
          .data = catalog::theory_of_call(twin).coefficients,
          .caught_by = std::move(caught_by),
          .twin = twin};
}

/// A hand-written scheme with a switch for its mistake, under the claims of a scheme of the catalogue that
/// does the same.
inline SeededBug hand_written_bug(std::string name, std::string description, const std::string& claims,
                                  std::function<std::unique_ptr<Integrator>(bool mutated)> make,
                                  std::vector<std::string> caught_by) {
  return {.name = std::move(name),
          .description = std::move(description),
          .make = [claims, make = std::move(make)](
                      bool mutated) { return with_claims(right_scheme(claims)->info(), make(mutated)); },
          .data = catalog::theory_of_call(claims).coefficients,
          .caught_by = std::move(caught_by)};
}

}  // namespace fw::conformance
