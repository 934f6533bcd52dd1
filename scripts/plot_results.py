#!/usr/bin/env python3
"""Draws the picture that fits each result file, by its kind."""

import sys

import plot_style  # first: it finds a Python with the libraries
import plot_agreement
import plot_convergence
import plot_linear_solver
import plot_slope_field
import plot_spiral
import plot_trajectory


def draw_simulated(result):
    """Curves over time for a scalar equation, paths for a plane one, nothing for larger systems."""
    sizes = {group["state"].shape[1] if group["state"].ndim > 1 else 1 for group in result.cases().values()
             if "state" in group}
    return {(1,): plot_slope_field.draw, (2,): plot_spiral.draw}.get(tuple(sizes))


def choose_drawing(result):
    if result.kind == "simulate":
        return draw_simulated(result)
    return {"agreement": plot_agreement.draw, "convergence": plot_convergence.draw,
            "linear_solver": plot_linear_solver.draw, "trajectory": plot_trajectory.draw}.get(result.kind)


if __name__ == "__main__":
    sys.exit(plot_style.main(__doc__, choose_drawing))
