#pragma once

#include <sundials/sundials_nvector.h>

namespace fw::oracles::detail {

/// Fills in the arithmetic of a vector over a plain array: the standard operations and local reductions.
void set_standard_operations(_generic_N_Vector_Ops& table);

/// Replaces the weighted root mean squares by those of the particle that has the largest.
void set_norm_of_particles(_generic_N_Vector_Ops& table);

/// Fills in the fused and vector-array operations.
void set_fused_operations(_generic_N_Vector_Ops& table);

}  // namespace fw::oracles::detail
