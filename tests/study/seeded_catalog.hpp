#pragma once

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "catalog/builtin_catalog.hpp"

namespace fw::study {

using Seeds = std::map<std::string, std::function<std::unique_ptr<Integrator>()>>;

/// The built-in catalogue and schemes with seeded bugs.
class SeededCatalog final : public Catalog {
 public:
  /// `theory` names for a seeded scheme the method whose theory it claims.
  explicit SeededCatalog(Seeds seeds, std::map<std::string, std::string> theory = {})
      : seeds_(std::move(seeds)), theory_(std::move(theory)) {}
  std::unique_ptr<Integrator> method(const std::string& call) const override {
    const auto seed = seeds_.find(call);
    return seed != seeds_.end() ? seed->second() : builtin_.method(call);
  }
  /// Of a seed: what it claims by `theory`; with the name of a method of the catalogue, that method's; else
  /// nothing.
  analysis::Theory theory(const std::string& call) const override {
    const auto claimed = theory_.find(call);
    if (claimed != theory_.end()) return builtin_.theory(claimed->second);
    const std::vector<std::string> known = builtin_.method_names();
    const bool is_new = seeds_.contains(call) && std::find(known.begin(), known.end(), call) == known.end();
    return is_new ? analysis::Theory{} : builtin_.theory(call);
  }
  std::vector<std::string> method_names() const override {
    std::vector<std::string> names = builtin_.method_names();
    for (const auto& [name, make] : seeds_) names.push_back(name);
    return names;
  }
  Problem problem(const std::string& name, const ProblemParameters& parameters) const override {
    return builtin_.problem(name, parameters);
  }

 private:
  catalog::BuiltinCatalog builtin_;
  Seeds seeds_;
  std::map<std::string, std::string> theory_;
};

}  // namespace fw::study
