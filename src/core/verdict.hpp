#pragma once

#include <string_view>

namespace fw {

/// The outcome of a check against what theory predicts or a method claims.
enum class Verdict {
  holds,
  fails,
  not_applicable,  ///< nothing is predicted or claimed, or the question has no meaning here
};

/// "holds", "fails", "not applicable".
std::string_view to_string(Verdict verdict);

}  // namespace fw
