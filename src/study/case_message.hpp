#pragma once

#include <string>
#include <string_view>

#include "study/result.hpp"

namespace fw::study {

/// A case as bytes, to hand it from one process to another of the same program on the same machine, bit for
/// bit.
std::string encode(const CaseResult& result);

/// The case again. Throws std::runtime_error for bytes that `encode` cannot have made.
CaseResult decode(std::string_view bytes);

}  // namespace fw::study
