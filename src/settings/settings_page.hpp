#pragma once

#include <string>

#include "settings/description.hpp"

namespace fw::settings {

/// The settings of a section, without those of the sections in it, as a table in Markdown: key, type,
/// default, meaning, and what form of the section they are for where it has forms. `heading` is that of the
/// keys.
std::string markdown_table(const SectionDescription& section, const std::string& heading);

}  // namespace fw::settings
