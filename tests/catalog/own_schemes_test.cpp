#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "catalog/methods.hpp"
#include "integrators/network.hpp"

namespace fw::catalog {
namespace {

/// The tests of tests/integrators that go through "all schemes" leave out these of the catalogue, which need more than
/// constant steps and any force, or have tests of their own: a scheme that is new joins one of the two lists.
TEST(AllSchemes, OfTheTestsOfIntegratorsAreThoseOfTheCatalogueButThese) {
  std::set<std::string> listed;
  for (const auto& scheme : integrators::all_schemes()) listed.insert(scheme->info().name);
  std::set<std::string> others;
  for (const MethodEntry& entry : methods()) {
    const bool is_own = entry.name.find(':') == std::string::npos;
    if (is_own && entry.info().has_fixed_step && listed.erase(entry.name) == 0) others.insert(entry.name);
  }
  EXPECT_THAT(listed, testing::IsEmpty()) << "not in the catalogue";
  EXPECT_THAT(
      others,
      testing::ElementsAre(
          "adams_bashforth2", "adams_bashforth3", "adams_bashforth4", "adams_bashforth5", "adams_moulton2",
          "adams_moulton3", "adams_moulton4", "adams_moulton5", "ark324", "ark436", "ark548",
          "average_vector_field", "bdf2", "bdf3", "bdf4", "bdf5", "bdf6", "discrete_gradient",
          "dormand_prince_rkn_64", "dormand_prince_rkn_86", "exponential_rosenbrock_euler", "gautschi",
          "generalised_alpha", "hht_alpha", "imex_euler", "lobatto_iiia_iiib3", "newmark", "nystrom4",
          "nystrom5", "projective_dynamics", "r_respa", "rkc1", "rkc2", "velocity_verlet_predicted", "xpbd"));
}

}  // namespace
}  // namespace fw::catalog
