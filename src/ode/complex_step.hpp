#pragma once

#include <cstddef>
#include <vector>

#include "core/types.hpp"

namespace fw {

/// Derivatives of an analytic function by a complex step, Im f(y + i·h·w)/h with h = 1e-200: exact to
/// rounding, since nothing is subtracted [Squire, Trapp 1998].
///
/// `evaluate(y, f)` gets two vectors of complex numbers and fills the second, which has `rows` entries.
inline constexpr double complex_step = 1e-200;

/// Calls `sink(i, j, ∂f_i/∂y_j)` for all i and the columns j from `first` to `last` − 1, column by column. Each
/// costs an evaluation.
template <class Evaluate, class Sink>
void complex_step_jacobian(ConstVectorRef y, std::size_t rows, Index first, Index last, Evaluate evaluate,
                           Sink sink) {
  std::vector<Complex> state(y.data(), y.data() + y.size()), f(rows);
  for (Index j = first; j < last; ++j) {
    Complex& perturbed = state[static_cast<std::size_t>(j)];
    perturbed.imag(complex_step);
    evaluate(state, f);
    perturbed.imag(0.0);
    for (std::size_t i = 0; i < rows; ++i) sink(static_cast<Index>(i), j, f[i].imag() / complex_step);
  }
}

/// out = (∂f/∂y)·w by one evaluation.
template <class Evaluate>
void complex_step_product(ConstVectorRef y, ConstVectorRef w, Evaluate evaluate, VectorRef out) {
  std::vector<Complex> state(static_cast<std::size_t>(y.size())), f(static_cast<std::size_t>(out.size()));
  for (Index k = 0; k < y.size(); ++k) state[static_cast<std::size_t>(k)] = {y[k], complex_step * w[k]};
  evaluate(state, f);
  for (Index i = 0; i < out.size(); ++i) out[i] = f[static_cast<std::size_t>(i)].imag() / complex_step;
}

}  // namespace fw
