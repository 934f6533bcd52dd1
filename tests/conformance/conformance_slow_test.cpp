#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <set>

#include "analysis/verification/verification.hpp"
#include "catalog/methods.hpp"
#include "paths.hpp"

namespace fw::catalog {
namespace {

/// Names of the schemes of our own: oracles carry the name of their library before a colon.
std::vector<std::string> own_schemes() {
  std::vector<std::string> names;
  for (const MethodEntry& entry : methods()) {
    if (entry.info().has_fixed_step && entry.name.find(':') == std::string::npos) names.push_back(entry.name);
  }
  return names;
}

class Scheme : public testing::TestWithParam<std::string> {};

TEST_P(Scheme, IsWhatItSaysItIs) {
  static const std::unique_ptr<Integrator> oracle = make_method("sundials:cvode_bdf");
  const std::unique_ptr<Integrator> integrator = make_method(GetParam());
  const std::vector<analysis::PropertyCheck> checks =
      analysis::verify({*integrator, theory_of_call(GetParam()).coefficients, oracle.get()});
  int decided = 0;
  for (const analysis::PropertyCheck& check : checks) {
    if (check.verdict != Verdict::not_applicable) ++decided;
    if (check.verdict != Verdict::fails) continue;
    ADD_FAILURE() << fmt::format("{}: claimed {}, derived {}, measured {}; {}", check.property, check.claimed,
                                 check.derived, check.measured, check.reason);
  }
  EXPECT_GE(decided, 4) << "hardly anything was checked";
}

INSTANTIATE_TEST_SUITE_P(Catalogue, Scheme, testing::ValuesIn(own_schemes()),
                         [](const testing::TestParamInfo<std::string>& scheme) {
                           std::string name = scheme.param;
                           std::replace_if(
                               name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; },
                               '_');
                           return name;
                         });

/// The names in the tables of docs/methods.md, which scripts/update_methods_page.py writes.
std::set<std::string> schemes_on_the_page() {
  std::ifstream page(fw::test::source_directory() + "/docs/methods.md");
  std::set<std::string> names;
  bool inside = false;
  for (std::string line; std::getline(page, line);) {
    if (line.rfind("<!-- catalogue:", 0) == 0) inside = line.find("begin") != std::string::npos;
    if (!inside || line.rfind("| `", 0) != 0) continue;
    const std::string name = line.substr(3, line.find('`', 3) - 3);
    if (name.find(':') == std::string::npos && find_method(name).info().has_fixed_step) names.insert(name);
  }
  return names;
}

TEST(Catalogue, HasASchemeForEveryOneOnItsPage) {
  const std::vector<std::string> schemes = own_schemes();
  EXPECT_EQ(schemes_on_the_page(), std::set<std::string>(schemes.begin(), schemes.end()));
}

}  // namespace
}  // namespace fw::catalog
