#include "catalog/oscillator_theory.hpp"

#include <map>

#include "catalog/method_options.hpp"
#include "catalog/methods.hpp"
#include "integrators/structural/generalised_alpha.hpp"
#include "schemes/chebyshev_recurrence.hpp"
#include "schemes/composed_tableau.hpp"

namespace fw::catalog {

namespace {

using analysis::amplification_factors;
using analysis::AmplificationFactors;

/// The scheme with coefficients that does the same on linear systems with forces f(q).
const std::map<std::string, std::string>& linear_twins() {
  static const std::map<std::string, std::string> twins = {
      {"implicit_euler_linearised", "implicit_euler"},  // Newton's first iteration is exact
      {"average_vector_field",
       "implicit_midpoint"},  // the averaged force of a linear one is that of the midpoint
      {"discrete_gradient", "implicit_midpoint"},
  };
  return twins;
}

AmplificationFactors of_parameters(const MethodCall& call) {
  const MethodOptions& options = call.options;
  if (call.name == "newmark") {
    return amplification_factors(integrators::AlphaParameters{.beta = number(options, "beta", 0.25),
                                                              .gamma = number(options, "gamma", 0.5)});
  }
  if (call.name == "hht_alpha") {
    const double alpha = number(options, "alpha", -0.1);
    return amplification_factors(integrators::AlphaParameters{
        .alpha_f = -alpha, .beta = 0.25 * (1.0 - alpha) * (1.0 - alpha), .gamma = 0.5 - alpha});
  }
  if (call.name == "generalised_alpha") {
    return amplification_factors(integrators::chung_hulbert_parameters(number(options, "rho_infinity", 0.8)));
  }
  return {};
}

/// The method of ours that a call coincides with on every linear system (that it applies to).
struct LinearTwin {
  std::string name;
  int repetitions = 1;  ///< steps of it in one step: 2 for codes that go on with two half steps
};

/// Prince and Dormand's RK8(7)13M, the formula of order 8 [Prince, Dormand 1981, table 2], which GSL's rk8pd
/// advances by. The printed quotients stand for irrational numbers, to about 18 digits.
schemes::ButcherTableau prince_dormand_87() {
  const auto row = [](std::initializer_list<const char*> texts) {
    schemes::CoefficientRow coefficients;
    constexpr double printed = 1e-16;
    for (const char* text : texts) coefficients.push_back(schemes::Coefficient::approximation(text, printed));
    return coefficients;
  };
  return {.name = "prince_dormand_87",
          .title = "Prince and Dormand's 8(7)",
          .A = {{},
                row({"1/18"}),
                row({"1/48", "1/16"}),
                row({"1/32", "0", "3/32"}),
                row({"5/16", "0", "-75/64", "75/64"}),
                row({"3/80", "0", "0", "3/16", "3/20"}),
                row({"29443841/614563906", "0", "0", "77736538/692538347", "-28693883/1125000000",
                     "23124283/1800000000"}),
                row({"16016141/946692911", "0", "0", "61564180/158732637", "22789713/633445777",
                     "545815736/2771057229", "-180193667/1043307555"}),
                row({"39632708/573591083", "0", "0", "-433636366/683701615", "-421739975/2616292301",
                     "100302831/723423059", "790204164/839813087", "800635310/3783071287"}),
                row({"246121993/1340847787", "0", "0", "-37695042795/15268766246", "-309121744/1061227803",
                     "-12992083/490766935", "6005943493/2108947869", "393006217/1396673457",
                     "123872331/1001029789"}),
                row({"-1028468189/846180014", "0", "0", "8478235783/508512852", "1311729495/1432422823",
                     "-10304129995/1701304382", "-48777925059/3047939560", "15336726248/1032824649",
                     "-45442868181/3398467696", "3065993473/597172653"}),
                row({"185892177/718116043", "0", "0", "-3185094517/667107341", "-477755414/1098053517",
                     "-703635378/230739211", "5731566787/1027545527", "5232866602/850066563",
                     "-4093664535/808688257", "3962137247/1805957418", "65686358/487910083"}),
                row({"403863854/491063109", "0", "0", "-5068492393/434740067", "-411421997/543043805",
                     "652783627/914296604", "11173962825/925320556", "-13158990841/6184727034",
                     "3936647629/1978049680", "-160528059/685178525", "248638103/1413531060"})},
          .b = row({"14005451/335480064", "0", "0", "0", "0", "-59238493/1068277825", "181606767/758867731",
                    "561292985/797845732", "-1041891430/1371343529", "760417239/1151165299",
                    "118820643/751138087", "-528747749/2220607170", "1/4"}),
          .reference = "Prince, Dormand 1981, J. Comput. Appl. Math. 7"};
}

/// The oracles by the tables that their manuals name [Galassi et al. 2009, ch. 27; Reynolds et al. 2023;
/// Abhyankar et al. 2018]. GSL's rk2 advances by its formula of order 3.
LinearTwin twin_on_linear_systems(const MethodCall& call) {
  static const std::map<std::string, LinearTwin> without_options = {
      {"implicit_euler_linearised", {"implicit_euler"}},
      {"gsl:rk2", {"kutta3"}},
      {"gsl:rk4", {"rk4", 2}},
      {"gsl:rkf45", {"fehlberg_54"}},
      {"gsl:rkck", {"cash_karp_54"}},
      {"gsl:rk1imp", {"implicit_euler", 2}},
      {"gsl:rk2imp", {"implicit_midpoint", 2}},
      {"gsl:rk4imp", {"gauss2", 2}},
      {"sundials:arkode_erk", {"dormand_prince_54"}},
      {"petsc:ts_rk", {"dormand_prince_54"}},
      {"petsc:ts_basicsymplectic", {"velocity_verlet"}},
      {"petsc:ts_theta", {"implicit_midpoint"}},
  };
  static const std::map<std::string, std::string> petsc_types = {{"1fe", "explicit_euler"},
                                                                 {"3bs", "bogacki_shampine_32"},
                                                                 {"4", "rk4"},
                                                                 {"5f", "fehlberg_54"},
                                                                 {"5dp", "dormand_prince_54"}};
  if (call.options.empty()) {
    const auto twin = without_options.find(call.name);
    return twin != without_options.end() ? twin->second : LinearTwin{};
  }
  if (call.options.size() > 1) return {};
  const auto& [option, value] = *call.options.begin();
  if (call.name == "sundials:arkode_erk" && option == "tableau") return {value};
  if (call.name == "petsc:ts_rk" && option == "type") {
    const auto type = petsc_types.find(value);
    if (type != petsc_types.end()) return {type->second};
  }
  return {};
}

}  // namespace

analysis::LinearScheme linear_scheme(const std::string& text) {
  using analysis::LinearRule;
  if (schemes::SchemeData data = scheme_of(text); !std::holds_alternative<std::monostate>(data))
    return {std::move(data)};
  const MethodCall call = parse_method_call(text);
  if (call.name == "verlet") return {{}, LinearRule::verlet_central_velocity};
  if (call.name == "verlet_backward_velocity") return {{}, LinearRule::verlet_backward_velocity};
  if (call.name == "gautschi" || call.name == "exponential_rosenbrock_euler") return {{}, LinearRule::exact};
  if (call.options.size() == 1 && call.options.contains("stages")) return {equivalent_scheme(text)};
  if (call.name == "gsl:rk8pd" && call.options.empty()) return {prince_dormand_87()};
  const LinearTwin twin = twin_on_linear_systems(call);
  if (twin.name.empty()) return {};
  schemes::SchemeData data = find_method(twin.name).data;
  if (twin.repetitions == 1) return {std::move(data)};
  return {schemes::repeated(std::get<schemes::ButcherTableau>(data), twin.repetitions)};
}

schemes::SchemeData equivalent_scheme(const std::string& text) {
  const MethodCall call = parse_method_call(text);
  if (call.name == "verlet" || call.name == "verlet_backward_velocity")
    return find_method("velocity_verlet").data;
  if (const auto stages = call.options.find("stages"); stages != call.options.end()) {
    if (stages->second == "auto") return {};
    return schemes::chebyshev_tableau(call.name == "rkc1" ? 1 : 2, std::stoi(stages->second));
  }
  return find_method(call.name).data;
}

AmplificationFactors oscillator_theory(const std::string& text) {
  const MethodCall call = parse_method_call(text);
  if (const auto twin = linear_twins().find(call.name); twin != linear_twins().end()) {
    return amplification_factors(find_method(twin->second).data);
  }
  if (call.name == "gautschi" || call.name == "exponential_rosenbrock_euler") {
    return analysis::exact_amplification_factors();
  }
  if (AmplificationFactors factors = of_parameters(call)) return factors;
  return amplification_factors(equivalent_scheme(text));
}

}  // namespace fw::catalog
