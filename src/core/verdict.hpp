#pragma once

#include <string_view>

namespace fw {

/// The outcome of a check against what theory predicts or a method claims.
enum class Verdict {
  holds,
  fails,
  not_applicable,  ///< the question has no meaning here, or cannot be decided: the reason says why
  done,            ///< computed to the end, and nothing was predicted or claimed
};

/// "holds", "fails", "not applicable", "done".
std::string_view to_string(Verdict verdict);

}  // namespace fw
