#include <map>

#include "catalog/method_options.hpp"
#include "catalog/oracle_methods.hpp"
#include "oracles/petsc/time_steppers.hpp"
#include "schemes/explicit_tableaus.hpp"
#include "schemes/implicit_tableaus.hpp"
#include "schemes/splitting_schemes.hpp"

namespace fw::catalog {

namespace {

using namespace oracles;

const OptionInfo petsc_option{"petsc", "", "further options in PETSc's notation, without commas"};

OptionInfo type_option(const std::string& default_type, const std::vector<TsType>& types) {
  std::vector<std::string> names;
  for (const TsType& type : types) names.push_back(type.name);
  return {"type", default_type, fmt::format("{}", fmt::join(names, ", "))};
}

std::string type_of(const MethodOptions& options, const std::string& fallback) {
  const std::string given = text(options, "type");
  return given.empty() ? fallback : given;
}

bool yes_or_no(const MethodOptions& options, const std::string& name) {
  return choose<bool>(options, name, false, {{"yes", true}, {"no", false}});
}

/// What PETSc's manual says of a type [Abhyankar et al. 2018]; nothing where options in PETSc's notation may
/// choose another one.
analysis::Theory known_as(const MethodOptions& options, schemes::SchemeData data) {
  if (!text(options, "petsc").empty()) return {};
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

MethodEntry ts_rk() {
  const TsRkOptions defaults;
  return {make_ts_rk()->info().name,
          {type_option(defaults.type, ts_rk_types()), petsc_option},
          [defaults](const MethodOptions& options) {
            return known_as(options, rk_table(type_of(options, defaults.type)));
          },
          [defaults](const MethodOptions& options) {
            return make_ts_rk({.type = type_of(options, defaults.type), .petsc = text(options, "petsc")});
          }};
}

MethodEntry ts_theta() {
  const TsThetaOptions defaults;
  return {make_ts_theta()->info().name,
          {{"theta", "0.5", "0 < theta <= 1; 1: implicit Euler"},
           {"endpoint", "no", "yes or no; yes: the trapezoidal family"},
           petsc_option},
          [defaults](const MethodOptions& options) {
            const double theta = number(options, "theta", defaults.theta);
            const bool endpoint = yes_or_no(options, "endpoint");
            const char* name = theta == 1.0   ? "implicit_euler"
                               : theta != 0.5 ? ""
                               : endpoint     ? "trapezoidal"
                                              : "implicit_midpoint";
            if (*name == '\0') return analysis::Theory{};
            return known_as(options, named(schemes::diagonally_implicit_tableaus(), name));
          },
          [defaults](const MethodOptions& options) {
            return make_ts_theta({.theta = number(options, "theta", defaults.theta),
                                  .endpoint = yes_or_no(options, "endpoint"),
                                  .petsc = text(options, "petsc")});
          }};
}

MethodEntry ts_bdf() {
  const TsBdfOptions defaults;
  return {make_ts_bdf()->info().name,
          {{"order", fmt::format("{}", defaults.order), "1 to 6"},
           {"tolerance_factor", fmt::format("{}", defaults.tolerance_factor),
            "PETSc's own tolerances as a fraction of those given"},
           petsc_option},
          {},
          [defaults](const MethodOptions& options) {
            return make_ts_bdf(
                {.order = count(options, "order", defaults.order),
                 .tolerance_factor = positive_number(options, "tolerance_factor", defaults.tolerance_factor),
                 .petsc = text(options, "petsc")});
          }};
}

MethodEntry ts_arkimex() {
  const TsArkimexOptions defaults;
  return {make_ts_arkimex()->info().name,
          {type_option(defaults.type, ts_arkimex_types()),
           {"splitting", "no", "yes or no; yes: stiff springs implicit, the rest explicit"},
           petsc_option},
          {},
          [defaults](const MethodOptions& options) {
            return make_ts_arkimex({.type = type_of(options, defaults.type),
                                    .splitting = yes_or_no(options, "splitting"),
                                    .petsc = text(options, "petsc")});
          }};
}

MethodEntry ts_rosw() {
  const TsRoswOptions defaults;
  return {make_ts_rosw()->info().name,
          {type_option(defaults.type, ts_rosw_types()), petsc_option},
          {},
          [defaults](const MethodOptions& options) {
            return make_ts_rosw({.type = type_of(options, defaults.type), .petsc = text(options, "petsc")});
          }};
}

MethodEntry ts_alpha2() {
  const TsAlpha2Options defaults;
  return {make_ts_alpha2()->info().name,
          {{"rho_infinity", "1", "spectral radius at infinite frequency, 0 to 1"}, petsc_option},
          {},
          [defaults](const MethodOptions& options) {
            return make_ts_alpha2({.rho_infinity = number(options, "rho_infinity", defaults.rho_infinity),
                                   .petsc = text(options, "petsc")});
          }};
}

MethodEntry ts_basicsymplectic() {
  const TsBasicSymplecticOptions defaults;
  return {make_ts_basicsymplectic()->info().name,
          {{"order", fmt::format("{}", defaults.order), "1 to 4"}, petsc_option},
          [defaults](const MethodOptions& options) {
            if (count(options, "order", defaults.order) != 2) return analysis::Theory{};
            return known_as(options, named(schemes::splitting_schemes(), "velocity_verlet"));
          },
          [defaults](const MethodOptions& options) {
            return make_ts_basicsymplectic(
                {.order = count(options, "order", defaults.order), .petsc = text(options, "petsc")});
          }};
}

}  // namespace

std::vector<MethodEntry> petsc_methods() {
  return {ts_rk(), ts_theta(), ts_bdf(), ts_arkimex(), ts_rosw(), ts_alpha2(), ts_basicsymplectic()};
}

}  // namespace fw::catalog
