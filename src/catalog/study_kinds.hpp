#pragma once

#include <vector>

#include "study/plan.hpp"

namespace fw::catalog {

/// Every kind of study. The only place where one is registered.
const std::vector<study::StudyKind>& study_kinds();

}  // namespace fw::catalog
