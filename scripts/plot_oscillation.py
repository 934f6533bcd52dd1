#!/usr/bin/env python3
"""Draws the motion of a single mass on a spring at several steps: position over time, and the plane of position and
velocity (the lecture's slide 10)."""

import sys

import plot_style  # first: it finds a Python with the libraries
import numpy
from plot_style import EXACT, label, new_figure
from simulated_cases import draw_exact, panels, series_label, style_of_steps

ROOM = 3.2  # axes reach this many times the exact amplitude


def amplitude(cases, axis):
    known = [numpy.abs(case["exact_state"][:, axis]).max() for case in cases if "exact_state" in case]
    return max(known) if known else numpy.abs(cases[0]["state"][0, axis]) or 1.0


def draw(result):
    """One figure: a line of two panels per problem and scheme."""
    groups, field = panels(result, state_size=2)
    figure, axes = new_figure(result, 15.5, 4.9 * len(groups) + 0.6, len(groups), 2,
                              gridspec_kw={"width_ratios": [1.75, 1]})
    for (left, right), ((problem, method), cases) in zip(axes, groups.items()):
        limits = [(-ROOM * amplitude(cases, axis), ROOM * amplitude(cases, axis)) for axis in (0, 1)]
        draw_exact(left, cases, lambda time, state: (time, state[:, 0]))
        draw_exact(right, cases, lambda time, state: (state[:, 0], state[:, 1]))
        for case, style in zip(cases, style_of_steps(cases)):
            state = case["state"]
            left.plot(case["time"], state[:, 0], **style, label=series_label(case, state[:, 0], limits[0]))
            right.plot(state[:, 0], state[:, 1], **style)
        right.plot(*cases[0]["state"][0], marker="o", color=EXACT, linestyle="none", markersize=7, zorder=5)
        left.axhline(0, color=EXACT, linewidth=0.6)
        left.set_ylim(limits[0])
        right.set_xlim(limits[0])
        right.set_ylim(limits[1])
        left.set_title(f"{method}: {problem}", loc="left")
        left.set_xlabel(label("time t", cases[0]["time_unit"]))
        left.set_ylabel("position x [m]")
        right.set_xlabel("position x [m]")
        right.set_ylabel("velocity v [m/s]")
        right.set_title("position and velocity", loc="left")
        right.legend(*left.get_legend_handles_labels(), loc="upper left", bbox_to_anchor=(1.02, 1.0), borderaxespad=0)
    return [figure]


if __name__ == "__main__":
    sys.exit(plot_style.main(__doc__, plot_style.expect_kind("simulate", draw)))
