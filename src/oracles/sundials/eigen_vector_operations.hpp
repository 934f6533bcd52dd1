#pragma once

#include <sundials/sundials_nvector.h>

namespace fw::oracles::detail {

/// Fills in the arithmetic of a vector over a plain array: the standard operations and local reductions.
void set_standard_operations(_generic_N_Vector_Ops& table);

/// Fills in the fused and vector-array operations.
void set_fused_operations(_generic_N_Vector_Ops& table);

}  // namespace fw::oracles::detail
