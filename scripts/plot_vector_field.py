#!/usr/bin/env python3
"""Draws a vector field in the plane that changes with time, at several times, and the solutions through it (the
lecture's slide 14)."""

import sys

import plot_style  # first: it finds a Python with the libraries
import numpy
from plot_spiral import draw_field
from plot_style import EXACT, QUIET, label, new_figure, number
from simulated_cases import field_limits, panels, style_of_steps


def draw(result):
    """A panel per time: the field then, and the way of each solution up to then."""
    groups, field = panels(result, state_size=2)
    if field is None:
        raise result.error("found no vector field, expected one at several times")
    times = numpy.unique(field["t"])
    columns = min(3, times.size)
    rows = -(-times.size // columns)
    figure, axes = new_figure(result, 5.2 * columns + 1.6, 5.2 * rows + 0.8, rows, columns, sharex=True, sharey=True)
    for panel in axes.flat[times.size:]:
        panel.remove()
    limits = [field_limits([], field["y"][:, axis]) for axis in (0, 1)]
    for index, (panel, now) in enumerate(zip(axes.flat, times)):
        chosen = field["t"] == now
        draw_field(panel, {name: array[chosen] for name, array in field.items()})
        for (problem, method), cases in groups.items():
            for case, style in zip(cases, style_of_steps(cases)):
                done = case["time"] <= now + 1e-9
                path = case["state"][done]
                panel.plot(path[:, 0], path[:, 1], color=style["color"], linewidth=1.8, zorder=3,
                           label=f"{problem}: {method}, h = {number(case['step'])} s")
                panel.plot(*path[-1], marker="o", color=style["color"], linestyle="none", markersize=8, zorder=4)
                if "exact_time" in case:
                    panel.plot(case["exact_state"][:, 0], case["exact_state"][:, 1], color=QUIET, linewidth=0.9,
                               zorder=2, label="exact, the whole way")
        panel.plot(*case["state"][0], marker="o", color=EXACT, linestyle="none", markersize=5, zorder=5, label="start")
        panel.set_xlim(limits[0])
        panel.set_ylim(limits[1])
        panel.set_aspect("equal", adjustable="box")
        panel.set_title(f"t = {number(now)} s", loc="left")
        panel.grid(False)
        if index % columns == 0:
            panel.set_ylabel(label("$x_2$", case["state_unit"]))
        if index + columns >= times.size:
            panel.set_xlabel(label("$x_1$", case["state_unit"]))
            panel.tick_params(labelbottom=True)
    handles, names = axes[0][columns - 1].get_legend_handles_labels()
    unique = dict(zip(names, handles))
    axes[0][columns - 1].legend(unique.values(), unique.keys(), loc="upper left", bbox_to_anchor=(1.02, 1.0),
                                borderaxespad=0)
    return [figure]


if __name__ == "__main__":
    sys.exit(plot_style.main(__doc__, plot_style.expect_kind("simulate", draw)))
