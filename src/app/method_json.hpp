#pragma once

#include "ode/integrator.hpp"
#include "text/json_writer.hpp"

namespace fw::app {

/// The keys from `order` to `l_stable` of a method, inside an object.
void write_method_properties(text::JsonWriter& json, const MethodInfo& info);

}  // namespace fw::app
