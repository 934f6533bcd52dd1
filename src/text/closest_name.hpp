#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fw {

/// The least number of insertions, deletions, substitutions and swaps of neighbouring bytes that turn `a`
/// into `b`, no byte being edited twice (optimal string alignment distance).
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The candidate that `name` is most likely a misspelling of: smallest edit distance, the first of equals,
/// letter case not counted. None if even the best needs more edits than a third of the longer name (at least
/// one edit is always allowed where a name has more than two letters).
std::optional<std::string> closest_name(std::string_view name, const std::vector<std::string>& candidates);

/// `; did you mean "stiffness"?`, or nothing if no candidate is close.
std::string did_you_mean(std::string_view name, const std::vector<std::string>& candidates);

}  // namespace fw
