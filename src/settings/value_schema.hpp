#pragma once

#include "settings/json_schema.hpp"
#include "text/json_writer.hpp"

namespace fw::settings {

/// Writes what a JSON schema says of one setting into the object that is open: description, unit, type,
/// range and default.
void write_value_schema(const SettingDescription& setting, const SchemaContext& context,
                        text::JsonWriter& json);

}  // namespace fw::settings
