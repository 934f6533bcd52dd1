#include "catalog/oracle_methods.hpp"

namespace fw::catalog {

std::vector<MethodEntry> petsc_methods() {
  return {};
}

}  // namespace fw::catalog
