#include "app/describe_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>
#include <vector>

#include "app/input_kind.hpp"
#include "catalog/equilibrium.hpp"
#include "catalog/methods.hpp"
#include "catalog/stable_steps.hpp"
#include "core/special_values.hpp"
#include "mechanics/mass_spring_system.hpp"
#include "scene/scene.hpp"
#include "text/json_writer.hpp"

namespace fw::app {

namespace {

constexpr std::size_t stiffest_shown = 5;

/// A spring and what it is between its two masses alone.
struct SpringRate {
  std::size_t index = 0;
  double rate = 0.0;       ///< [N/m], also of the law "strain"
  double frequency = 0.0;  ///< √(k (1/m_i + 1/m_j)), fixed particles having no inverse mass [rad/s]
};

struct SceneFacts {
  std::string file;
  scene::Scene scene;
  std::shared_ptr<const mechanics::MassSpringSystem> system{};
  Vector state{};
  std::vector<SpringRate> stiffest{};
  analysis::LinearModes modes{};
  std::vector<catalog::StableStep> steps{};
};

std::vector<SpringRate> stiffest_springs(const mechanics::MassSpringSystem& system) {
  const mechanics::Springs& springs = system.model().springs;
  const auto inverse_mass = [&](int particle) {
    const auto i = static_cast<std::size_t>(particle);
    return system.fixed()[3 * i] ? 0.0 : 1.0 / system.model().mass[i];
  };
  std::vector<SpringRate> rates(springs.size());
  for (std::size_t e = 0; e < springs.size(); ++e) {
    const bool is_strain = springs.law_of(e) == mechanics::SpringLaw::strain;
    const double rate = is_strain ? springs.stiffness[e] / springs.rest_length[e] : springs.stiffness[e];
    rates[e] = {e, rate,
                std::sqrt(rate * (inverse_mass(springs.first[e]) + inverse_mass(springs.second[e])))};
  }
  const std::size_t shown = std::min(stiffest_shown, rates.size());
  std::partial_sort(rates.begin(), rates.begin() + static_cast<std::ptrdiff_t>(shown), rates.end(),
                    [](const SpringRate& a, const SpringRate& b) {
                      return std::pair(-a.frequency, a.index) < std::pair(-b.frequency, b.index);
                    });
  rates.resize(shown);
  return rates;
}

SceneFacts facts_of(const std::string& file) {
  SceneFacts facts;
  facts.file = file;
  facts.scene = read_scene_for(file, "describe");
  facts.system = std::make_shared<const mechanics::MassSpringSystem>(facts.scene.model);
  facts.state = initial_state(facts.scene);
  if (facts.scene.starts_at_equilibrium) {
    facts.state.head(facts.system->degrees_of_freedom()) =
        catalog::require_equilibrium(*facts.system, facts.scene.position);
  }
  facts.stiffest = stiffest_springs(*facts.system);
  facts.modes = catalog::modes_at(*facts.system, 0.0, facts.state, catalog::SpectrumQuality::thorough);
  for (const std::string& call : catalog::first_methods()) {
    catalog::StableStep step = catalog::stable_step(call, facts.modes, *facts.system);
    if (step.why != "it chooses its own steps") facts.steps.push_back(std::move(step));
  }
  return facts;
}

/// Angular frequencies of the slowest and fastest vibration at the start; NaN without any.
std::pair<double, double> frequencies(const analysis::LinearModes& modes) {
  double slowest = infinity, fastest = 0.0;
  for (const analysis::VibrationMode& mode : modes.vibrations) {
    slowest = std::min(slowest, std::sqrt(mode.omega_squared));
    fastest = std::max(fastest, std::sqrt(mode.omega_squared));
  }
  if (modes.vibrations.empty()) return {no_value, no_value};
  return {modes.is_complete ? slowest : no_value, fastest};
}

std::string range_of(const std::vector<double>& values, const char* unit) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return *low == *high ? fmt::format("{:.6g} {}", *low, unit)
                       : fmt::format("{:.6g} to {:.6g} {}", *low, *high, unit);
}

/// With this many digits, or as many as are known.
std::string number(double value, int digits, bool is_rough) {
  return is_rough ? fmt::format("about {:.3g}", value) : fmt::format("{:.{}g}", value, digits);
}

std::string step_text(const catalog::StableStep& step, bool is_rough) {
  if (std::isnan(step.step)) return step.why;
  if (std::isinf(step.step)) return "no limit";
  if (step.step == 0.0) return "none: an undamped mode grows at every step";
  return number(1e3 * step.step, 4, is_rough) + " ms";
}

std::string to_text(const SceneFacts& facts) {
  const mechanics::MassSpringModel& model = facts.system->model();
  std::string text = facts.file + "\n";
  if (!facts.scene.title.empty()) text += facts.scene.title + "\n";
  text += "\n";
  const auto line = [&](const char* label, const std::string& value) {
    text += fmt::format("  {:<24} {}\n", label, value);
  };
  line("particles", fmt::format("{}, {} of them fixed", model.mass.size(), model.fixed.size()));
  line("mass", fmt::format("{}, {:.6g} kg in all", range_of(model.mass, "kg"),
                           std::accumulate(model.mass.begin(), model.mass.end(), 0.0)));
  line("springs", model.springs.size() == 0
                      ? "none"
                      : fmt::format("{}, stiffness {}", model.springs.size(),
                                    range_of(model.springs.stiffness, "N/m (N of the law strain)")));
  line("anchors, obstacles", fmt::format("{}, {}", model.anchors.size(), model.obstacles.size()));
  line("forces", facts.system->force_class() == ForceClass::velocity ? "with damping" : "without damping");
  if (facts.system->is_driven()) {
    line("depend on time",
         fmt::format("{} forces, {} sets of supports", model.forces.size(), model.support_motions.size()));
  }
  const Index n = facts.system->degrees_of_freedom();
  const Energies energies = facts.system->energies(0.0, facts.state.head(n), facts.state.tail(n));
  line("energy at the start",
       fmt::format("{:.6g} J kinetic, {:.6g} J potential", energies.kinetic(), energies.potential()));
  if (!facts.stiffest.empty()) text += "\nStiffest springs (frequency between their two masses alone)\n";
  for (const SpringRate& spring : facts.stiffest) {
    text += fmt::format(
        "  springs[{}] {:<16} {:.6g} N/m, {:.6g} rad/s\n", spring.index,
        fmt::format("[{}, {}]", model.springs.first[spring.index], model.springs.second[spring.index]),
        spring.rate, spring.frequency);
  }
  text += "\nLinearised at the start\n";
  if (!facts.modes.status.ok()) {
    line("eigenvalues", facts.modes.status.describe());
    return text;
  }
  const auto [slowest, fastest] = frequencies(facts.modes);
  const bool rough = facts.modes.is_rough;
  line("largest |eigenvalue|", number(facts.modes.spectral_radius, 6, rough) + " 1/s");
  if (!std::isnan(fastest)) {
    line("fastest vibration", fmt::format("{} rad/s, period {} ms", number(fastest, 6, rough),
                                          number(1e3 * 2.0 * std::numbers::pi / fastest, 4, rough)));
  }
  if (!std::isnan(slowest)) {
    line("slowest vibration",
         fmt::format("{:.6g} rad/s, period {:.4g} s", slowest, 2.0 * std::numbers::pi / slowest));
  }
  if (facts.modes.growing > 0) {
    line("growing modes", fmt::format("{} (compressed springs buckle)", facts.modes.growing));
  }
  text += "\nLargest stable step at the start, in theory\n";
  for (const catalog::StableStep& step : facts.steps) line(step.call.c_str(), step_text(step, rough));
  return text;
}

std::string to_json(const SceneFacts& facts) {
  const mechanics::MassSpringModel& model = facts.system->model();
  const auto [slowest, fastest] = frequencies(facts.modes);
  text::JsonWriter json;
  json.begin_object();
  json.key("type").value("scene").key("file").value(facts.file).key("title").value(facts.scene.title);
  json.key("particles").value(static_cast<std::uint64_t>(model.mass.size()));
  json.key("fixed").value(static_cast<std::uint64_t>(model.fixed.size()));
  const auto [low, high] = std::minmax_element(model.mass.begin(), model.mass.end());
  json.key("smallest_mass").value(*low).key("largest_mass").value(*high);
  json.key("total_mass").value(std::accumulate(model.mass.begin(), model.mass.end(), 0.0));
  json.key("springs").value(static_cast<std::uint64_t>(model.springs.size()));
  json.key("stiffest_springs").begin_array();
  for (const SpringRate& spring : facts.stiffest) {
    json.begin_object();
    json.key("index").value(static_cast<std::uint64_t>(spring.index));
    json.key("between").begin_array();
    json.value(static_cast<std::int64_t>(model.springs.first[spring.index]));
    json.value(static_cast<std::int64_t>(model.springs.second[spring.index])).end_array();
    json.key("rate").value(spring.rate).key("frequency").value(spring.frequency).end_object();
  }
  json.end_array();
  json.key("spectral_radius").value(facts.modes.spectral_radius);
  json.key("fastest_vibration").value(fastest).key("slowest_vibration").value(slowest);
  json.key("is_rough").value(facts.modes.is_rough);
  json.key("growing_modes").value(static_cast<std::int64_t>(facts.modes.growing));
  json.key("stable_steps").begin_array();
  for (const catalog::StableStep& step : facts.steps) {
    json.begin_object().key("method").value(step.call).key("step").value(step.step);
    json.key("has_limit").value(std::isfinite(step.step));
    json.key("why").value(step.why).end_object();
  }
  json.end_array().end_object();
  return json.text() + "\n";
}

}  // namespace

std::string describe_scene(const std::string& file, bool as_json) {
  const SceneFacts facts = facts_of(file);
  return as_json ? to_json(facts) : to_text(facts);
}

}  // namespace fw::app
