#pragma once

#include "problems/problem_entry.hpp"

namespace fw::problems {

/// Dahlquist's test equation ẏ = λy, y(0) = 1, in ℝ; parameter `lambda`.
Problem dahlquist(const ProblemParameters& given = {});
ProblemEntry dahlquist_entry();

/// Dahlquist's test equation with λ = α + iω as two real components (Re y, Im y); parameters `real`,
/// `imaginary`.
Problem dahlquist_complex(const ProblemParameters& given = {});
ProblemEntry dahlquist_complex_entry();

/// The rotation ẋ = (−x₂, x₁) of [Zachmann 2011, S13].
Problem rotation(const ProblemParameters& given = {});
ProblemEntry rotation_entry();

/// Rotation about a centre c(t) = a (cos Ωt, sin Ωt) that moves itself, ẋ = J (x − c(t)) with J = ((0, −1),
/// (1, 0)): a vector field in the plane that changes with time [Zachmann 2011, S14]. Parameters `radius` a,
/// `frequency` Ω ≠ 1.
Problem moving_centre(const ProblemParameters& given = {});
ProblemEntry moving_centre_entry();

/// Prothero and Robinson's ẏ = λ(y − φ(t)) + φ'(t), φ = cos t; parameter `lambda` < 0. It shows order
/// reduction.
Problem prothero_robinson(const ProblemParameters& given = {});
ProblemEntry prothero_robinson_entry();

}  // namespace fw::problems
