#!/usr/bin/env python3
"""Draws the picture that fits each result file, by its kind."""

import importlib
import importlib.util
import sys

import plot_style  # first: it finds a Python with the libraries
import numpy
import plot_construction
import plot_oscillation
import plot_simulated_energy
import plot_slope_field
import plot_spiral
import plot_vector_field
from simulated_cases import read_field


def draw_simulated(result):
    """For a scalar equation the construction of steps if the file has it, else curves over time; for two unknowns the
    field at several times if the file has it, the motion of a mass, or paths in the plane; for more the energies."""
    cases = [group for group in result.cases().values() if "state" in group]
    sizes = {group["state"].shape[1] if group["state"].ndim > 1 else 1 for group in cases}
    if sizes == {1}:
        return plot_construction.draw if all("construction_slope" in group for group in cases) else plot_slope_field.draw
    if sizes != {2}:
        has_energies = cases and all("total_energy" in group for group in cases)
        return plot_simulated_energy.draw if has_energies else None
    field = read_field(result)
    if field is not None and numpy.unique(field["t"]).size > 1:
        return plot_vector_field.draw
    moves = all("second_order" in group and result.fact("second_order", group) for group in cases)
    return plot_oscillation.draw if moves and field is None else plot_spiral.draw


def choose_drawing(result):
    if result.kind == "simulate":
        return draw_simulated(result)
    module = f"plot_{result.kind}"  # a kind of study has a script of its name
    return importlib.import_module(module).draw if importlib.util.find_spec(module) else None


if __name__ == "__main__":
    sys.exit(plot_style.main(__doc__, choose_drawing))
