#include "ode/dense_output.hpp"

#include "core/error.hpp"

namespace fw {

std::string to_string(DenseOutput dense_output) {
  switch (dense_output) {
    case DenseOutput::cubic_hermite:
      return "cubic Hermite polynomials";
    case DenseOutput::side_steps:
      return "side steps of the scheme";
    case DenseOutput::side_step_polynomial:
      return "polynomials through states of the scheme inside the step";
    case DenseOutput::library:
      return "the library's interpolant";
    case DenseOutput::side_runs:
      return "side runs of the library";
  }
  throw InputError("dense output: found a value outside the enumeration");
}

}  // namespace fw
