#include "schemes/scheme_data.hpp"

namespace fw::schemes {

std::optional<NystromValues<Float128>> nystrom_values(const SchemeData& data) {
  if (const auto* nystrom = std::get_if<NystromTableau>(&data)) return values<Float128>(*nystrom);
  if (const auto* splitting = std::get_if<SplittingScheme>(&data)) return as_nystrom(*splitting);
  return std::nullopt;
}

}  // namespace fw::schemes
