#include "core/verdict.hpp"

namespace fw {

std::string_view to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::holds:
      return "holds";
    case Verdict::fails:
      return "fails";
    case Verdict::done:
      return "done";
    case Verdict::not_applicable:
      break;
  }
  return "not applicable";
}

}  // namespace fw
