#include "study/result.hpp"

namespace fw::study {

std::string_view to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::holds:
      return "holds";
    case Verdict::fails:
      return "fails";
    case Verdict::not_applicable:
      return "not applicable";
  }
  return "not applicable";
}

}  // namespace fw::study
