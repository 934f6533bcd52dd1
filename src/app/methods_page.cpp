#include "app/methods_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>
#include <vector>

#include "catalog/methods.hpp"
#include "schemes/derived_properties.hpp"

namespace fw::app {

namespace {

/// `|` separates cells; it is written as an entity inside one.
std::string cell(std::string text) {
  for (std::size_t at = text.find('|'); at != std::string::npos; at = text.find('|', at))
    text.replace(at, 1, "&#124;");
  return text;
}

std::string order_cell(const MethodInfo& info) {
  if (info.order == 0) return "variable";
  const std::string with_dampers =
      info.needs.has(Capability::position_forces) || info.order_with_velocity_forces == 0
          ? "–"
          : std::to_string(info.order_with_velocity_forces);
  std::string text = fmt::format("{} / {}", info.order, with_dampers);
  if (info.embedded_order > 0) text += fmt::format(" ({})", info.embedded_order);
  return text;
}

std::string interval(double limit) {
  if (std::isinf(limit)) return "∞";
  return limit < 1e-6 ? "0" : fmt::format("{:.3g}", limit);
}

std::string stability_cell(const MethodInfo& info, const schemes::DerivedProperties& derived) {
  if (info.is_l_stable) return "L-stable";
  if (info.is_a_stable) return "A-stable";
  if (derived.stability_angle && *derived.stability_angle > 0.0) {
    return fmt::format("A({:.1f}°)", *derived.stability_angle);
  }
  if (derived.stability) {
    if (derived.stability->alpha_degrees > 0.0)
      return fmt::format("A({:.1f}°)", derived.stability->alpha_degrees);
    return fmt::format("real {}, imaginary {}", interval(derived.stability->real_interval),
                       interval(derived.stability->imaginary_interval));
  }
  if (derived.oscillator) return fmt::format("hω ≤ {}", interval(derived.oscillator->interval));
  return info.family == "oracle" ? "–" : "conditional";  // of foreign solvers nothing is derived
}

std::string properties_cell(const MethodInfo& info, const schemes::DerivedProperties& derived) {
  std::vector<std::string> words;
  if (info.is_symplectic) words.emplace_back("symplectic");
  if (info.is_symmetric) words.emplace_back("symmetric");
  if (info.conserves_energy) words.emplace_back("conserves energy");
  if (derived.algebraically_stable.value_or(false)) words.emplace_back("B-stable");
  if (derived.stiffly_accurate.value_or(false) && !info.is_explicit) words.emplace_back("stiffly accurate");
  if (derived.stage_order && !info.is_explicit)
    words.push_back(fmt::format("stage order {}", *derived.stage_order));
  if (derived.first_same_as_last.value_or(false)) words.emplace_back("FSAL");
  if (info.is_adaptive) words.emplace_back("adaptive");
  if (info.needs.has(Capability::springs)) words.emplace_back("springs only");
  if (info.needs.has(Capability::force_splitting)) words.emplace_back("stiff and soft forces");
  return fmt::format("{}", fmt::join(words, ", "));
}

std::string row(const catalog::MethodEntry& entry) {
  const MethodInfo& info = entry.info();
  const schemes::DerivedProperties derived = schemes::derive(entry.theory({}).coefficients);
  return fmt::format("| `{}` | {} | {} | {} | {} | {} | {} |\n", info.name, cell(info.title),
                     order_cell(info), info.stages, stability_cell(info, derived),
                     properties_cell(info, derived), cell(info.reference));
}

}  // namespace

std::string methods_page() {
  std::vector<std::string> families;
  for (const catalog::MethodEntry& entry : catalog::methods()) {
    if (std::find(families.begin(), families.end(), entry.info().family) == families.end()) {
      families.push_back(entry.info().family);
    }
  }
  std::string page;
  for (const std::string& family : families) {
    page +=
        fmt::format("\n### {}{}\n", static_cast<char>(std::toupper(static_cast<unsigned char>(family[0]))),
                    family.substr(1));
    std::string rows;
    std::vector<std::pair<std::string, std::string>> formulas;  // names of all schemes with this formula
    for (const catalog::MethodEntry& entry : catalog::methods()) {
      const MethodInfo& info = entry.info();
      if (info.family != family) continue;
      rows += row(entry);
      const auto known = std::find_if(formulas.begin(), formulas.end(),
                                      [&](const auto& pair) { return pair.second == info.formula; });
      if (known == formulas.end()) {
        formulas.emplace_back(fmt::format("`{}`", entry.name), info.formula);
      } else {
        known->first += fmt::format(", `{}`", entry.name);
      }
    }
    if (formulas.size() == 1) page += fmt::format("\n    {}\n", formulas.front().second);
    page +=
        "\n| name | scheme | order | evaluations | stability | properties | literature "
        "|\n|---|---|---|---|---|---|---|\n";
    page += rows;
    if (formulas.size() > 1) {
      page += "\nOne step:\n";
      for (const auto& [names, formula] : formulas) page += fmt::format("- {}: `{}`\n", names, formula);
    }
  }
  return page;
}

}  // namespace fw::app
