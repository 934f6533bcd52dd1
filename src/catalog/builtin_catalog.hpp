#pragma once

#include "catalog/equilibrium.hpp"
#include "catalog/methods.hpp"
#include "catalog/problems.hpp"
#include "study/catalog.hpp"

namespace fw::catalog {

/// The lists of methods and problems, as a study sees them.
class BuiltinCatalog final : public study::Catalog {
 public:
  std::unique_ptr<Integrator> method(const std::string& call) const override { return make_method(call); }
  analysis::Theory theory(const std::string& call) const override { return theory_of_call(call); }
  std::vector<std::string> method_names() const override {
    std::vector<std::string> names;
    for (const MethodEntry& entry : methods()) names.push_back(entry.name);
    return names;
  }
  Problem problem(const std::string& name, const ProblemParameters& parameters) const override {
    return find_problem(name).make(parameters);
  }
  Vector equilibrium(const SecondOrderSystem& system, ConstVectorRef position) const override {
    return require_equilibrium(system, position);
  }
};

}  // namespace fw::catalog
