#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "settings/description.hpp"

namespace fw::settings {

/// What a schema needs to know beside the description.
struct SchemaContext {
  std::string title;
  /// Names that strings may have, by what they name ("methods"); calls with options in brackets and patterns
  /// with * are allowed beside them.
  std::map<std::string, std::vector<std::string>> names{};
  /// The kinds of study that a free section may hold.
  std::vector<std::pair<std::string, SectionDescription>> kinds{};
};

/// The description as a JSON schema (draft 2020-12), with which editors complete and check a TOML file. What
/// one value demands of another, and that numbers are finite, only the program checks.
std::string json_schema(const SectionDescription& description, const SchemaContext& context);

}  // namespace fw::settings
