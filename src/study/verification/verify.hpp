#pragma once

#include "study/plan.hpp"

namespace fw::study {

/// The study kind "verify": every claimed property of every scheme against its coefficients and its running
/// code (see `analysis::verification_parts`). A case is a scheme; its columns are the properties with what is
/// claimed, derived and measured, a verdict and a reason.
StudyKind verify_kind();

}  // namespace fw::study
