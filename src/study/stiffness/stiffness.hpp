#pragma once

#include "study/plan.hpp"

namespace fw::study {

/// "stiffness": what a given accuracy costs over decades of stiffness with explicit and implicit methods, and
/// where implicit ones begin to pay; the stiffness measures of the spectrum; the observed order over step and
/// stiffness (order reduction). A case is a family of problems and a method, once for the cost and once for
/// the orders, or a family's overview. See docs/studies/stiffness.md.
StudyKind stiffness_kind();

}  // namespace fw::study
