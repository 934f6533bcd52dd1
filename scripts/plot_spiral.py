#!/usr/bin/env python3
"""Draws numerical solutions of a plane equation at several steps in its state plane (the lecture's slide 13)."""

import sys

import plot_style  # first: it finds a Python with the libraries
import numpy
from plot_style import EXACT, QUIET, label, new_figure
from simulated_cases import draw_exact, field_limits, panels, series_label, style_of_steps


def draw_field(axes, field):
    """Arrows along the vector field; all of one length on paper, since only the direction is of interest."""
    speed = numpy.hypot(field["dydt"][:, 0], field["dydt"][:, 1])
    moving = speed > 0
    direction = field["dydt"][moving] / speed[moving, None]
    axes.quiver(field["y"][moving, 0], field["y"][moving, 1], direction[:, 0], direction[:, 1], angles="xy",
                pivot="mid", scale=34, width=0.003, color=QUIET, alpha=0.85, zorder=0)


def draw(result):
    """One figure: a panel per problem and scheme, in it a path per step."""
    groups, field = panels(result, state_size=2)
    columns = min(len(groups), 3)
    rows = -(-len(groups) // columns)
    figure, axes = new_figure(result, 6.8 * columns + 1.0, 5.6 * rows + 0.6, rows, columns)
    for panel in axes.flat[len(groups):]:
        panel.remove()
    for panel, ((problem, method), cases) in zip(axes.flat, groups.items()):
        limits = [field_limits([case["state"][:, axis] for case in cases],
                               None if field is None else field["y"][:, axis]) for axis in (0, 1)]
        if field is not None:
            draw_field(panel, field)
        for case, style in zip(cases, style_of_steps(cases)):
            path = case["state"]
            text = series_label(case, path[:, 0], limits[0], path[:, 1], limits[1])
            panel.plot(path[:, 0], path[:, 1], **style, label=text)
        draw_exact(panel, cases, lambda time, state: (state[:, 0], state[:, 1]))
        panel.plot(*cases[0]["state"][0], marker="o", color=EXACT, linestyle="none", markersize=7, zorder=5,
                   label="start")
        panel.set_xlim(limits[0])
        panel.set_ylim(limits[1])
        panel.set_aspect("equal", adjustable="box")
        panel.set_xlabel(label("$x_1$", cases[0]["state_unit"]))
        panel.set_ylabel(label("$x_2$", cases[0]["state_unit"]))
        panel.set_title(f"{method}: {problem}", loc="left")
        panel.grid(False)
        panel.legend(loc="upper left", bbox_to_anchor=(1.01, 1.02), borderaxespad=0)
    return [figure]


if __name__ == "__main__":
    sys.exit(plot_style.main(__doc__, plot_style.expect_kind("simulate", draw)))
