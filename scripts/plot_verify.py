#!/usr/bin/env python3
"""Draws a verification: one square per scheme and property, blue where the running code keeps what is claimed, red with a
cross where it does not, a grey dot where the property does not apply."""

import sys

import plot_style  # first: it finds a Python with the libraries
import numpy
from matplotlib.colors import ListedColormap
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from plot_style import ALARM, PALETTE, QUIET, new_figure

HOLDS, FAILS, APART = 1.0, 2.0, numpy.nan
MOST_ROWS = 55  # schemes in a panel: more would not be readable on a page


def matrix(result):
    """Schemes and properties in their order of appearance, and the verdicts as (schemes, properties); a property that
    is reported twice of a scheme counts as the worse of the two."""
    rows = result.summary()
    methods = [row["method"] for row in rows]
    properties, verdicts = [], []
    for row in rows:
        case = result.case_of(row)
        names, words = result.values("property", case), result.values("verdict", case)
        verdicts.append({})
        for name, word in zip(names, words):
            if name not in properties:
                # Beside its neighbour in this scheme, not at the end: order with order, stability with stability.
                known = [other for other in list(names)[:list(names).index(name)] if other in properties]
                properties.insert(properties.index(known[-1]) + 1 if known else 0, name)
            value = {"holds": HOLDS, "fails": FAILS}.get(word, APART)
            verdicts[-1][name] = numpy.fmax(verdicts[-1].get(name, APART), value)
    values = numpy.array([[found.get(name, APART) for name in properties] for found in verdicts])
    return methods, properties, values


def draw_panel(panel, methods, properties, values):
    panel.imshow(values, cmap=ListedColormap([PALETTE[0], ALARM]), vmin=0.5, vmax=2.5, aspect="auto", interpolation="none")
    panel.set_xticks(range(len(properties)), properties, rotation=90, fontsize=8)
    panel.xaxis.tick_top()
    panel.set_yticks(range(len(methods)), methods, fontsize=7.5)
    panel.set_xticks(numpy.arange(-0.5, len(properties)), minor=True)
    panel.set_yticks(numpy.arange(-0.5, len(methods)), minor=True)
    panel.grid(False)
    panel.grid(which="minor", color="white", linewidth=1.2)
    panel.tick_params(which="both", length=0)
    for spine in panel.spines.values():
        spine.set_visible(False)
    row, column = numpy.nonzero(numpy.isnan(values))
    panel.plot(column, row, linestyle="none", marker=".", markersize=1.8, color=QUIET)
    row, column = numpy.nonzero(values == FAILS)
    panel.plot(column, row, linestyle="none", marker="x", markersize=5, color="white", markeredgewidth=1.3)
    for index in set(row):
        panel.get_yticklabels()[index].set_color(ALARM)


def draw(result):
    methods, properties, values = matrix(result)
    panels = -(-len(methods) // MOST_ROWS)
    rows = -(-len(methods) // panels)
    figure, axes = new_figure(result, 8.0 * panels, 0.185 * rows + 3.6, 1, panels)
    for index, panel in enumerate(axes[0]):
        part = slice(index * rows, (index + 1) * rows)
        draw_panel(panel, methods[part], properties, values[part])
    counts = [int((values == value).sum()) for value in (HOLDS, FAILS)]
    axes[0][0].legend(handles=[Patch(color=PALETTE[0], label=f"holds ({counts[0]})"),
                               Patch(color=ALARM, label=f"fails ({counts[1]})"),
                               Line2D([], [], linestyle="none", marker=".", color=QUIET, label="not applicable")],
                      loc="upper left", bbox_to_anchor=(0, -0.005), ncol=3, borderaxespad=0)
    return [figure]


if __name__ == "__main__":
    sys.exit(plot_style.main(__doc__, plot_style.expect_kind("verify", draw)))
