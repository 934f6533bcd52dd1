#pragma once

#include "catalog/methods.hpp"
#include "catalog/oscillator_theory.hpp"
#include "catalog/problems.hpp"
#include "study/catalog.hpp"

namespace fw::catalog {

/// The lists of methods and problems, as a study sees them.
class BuiltinCatalog final : public study::Catalog {
 public:
  std::unique_ptr<Integrator> method(const std::string& call) const override { return make_method(call); }
  schemes::SchemeData scheme_data(const std::string& call) const override { return scheme_of(call); }
  std::vector<std::string> method_names() const override {
    std::vector<std::string> names;
    for (const MethodEntry& entry : methods()) names.push_back(entry.name);
    return names;
  }
  schemes::SchemeData equivalent_scheme(const std::string& call) const override {
    return catalog::equivalent_scheme(call);
  }
  analysis::LinearScheme linear_scheme(const std::string& call) const override {
    return catalog::linear_scheme(call);
  }
  analysis::AmplificationFactors oscillator_theory(const std::string& call) const override {
    return catalog::oscillator_theory(call);
  }
  Problem problem(const std::string& name, const ProblemParameters& parameters) const override {
    return find_problem(name).make(parameters);
  }
};

}  // namespace fw::catalog
