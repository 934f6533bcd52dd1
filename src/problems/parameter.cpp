#include "problems/parameter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"

namespace fw::problems {

Parameter::Parameter(double value) : binary_(value), decimal_(fmt::format("{}", value)) {}

ParameterSet::ParameterSet(const ProblemEntry& entry, const ProblemParameters& given)
    : problem_(entry.name), values_(entry.defaults) {
  for (const auto& [name, value] : given) {
    const auto known = values_.find(name);
    if (known == values_.end()) {
      std::string names;
      for (const auto& [allowed, unused] : entry.defaults) names += (names.empty() ? "" : ", ") + allowed;
      throw InputError(fmt::format("problem \"{}\": unknown parameter \"{}\"; it has {}", problem_, name,
                                   names.empty() ? "no parameters" : "the parameters " + names));
    }
    known->second = value;
    if (!std::isfinite(value)) reject(name, "a finite number");
  }
}

void ParameterSet::reject(const std::string& name, const std::string& expected) const {
  throw InputError(fmt::format("problem \"{}\": parameter \"{}\" is {}, expected {}", problem_, name,
                               values_.at(name), expected));
}

Parameter ParameterSet::operator[](const std::string& name) const {
  return Parameter(values_.at(name));
}

Parameter ParameterSet::positive(const std::string& name) const {
  if (!(values_.at(name) > 0.0)) reject(name, "a number > 0");
  return (*this)[name];
}

Parameter ParameterSet::non_negative(const std::string& name) const {
  if (!(values_.at(name) >= 0.0)) reject(name, "a number >= 0");
  return (*this)[name];
}

int ParameterSet::whole(const std::string& name, int least, int largest) const {
  const double value = values_.at(name);
  if (value != std::floor(value) || value < least || value > largest) {
    reject(name, fmt::format("a whole number from {} to {}", least, largest));
  }
  return static_cast<int>(value);
}

std::string ParameterSet::text() const {
  std::string text;
  for (const auto& [name, value] : values_) {
    text += fmt::format("{}{}={}", text.empty() ? "" : ", ", name, value);
  }
  return text;
}

void set_initial_state(Ivp& ivp, const std::vector<Float128>& state) {
  ivp.y0.resize(static_cast<Index>(state.size()));
  bool rounded = false;
  for (std::size_t i = 0; i < state.size(); ++i) {
    const auto value = static_cast<double>(state[i]);
    ivp.y0[static_cast<Index>(i)] = value;
    rounded = rounded || Float128(value) != state[i];
  }
  ivp.y0_extended = rounded ? state : std::vector<Float128>{};
}

}  // namespace fw::problems
