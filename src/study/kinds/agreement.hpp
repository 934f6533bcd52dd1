#pragma once

#include "study/plan.hpp"

namespace fw::study {

/// "agreement": all methods, own and foreign, on every problem, each refined until its own estimate of its
/// error is small; then every pair is compared. Two solutions agree where their difference is at most twice
/// the sum of their error estimates (and a level of rounding). A case is a problem.
StudyKind agreement_kind();

}  // namespace fw::study
