#include <map>

#include "catalog/declared_options.hpp"
#include "catalog/oracle_methods.hpp"
#include "catalog/oracle_options.hpp"
#include "schemes/explicit_tableaus.hpp"
#include "schemes/implicit_tableaus.hpp"
#include "schemes/splitting_schemes.hpp"

namespace fw::catalog {

namespace {

using namespace oracles;

/// What PETSc's manual says of a type [Abhyankar et al. 2018]; nothing where options in PETSc's notation may
/// choose another one.
template <class Options>
analysis::Theory known_as(const Options& options, schemes::SchemeData data) {
  if (!options.petsc.empty()) return {};
  return analysis::theory_on_linear_systems({std::move(data)});
}

/// The table of a type of ts_rk.
schemes::SchemeData rk_table(const std::string& type) {
  static const std::map<std::string, const char*> names = {{"1fe", "explicit_euler"},
                                                           {"3bs", "bogacki_shampine_32"},
                                                           {"4", "rk4"},
                                                           {"5f", "fehlberg_54"},
                                                           {"5dp", "dormand_prince_54"}};
  const auto name = names.find(type);
  if (name == names.end()) return {};
  return named(schemes::explicit_tableaus(), name->second);
}

analysis::Theory theta_theory(const TsThetaOptions& options) {
  const char* name = options.theta == 1.0   ? "implicit_euler"
                     : options.theta != 0.5 ? ""
                     : options.endpoint     ? "trapezoidal"
                                            : "implicit_midpoint";
  if (*name == '\0') return {};
  return known_as(options, named(schemes::diagonally_implicit_tableaus(), name));
}

analysis::Theory basicsymplectic_theory(const TsBasicSymplecticOptions& options) {
  if (options.order != 2) return {};
  return known_as(options, named(schemes::splitting_schemes(), "velocity_verlet"));
}

/// A family of PETSc's.
template <class Options, class... Theory>
MethodEntry ts(std::unique_ptr<Integrator> (*make)(const Options&), Theory... theory) {
  return declared_method(make({})->info().name, Options{}, make, theory...);
}

}  // namespace

std::vector<MethodEntry> petsc_methods() {
  return {
      ts(make_ts_rk, [](const TsRkOptions& options) { return known_as(options, rk_table(options.type)); }),
      ts(make_ts_theta, theta_theory),
      ts(make_ts_bdf),
      ts(make_ts_arkimex),
      ts(make_ts_rosw),
      ts(make_ts_alpha2),
      ts(make_ts_basicsymplectic, basicsymplectic_theory)};
}

}  // namespace fw::catalog
