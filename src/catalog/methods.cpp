#include "catalog/methods.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <optional>
#include <utility>

#include "catalog/declared_options.hpp"
#include "catalog/integrator_options.hpp"
#include "catalog/oracle_methods.hpp"
#include "core/error.hpp"
#include "integrators/energy_momentum/discrete_gradient.hpp"
#include "integrators/loop/limited_integrator.hpp"
#include "integrators/special/implicit_euler_linearised.hpp"
#include "integrators/special/predicted_velocity_verlet.hpp"
#include "integrators/special/verlet.hpp"
#include "integrators/tableau/additive_runge_kutta.hpp"
#include "integrators/tableau/diagonally_implicit_runge_kutta.hpp"
#include "integrators/tableau/explicit_runge_kutta.hpp"
#include "integrators/tableau/fully_implicit_runge_kutta.hpp"
#include "integrators/tableau/linear_multistep.hpp"
#include "integrators/tableau/nystrom.hpp"
#include "integrators/tableau/rosenbrock.hpp"
#include "integrators/tableau/runge_kutta_chebyshev.hpp"
#include "integrators/tableau/splitting.hpp"
#include "schemes/additive_tableaus.hpp"
#include "schemes/chebyshev_recurrence.hpp"
#include "schemes/explicit_tableaus.hpp"
#include "schemes/implicit_tableaus.hpp"
#include "schemes/multistep_formulas.hpp"
#include "schemes/nystrom_tableaus.hpp"
#include "schemes/rosenbrock_tableaus.hpp"
#include "schemes/splitting_schemes.hpp"
#include "text/closest_name.hpp"

namespace fw::catalog {

namespace {

/// Options of a scheme that can choose its own steps.
const std::vector<settings::SettingDescription>& controller_options() {
  static const std::vector<settings::SettingDescription> list =
      declared_options<integrators::ControllerOptions>();
  return list;
}

/// A scheme given by data, with the controller's options where it has an error estimate. The data outlive the
/// list.
template <class Data, class Make>
MethodEntry with_controller(const Data& data, Make make) {
  return {data.name,
          data.has_embedded_solution() ? controller_options() : std::vector<settings::SettingDescription>{},
          of_coefficients(data), [&data, make](const MethodOptions& options) {
            return make(data, read_options<integrators::ControllerOptions>(options));
          }};
}

/// Schemes of ours that theory tells as another one, on linear systems at least.
analysis::Theory implicit_midpoint_on_linear_systems() {
  return analysis::theory_on_linear_systems(
      {named(schemes::diagonally_implicit_tableaus(), "implicit_midpoint")});
}
analysis::Theory exact_on_linear_systems() {
  return analysis::theory_on_linear_systems({.rule = analysis::LinearRule::exact});
}
/// Of Verlet's two-step form, which is velocity Verlet where forces do not depend on velocity.
analysis::Theory verlet_theory(analysis::LinearRule rule) {
  return {.on_position_forces = named(schemes::splitting_schemes(), "velocity_verlet"),
          .on_linear_systems = {.rule = rule}};
}
/// Of Newmark's scheme and its relatives.
template <class Options>
analysis::Theory alpha_theory(const Options& options) {
  return analysis::theory_on_linear_systems(
      {.rule = analysis::LinearRule::alpha_family, .alpha = integrators::alpha_parameters(options)});
}

/// `linear_solver` and `petsc` as the options of a linear solver.
linalg::LinearSolverOptions linear_solver_of(const LinearisedEulerCall& call) {
  linalg::LinearSolverOptions chosen;
  try {
    chosen = linalg::read_linear_solver(call.linear_solver + " " + call.petsc);
  } catch (const InputError& error) {
    throw InputError(fmt::format("option petsc: {}", error.what()));
  }
  chosen.relative_tolerance = call.linear_tolerance;
  return chosen;
}

MethodEntry linearised_implicit_euler() {
  const auto make = [](const LinearisedEulerCall& call) {
    return integrators::make_implicit_euler_linearised(
        {.linear_solver = linear_solver_of(call), .tangent = call.tangent});
  };
  // Newton's first iteration with the exact tangent is the solution where forces are linear.
  const auto theory = [](const LinearisedEulerCall& call) {
    if (call.tangent != TangentModel::exact) return analysis::Theory{};
    return analysis::theory_on_linear_systems(
        {named(schemes::diagonally_implicit_tableaus(), "implicit_euler")});
  };
  return declared_method(integrators::make_implicit_euler_linearised({})->info().name, LinearisedEulerCall{},
                         make, theory);
}

MethodEntry runge_kutta_chebyshev(int order) {
  using integrators::RungeKuttaChebyshevOptions;
  const auto theory = [](const RungeKuttaChebyshevOptions& chosen) {
    if (chosen.stages == 0) return analysis::Theory{};  // another scheme at every step
    return analysis::theory_of(schemes::chebyshev_tableau(chosen.order, chosen.stages));
  };
  return declared_method(fmt::format("rkc{}", order), RungeKuttaChebyshevOptions{.order = order},
                         integrators::make_runge_kutta_chebyshev, theory);
}

/// A scheme with declared options and a theory of them.
template <class Options, class Theory>
MethodEntry with_options(std::unique_ptr<Integrator> (*make)(const Options&), Theory theory) {
  return declared_method(make({})->info().name, Options{}, make, theory);
}

/// Structural dynamics, energy–momentum, exponential, graphics and multirate schemes.
std::vector<MethodEntry> specialised_schemes() {
  using namespace integrators;
  std::vector<MethodEntry> list;
  // The averaged force of linear ones is that of the midpoint, with any number of points.
  const auto midpoint = [](const auto&) { return implicit_midpoint_on_linear_systems(); };
  const auto exact = [](const auto&) { return exact_on_linear_systems(); };
  const auto none = [](const auto&) { return analysis::Theory{}; };
  list.push_back(with_options<NewmarkOptions>(make_newmark, alpha_theory<NewmarkOptions>));
  list.push_back(with_options<HhtAlphaOptions>(make_hht_alpha, alpha_theory<HhtAlphaOptions>));
  list.push_back(
      with_options<GeneralisedAlphaOptions>(make_generalised_alpha, alpha_theory<GeneralisedAlphaOptions>));
  list.push_back(with_options<AverageVectorFieldOptions>(make_average_vector_field, midpoint));
  list.push_back(plain(make_discrete_gradient, implicit_midpoint_on_linear_systems()));
  list.push_back(with_options<ExponentialOptions>(make_exponential_rosenbrock_euler, exact));
  list.push_back(with_options<GautschiOptions>(make_gautschi, exact));
  list.push_back(with_options<RespaOptions>(make_r_respa, none));
  list.push_back(with_options<ProjectiveDynamicsOptions>(make_projective_dynamics, none));
  list.push_back(with_options<XpbdOptions>(make_xpbd, none));
  return list;
}

std::vector<MethodEntry> make_list() {
  std::vector<MethodEntry> list;
  for (const schemes::ButcherTableau& tableau : schemes::explicit_tableaus()) {
    list.push_back(with_controller(tableau, integrators::make_explicit_runge_kutta));
  }
  for (const schemes::NystromTableau& tableau : schemes::nystrom_tableaus()) {
    list.push_back(with_controller(tableau, integrators::make_nystrom));
  }
  for (const schemes::SplittingScheme& scheme : schemes::splitting_schemes()) {
    list.push_back({scheme.name, {}, of_coefficients(scheme), [&scheme](const MethodOptions&) {
                      return integrators::make_splitting(scheme);
                    }});
  }
  list.push_back(runge_kutta_chebyshev(1));
  list.push_back(runge_kutta_chebyshev(2));
  using analysis::LinearRule;
  using integrators::VerletVelocity;
  list.push_back(plain(integrators::make_predicted_velocity_verlet));
  analysis::Theory verlet = verlet_theory(LinearRule::verlet_central_velocity);
  verlet.modified_energy = analysis::velocity_verlet_energy;  // its velocity is velocity Verlet's
  list.push_back(plain([] { return integrators::make_verlet(VerletVelocity::central); }, std::move(verlet)));
  list.push_back(plain([] { return integrators::make_verlet(VerletVelocity::backward); },
                       verlet_theory(LinearRule::verlet_backward_velocity)));
  for (const schemes::ButcherTableau& tableau : schemes::diagonally_implicit_tableaus()) {
    list.push_back(
        with_controller(tableau, [](const auto& data, const integrators::ControllerOptions& controller) {
          return integrators::make_diagonally_implicit_runge_kutta(data, {}, controller);
        }));
  }
  for (const schemes::ButcherTableau& tableau : schemes::fully_implicit_tableaus()) {
    list.push_back({tableau.name, {}, of_coefficients(tableau), [&tableau](const MethodOptions&) {
                      return integrators::make_fully_implicit_runge_kutta(tableau);
                    }});
  }
  for (const schemes::NystromTableau& tableau : schemes::implicit_nystrom_tableaus()) {
    list.push_back({tableau.name, {}, of_coefficients(tableau), [&tableau](const MethodOptions&) {
                      return integrators::make_implicit_nystrom(tableau);
                    }});
  }
  for (const schemes::RosenbrockTableau& tableau : schemes::rosenbrock_tableaus()) {
    list.push_back(with_controller(tableau, integrators::make_rosenbrock));
  }
  for (const schemes::AdditiveTableau& tableau : schemes::additive_tableaus()) {
    list.push_back(
        with_controller(tableau, [](const auto& data, const integrators::ControllerOptions& controller) {
          return integrators::make_additive_runge_kutta(data, {}, controller);
        }));
  }
  list.push_back(linearised_implicit_euler());
  for (const schemes::MultistepFormula& formula : schemes::multistep_formulas()) {
    list.push_back({formula.name, {}, of_coefficients(formula), [&formula](const MethodOptions&) {
                      return integrators::make_linear_multistep(formula);
                    }});
  }
  for (MethodEntry& entry : specialised_schemes()) list.push_back(std::move(entry));
  for (auto* oracle_methods : {sundials_methods, arkode_methods, petsc_methods, gsl_methods}) {
    for (MethodEntry& entry : oracle_methods()) list.push_back(std::move(entry));
  }
  return list;
}

}  // namespace

const std::vector<MethodEntry>& methods() {
  static const std::vector<MethodEntry> list = make_list();
  return list;
}

const std::vector<std::string>& first_methods() {
  static const std::vector<std::string> names = {"explicit_euler",
                                                 "symplectic_euler",
                                                 "verlet",
                                                 "velocity_verlet",
                                                 "midpoint",
                                                 "heun",
                                                 "rk4",
                                                 "implicit_euler_linearised",
                                                 "implicit_euler",
                                                 "trapezoidal",
                                                 "implicit_midpoint",
                                                 "bdf2",
                                                 "dormand_prince_54",
                                                 "radau_iia3",
                                                 "sundials:cvode_bdf"};
  return names;
}

std::string our_name_of(const std::string& name) {
  static const std::map<std::string, std::string> names = {
      {"euler", "explicit_euler"},
      {"forward_euler", "explicit_euler"},
      {"backward_euler", "implicit_euler"},
      {"semi_implicit_euler", "symplectic_euler"},
      {"leapfrog", "velocity_verlet"},
      {"stormer_verlet", "velocity_verlet"},
      {"stoermer_verlet", "velocity_verlet"},
      {"crank_nicolson", "trapezoidal"},
      {"runge_kutta", "rk4"},
      {"runge_kutta_4", "rk4"},
      {"rk2", "midpoint"},
      {"rk23", "bogacki_shampine_32"},
      {"ode23", "bogacki_shampine_32"},
      {"rk45", "dormand_prince_54"},
      {"ode45", "dormand_prince_54"},
      {"dopri5", "dormand_prince_54"},
      {"dopri853", "dormand_prince_853"},
      {"dop853", "dormand_prince_853"},
      {"rkf45", "fehlberg_54"},
      {"tsit5", "tsitouras_54"},
      {"vern6", "verner_65"},
      {"radau", "radau_iia3"},
      {"radau5", "radau_iia3"},
      {"ode15s", "sundials:cvode_bdf"},
      {"lsoda", "sundials:cvode_bdf"},
      {"generalized_alpha", "generalised_alpha"},
      {"hht", "hht_alpha"},
      {"avf", "average_vector_field"},
      {"pbd", "xpbd"},
  };
  if (const auto found = names.find(name); found != names.end()) return found->second;
  for (const MethodEntry& entry : methods()) {
    const auto colon = entry.name.find(':');
    if (colon != std::string::npos && entry.name.substr(colon + 1) == name) return entry.name;
  }
  return "";
}

const MethodEntry& find_method(const std::string& name) {
  std::vector<std::string> names;
  for (const MethodEntry& entry : methods()) {
    if (entry.name == name) return entry;
    names.push_back(entry.name);
  }
  const std::string ours = our_name_of(name);
  throw InputError(fmt::format(
      "unknown method \"{}\"{}; \"federwerk list methods --all\" shows all", name,
      ours.empty() ? did_you_mean(name, names) : fmt::format("; it is called \"{}\" here", ours)));
}

namespace {

constexpr const char* maximum_step_option = "maximum_step";

/// The call without the option that every adaptive method has, and its value.
std::pair<MethodCall, std::optional<double>> without_maximum_step(MethodCall call) {
  const auto found = call.options.find(maximum_step_option);
  if (found == call.options.end()) return {std::move(call), std::nullopt};
  const std::string text = found->second;
  call.options.erase(found);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !(value > 0.0)) {
    throw InputError(fmt::format("method \"{}\": {}: found \"{}\", expected a number of seconds > 0",
                                 call.name, maximum_step_option, text));
  }
  return {std::move(call), value};
}

/// What `make` makes of the entry of a call. Throws InputError for an option that the method does not take,
/// and names the method where a value is refused.
template <class Make>
auto with_checked_options(const MethodCall& call, Make make) {
  const MethodEntry& entry = find_method(call.name);
  std::vector<std::string> names;
  for (const settings::SettingDescription& option : entry.options) names.push_back(option.info.name);
  for (const auto& [name, value] : call.options) {
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    throw InputError(names.empty()
                         ? fmt::format("method \"{}\" takes no options, found \"{}\"", call.name, name)
                         : fmt::format("method \"{}\": unknown option \"{}\", expected one of {}{}",
                                       call.name, name, fmt::join(names, ", "), did_you_mean(name, names)));
  }
  try {
    return make(entry);
  } catch (const InputError& error) {
    throw InputError(fmt::format("method \"{}\": {}", call.name, error.what()));
  }
}

}  // namespace

std::unique_ptr<Integrator> make_method(const std::string& text) {
  return make_method(parse_method_call(text));
}

std::unique_ptr<Integrator> make_method(const MethodCall& given) {
  const auto [call, maximum_step] = without_maximum_step(given);
  return with_checked_options(call, [&](const MethodEntry& entry) {
    std::unique_ptr<Integrator> method = entry.make(call.options);
    return maximum_step ? integrators::make_limited(std::move(method), *maximum_step) : std::move(method);
  });
}

analysis::Theory theory_of_call(const std::string& text) {
  const MethodCall call = without_maximum_step(parse_method_call(text)).first;
  return with_checked_options(call, [&](const MethodEntry& entry) { return entry.theory(call.options); });
}

}  // namespace fw::catalog
