#pragma once

#include <string>
#include <vector>

namespace fw::oracles {

/// The names of ARKODE's own tables, "dormand_prince_7_4_5" (stages, order of the embedding, order), and of
/// MRIStep's explicit couplings.
std::vector<std::string> arkode_explicit_tables();
std::vector<std::string> arkode_diagonally_implicit_tables();
std::vector<std::string> arkode_additive_tables();
std::vector<std::string> arkode_couplings();

}  // namespace fw::oracles
