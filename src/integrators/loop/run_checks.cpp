#include "integrators/loop/run_checks.hpp"

#include <fmt/format.h>

namespace fw::integrators {

namespace {

/// No physical state comes near this; one that does has left the scheme's region of stability.
constexpr double blow_up_bound = 1e100;

}  // namespace

Status check_state(ConstVectorRef y, double t, std::uint64_t step) {
  if (!y.allFinite()) {
    return {StatusCode::non_finite,
            fmt::format("the state is not finite after step {} at t = {:.6g}", step, t)};
  }
  if (y.lpNorm<Eigen::Infinity>() > blow_up_bound) {
    return {StatusCode::blow_up,
            fmt::format("the state exceeds {:g} after step {} at t = {:.6g}", blow_up_bound, step, t)};
  }
  return {};
}

}  // namespace fw::integrators
