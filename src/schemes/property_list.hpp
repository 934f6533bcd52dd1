#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "schemes/derived_properties.hpp"

namespace fw::schemes {

/// One derived property under its name in JSON and its label for people.
struct NamedProperty {
  std::string key;
  std::string label;
  std::variant<bool, std::int64_t, double, std::string> value;
};

/// Every property that the scheme has, in the order in which they are read.
std::vector<NamedProperty> property_list(const DerivedProperties& properties);

/// The value for people: "yes", "4", "2.785", "infinite".
std::string to_text(const NamedProperty& property);

/// R(z) in formula, for example "(1 + z/2)/(1 - z/2)", with coefficients as fractions where these are simple.
std::string to_text(const StabilityFunction& R);

/// The coefficients as a table of text, as they are written in the source; empty where there are none.
std::string coefficients_text(const SchemeData& data);

}  // namespace fw::schemes
