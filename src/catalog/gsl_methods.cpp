#include "catalog/oracle_methods.hpp"

namespace fw::catalog {

std::vector<MethodEntry> gsl_methods() {
  return {};
}

}  // namespace fw::catalog
