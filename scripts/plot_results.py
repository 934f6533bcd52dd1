#!/usr/bin/env python3
"""Draws the picture that fits each result file, by its kind."""

import importlib
import importlib.util
import sys

import plot_style  # first: it finds a Python with the libraries
import plot_slope_field
import plot_spiral


def draw_simulated(result):
    """Curves over time for a scalar equation, paths for a plane one, nothing for larger systems."""
    sizes = {group["state"].shape[1] if group["state"].ndim > 1 else 1 for group in result.cases().values()
             if "state" in group}
    return {(1,): plot_slope_field.draw, (2,): plot_spiral.draw}.get(tuple(sizes))


def choose_drawing(result):
    if result.kind == "simulate":
        return draw_simulated(result)
    module = f"plot_{result.kind}"  # a kind of study has a script of its name
    return importlib.import_module(module).draw if importlib.util.find_spec(module) else None


if __name__ == "__main__":
    sys.exit(plot_style.main(__doc__, choose_drawing))
