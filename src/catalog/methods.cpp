#include "catalog/methods.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "catalog/declared_options.hpp"
#include "catalog/integrator_options.hpp"
#include "catalog/method_options.hpp"
#include "catalog/oracle_methods.hpp"
#include "core/error.hpp"
#include "integrators/energy_momentum/discrete_gradient.hpp"
#include "integrators/special/implicit_euler_linearised.hpp"
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
const std::vector<OptionInfo>& controller_options() {
  static const std::vector<OptionInfo> list = declared_options<integrators::ControllerOptions>();
  return list;
}

bool has_embedded_solution(const schemes::ButcherTableau& tableau) {
  return !tableau.b_embedded.empty();
}
bool has_embedded_solution(const schemes::RosenbrockTableau& tableau) {
  return !tableau.b_embedded.empty();
}
bool has_embedded_solution(const schemes::NystromTableau& tableau) {
  return !tableau.b_velocity_embedded.empty();
}
bool has_embedded_solution(const schemes::AdditiveTableau& tableau) {
  return !tableau.explicit_part.b_embedded.empty();
}

/// A scheme given by data, with the controller's options where it has an error estimate. The data outlive the
/// list.
template <class Data, class Make>
MethodEntry with_controller(const Data& data, Make make) {
  return {data.name, has_embedded_solution(data) ? controller_options() : std::vector<OptionInfo>{}, data,
          [&data, make](const MethodOptions& options) {
            return make(data, read_options<integrators::ControllerOptions>(options));
          }};
}

linalg::LinearSolverOptions read_linear_solver_options(const MethodOptions& options) {
  const std::string given = text(options, "linear_solver");
  const std::string name = given.empty() ? "cg" : given;
  const auto checked = [](const std::string& option, const std::string& call) {
    try {
      return linalg::read_linear_solver(call);
    } catch (const InputError& error) {
      throw InputError(fmt::format("option {}: {}", option, error.what()));
    }
  };
  checked("linear_solver", name);
  return checked("petsc", name + " " + text(options, "petsc"));
}

MethodEntry linearised_implicit_euler() {
  using integrators::LinearisedOptions;
  return {integrators::make_implicit_euler_linearised({})->info().name,
          {{"linear_solver", "cg", linalg::linear_solver_names()},
           {"linear_tolerance", "1e-10", "relative residual of iterative solvers"},
           {"petsc", "", "options of the linear solver petsc, such as -ksp_type cg -pc_type gamg"},
           {"tangent", "exact", "exact, tensile_geometric_term or psd_projection"}},
          {},
          [](const MethodOptions& options) {
            LinearisedOptions chosen;
            chosen.linear_solver = read_linear_solver_options(options);
            chosen.linear_solver.relative_tolerance = positive_number(options, "linear_tolerance", 1e-10);
            chosen.tangent =
                choose<TangentModel>(options, "tangent", TangentModel::exact,
                                     {{"exact", TangentModel::exact},
                                      {"tensile_geometric_term", TangentModel::tensile_geometric_term},
                                      {"psd_projection", TangentModel::psd_projection}});
            return integrators::make_implicit_euler_linearised(chosen);
          }};
}

MethodEntry runge_kutta_chebyshev(int order) {
  const integrators::RungeKuttaChebyshevOptions defaults{.order = order};
  return {fmt::format("rkc{}", order),
          {{"stages", fmt::format("{}", defaults.stages),
            "number of stages, or auto (from the step and the spectral radius of J)"}},
          schemes::chebyshev_tableau(order, defaults.stages),
          [defaults](const MethodOptions& options) {
            integrators::RungeKuttaChebyshevOptions chosen = defaults;
            const auto option = options.find("stages");
            if (option != options.end()) {
              const bool automatic = option->second == "auto";
              chosen.stages = automatic ? 0
                                        : whole_number(option->first, option->second,
                                                       integrators::fewest_chebyshev_stages,
                                                       integrators::most_chebyshev_stages, " or auto");
            }
            return integrators::make_runge_kutta_chebyshev(chosen);
          }};
}

/// A scheme with declared options.
template <class Options>
MethodEntry with_options(std::unique_ptr<Integrator> (*make)(const Options&)) {
  return {make({})->info().name, declared_options<Options>(), {}, [make](const MethodOptions& options) {
            return make(read_options<Options>(options));
          }};
}

/// Structural dynamics, energy–momentum, exponential, graphics and multirate schemes.
std::vector<MethodEntry> specialised_schemes() {
  using namespace integrators;
  std::vector<MethodEntry> list;
  list.push_back(with_options<NewmarkOptions>(make_newmark));
  list.push_back(with_options<HhtAlphaOptions>(make_hht_alpha));
  list.push_back(with_options<GeneralisedAlphaOptions>(make_generalised_alpha));
  list.push_back(with_options<AverageVectorFieldOptions>(make_average_vector_field));
  list.push_back(plain(make_discrete_gradient));
  list.push_back(with_options<ExponentialOptions>(make_exponential_rosenbrock_euler));
  list.push_back(with_options<GautschiOptions>(make_gautschi));
  list.push_back(with_options<RespaOptions>(make_r_respa));
  list.push_back(with_options<ProjectiveDynamicsOptions>(make_projective_dynamics));
  list.push_back(with_options<XpbdOptions>(make_xpbd));
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
    list.push_back({scheme.name, {}, scheme, [&scheme](const MethodOptions&) {
                      return integrators::make_splitting(scheme);
                    }});
  }
  list.push_back(runge_kutta_chebyshev(1));
  list.push_back(runge_kutta_chebyshev(2));
  list.push_back(plain([] { return integrators::make_verlet(integrators::VerletVelocity::central); }));
  list.push_back(plain([] { return integrators::make_verlet(integrators::VerletVelocity::backward); }));
  for (const schemes::ButcherTableau& tableau : schemes::diagonally_implicit_tableaus()) {
    list.push_back(
        with_controller(tableau, [](const auto& data, const integrators::ControllerOptions& controller) {
          return integrators::make_diagonally_implicit_runge_kutta(data, {}, controller);
        }));
  }
  for (const schemes::ButcherTableau& tableau : schemes::fully_implicit_tableaus()) {
    list.push_back({tableau.name, {}, tableau, [&tableau](const MethodOptions&) {
                      return integrators::make_fully_implicit_runge_kutta(tableau);
                    }});
  }
  for (const schemes::NystromTableau& tableau : schemes::implicit_nystrom_tableaus()) {
    list.push_back({tableau.name, {}, tableau, [&tableau](const MethodOptions&) {
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
    list.push_back({formula.name, {}, formula, [&formula](const MethodOptions&) {
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

const MethodEntry& find_method(const std::string& name) {
  std::vector<std::string> names;
  for (const MethodEntry& entry : methods()) {
    if (entry.name == name) return entry;
    names.push_back(entry.name);
  }
  throw InputError(fmt::format("unknown method \"{}\"{}; \"federwerk list methods\" shows all", name,
                               did_you_mean(name, names)));
}

std::unique_ptr<Integrator> make_method(const std::string& text) {
  return make_method(parse_method_call(text));
}

std::unique_ptr<Integrator> make_method(const MethodCall& call) {
  const MethodEntry& entry = find_method(call.name);
  for (const auto& [name, value] : call.options) {
    const bool known = std::any_of(entry.options.begin(), entry.options.end(),
                                   [&name = name](const OptionInfo& option) { return option.name == name; });
    if (!known) {
      std::vector<std::string> names;
      for (const OptionInfo& option : entry.options) names.push_back(option.name);
      throw InputError(names.empty()
                           ? fmt::format("method \"{}\" takes no options, found \"{}\"", call.name, name)
                           : fmt::format("method \"{}\": unknown option \"{}\", expected one of {}",
                                         call.name, name, fmt::join(names, ", ")));
    }
  }
  try {
    return entry.make(call.options);
  } catch (const InputError& error) {
    throw InputError(fmt::format("method \"{}\": {}", call.name, error.what()));
  }
}

schemes::SchemeData scheme_of(const std::string& text) {
  const MethodCall call = parse_method_call(text);
  const auto is_of_controller = [](const auto& option) {
    return std::any_of(controller_options().begin(), controller_options().end(),
                       [&](const OptionInfo& known) { return known.name == option.first; });
  };
  const MethodEntry& entry = find_method(call.name);
  if (!std::all_of(call.options.begin(), call.options.end(), is_of_controller)) return {};
  return entry.data;
}

}  // namespace fw::catalog
