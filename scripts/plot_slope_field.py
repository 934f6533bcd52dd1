#!/usr/bin/env python3
"""Draws numerical solutions of a scalar equation at several steps over its slope field (the lecture's slide 12)."""

import sys

import plot_style  # first: it finds a Python with the libraries
import numpy
from plot_style import EXACT, QUIET, label, new_figure
from simulated_cases import draw_exact, field_limits, panels, series_label, style_of_steps


def draw_field(axes, field):
    """Short strokes with the slope of the solution through each point, all of the same length on paper."""
    time, state, slope = field["t"], field["y"][:, 0], field["dydt"][:, 0]
    length = numpy.hypot(1.0, slope)
    axes.quiver(time, state, 1.0 / length, slope / length, angles="xy", pivot="mid", headwidth=0, headlength=0,
                headaxislength=0, scale=45, width=0.0016, color=QUIET, alpha=0.75, zorder=0)


def draw(result):
    """One figure: a panel per problem and scheme, in it a curve per step."""
    groups, field = panels(result, state_size=1)
    columns = min(len(groups), 3)
    rows = -(-len(groups) // columns)
    figure, axes = new_figure(result, 6.6 * columns + 1.6, 5.0 * rows + 0.6, rows, columns)
    for panel in axes.flat[len(groups):]:
        panel.remove()
    for panel, ((problem, method), cases) in zip(axes.flat, groups.items()):
        states = [case["state"][:, 0] for case in cases]
        limits = field_limits(states, None if field is None else field["y"][:, 0])
        if field is not None:
            draw_field(panel, field)
        draw_exact(panel, cases, lambda time, state: (time, state[:, 0]))
        for case, style in zip(cases, style_of_steps(cases)):
            time, state = case["time"], case["state"][:, 0]
            panel.plot(time, state, **style, label=series_label(case, state, limits))
        panel.set_ylim(limits)
        panel.set_xlabel(label("time t", cases[0]["time_unit"]))
        panel.set_ylabel(label("state x", cases[0]["state_unit"]))
        panel.set_title(f"{method}: {problem}", loc="left")
        panel.grid(False)
        panel.axhline(0, color=EXACT, linewidth=0.6)
        panel.legend(loc="upper left", bbox_to_anchor=(1.01, 1.02), borderaxespad=0)
    return [figure]


if __name__ == "__main__":
    sys.exit(plot_style.main(__doc__, plot_style.expect_kind("simulate", draw)))
