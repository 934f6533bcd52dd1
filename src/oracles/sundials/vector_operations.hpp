#pragma once

namespace fw::oracles {

/// Whose vector operations SUNDIALS uses in a run.
enum class VectorOperations {
  eigen,   ///< ours, over Eigen maps: compiled with the optimisation and for the processor of this program
  serial,  ///< SUNDIALS' own serial vector as the system's library has it
};

}  // namespace fw::oracles
