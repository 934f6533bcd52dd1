#!/usr/bin/env python3
"""Draws the matrix of an agreement study, one figure per problem: below the diagonal the difference of two methods,
above it the share of what their error estimates allow. Pairs that disagree are marked."""

import sys

import plot_style  # first: it finds a Python with the libraries
import numpy
from matplotlib.colors import LogNorm, Normalize
from matplotlib.patches import Rectangle
from plot_style import ALARM, QUIET, new_figure

INCHES_PER_METHOD = 0.115
SMALLEST_SIDE = 6.0


def family_blocks(families):
    """First and one past the last row of each run of equal families."""
    edges = [0] + [k for k in range(1, len(families)) if families[k] != families[k - 1]] + [len(families)]
    return list(zip(edges[:-1], edges[1:]))


def draw_matrix(figure, axes, case, result):
    methods = result.values("method", case)
    families = result.values("family", case)
    difference = result.values("difference", case)
    expected = result.values("expected_difference", case)
    agrees = result.values("agrees", case)
    count = len(methods)
    compared = agrees >= 0
    below = numpy.tril(numpy.ones((count, count), bool), -1)
    visible = difference[compared & below & (difference > 0)]
    smallest = max(visible.min(), 1e-16) if visible.size else 1e-16
    largest = visible.max() if visible.size else 1.0

    lower = numpy.where(compared & below, numpy.maximum(difference, smallest), numpy.nan)
    with numpy.errstate(divide="ignore", invalid="ignore"):
        share = numpy.where(compared & below.T, difference / expected, numpy.nan)
    sizes = axes.imshow(lower, cmap="viridis", norm=LogNorm(smallest, largest), interpolation="nearest")
    shares = axes.imshow(share, cmap="cividis_r", norm=Normalize(0, 1), interpolation="nearest")
    for i, j in zip(*numpy.nonzero(agrees == 0)):
        axes.add_patch(Rectangle((j - 0.5, i - 0.5), 1, 1, facecolor=ALARM, edgecolor="white", linewidth=0.3))
    for first, end in family_blocks(families)[:-1]:
        axes.axhline(end - 0.5, color="white", linewidth=0.8)
        axes.axvline(end - 0.5, color="white", linewidth=0.8)
    size = 5.6 if count > 40 else 9
    axes.set_yticks(range(count), methods, fontsize=size)
    axes.set_xticks(range(count), methods, fontsize=size, rotation=90)
    axes.tick_params(length=0)
    axes.grid(False)
    for side in axes.spines.values():
        side.set_visible(False)
    figure.colorbar(sizes, ax=axes, location="right", shrink=0.45, pad=0.01,
                    label="below the diagonal: relative difference of the end states")
    figure.colorbar(shares, ax=axes, location="right", shrink=0.45, pad=0.02,
                    label="above: difference / what both error estimates allow")
    return int(numpy.count_nonzero(agrees[below] == 0))


def draw(result):
    """One figure per problem."""
    figures = []
    for row in result.summary():
        case = result.case_of(row)
        if "difference" not in case:
            continue
        count = len(result.values("method", case))
        side = max(SMALLEST_SIDE, INCHES_PER_METHOD * count)
        figure, axes = new_figure(result, side + 5.0, side + 2.2)
        panel = axes[0][0]
        disagreeing = draw_matrix(figure, panel, case, result)
        panel.set_title(f"{row['problem']}: {row['methods']:.0f} solutions compared, {row['pairs']:.0f} pairs, "
                        f"{disagreeing} disagree", loc="left", color=ALARM if disagreeing else "black")
        if row["not_accurate"]:
            panel.set_xlabel(f"blank rows and columns: {row['not_accurate']:.0f} methods whose own error estimate "
                             "stays too large to compare", color=QUIET)
        figures.append(figure)
    return figures


if __name__ == "__main__":
    sys.exit(plot_style.main(__doc__, plot_style.expect_kind("agreement", draw)))
