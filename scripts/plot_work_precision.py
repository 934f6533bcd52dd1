#!/usr/bin/env python3
"""Draws a work-precision study: for every problem the error over right-hand sides, over seconds and, where methods
solve equations, over factorisations. Coloured are the methods on a Pareto front, all others are grey."""

import sys
import textwrap

import plot_style  # first: it finds a Python with the libraries
import numpy
from matplotlib.lines import Line2D
from plot_style import QUIET, label, look, new_figure

MEASURES = {"rhs_evaluations": "right-hand sides", "seconds": "wall-clock time", "factorisations": "factorisations"}
FRONT_MEASURES = ("rhs_evaluations", "seconds")
PALE = "#C4C4C4"
CONTROLS = {"fixed": {"linestyle": "-"}, "adaptive": {"linestyle": (0, (4, 2)), "markerfacecolor": "white"}}


def short(call):
    """A method's call without the word that all options of its kind share."""
    return call.replace("implicit_euler_linearised", "linearised_euler").replace("linear_solver=", "")


def ladders_of(result, problem):
    """The rows of a problem's ladders that have points, without its front."""
    return [row for row in result.summary() if row["problem"] == problem and row["control"]
            and result.values("error", result.case_of(row)).size]


def front_of(result, problem):
    rows = [row for row in result.summary() if row["problem"] == problem and not row["control"]]
    return result.case_of(rows[0]) if rows else None


def coloured(ladders):
    """Methods with a point on a front, those with most points first."""
    points = {}
    for row in ladders:
        points[row["method"]] = points.get(row["method"], 0) + sum(row[f"front_points_{name}"]
                                                                   for name in FRONT_MEASURES)
    return [method for method, count in sorted(points.items(), key=lambda entry: -entry[1]) if count > 0]


def draw_panel(axes, result, measure, ladders, chosen, front):
    for row in ladders:
        case = result.case_of(row)
        work, error = result.values(measure, case).astype(float), result.values("error", case)
        drawn = (work > 0) & (error > 0)
        if not drawn.any():
            continue
        style = dict(CONTROLS[row["control"]])
        if row["method"] in chosen:
            style |= look(chosen.index(row["method"])) | {"linewidth": 1.5, "markersize": 5, "zorder": 3}
        else:
            style |= {"color": PALE, "linewidth": 1.0, "zorder": 1}
        axes.loglog(work[drawn], error[drawn], **style)
    if front is not None and f"front_{measure}" in front:
        work, error = result.values(f"front_{measure}", front), result.values(f"front_{measure}_error", front)
        if work.size:
            axes.step(work, error, where="post", color=QUIET, linewidth=7, alpha=0.22, zorder=2, solid_capstyle="round")
    unit = result.unit(measure, result.case_of(ladders[0]))
    axes.set_xlabel(label(MEASURES[measure], unit))


def draw_problem(result, problem):
    ladders, front = ladders_of(result, problem), front_of(result, problem)
    if not ladders:
        return None
    # One factorisation of a constant matrix is no axis.
    has_equations = any((result.values("factorisations", result.case_of(row)) > 20).any() for row in ladders)
    measures = [measure for measure in MEASURES if measure != "factorisations" or has_equations]
    figure, axes = new_figure(result, 15.5, 6.6, 1, len(measures) + 1,
                              gridspec_kw={"width_ratios": [1] * len(measures) + [0.62 if has_equations else 0.45]})
    chosen = coloured(ladders)
    for panel, measure in zip(axes[0], measures):
        draw_panel(panel, result, measure, ladders, chosen, front)
        panel.sharey(axes[0][0])
    axes[0][0].set_ylabel("relative error at the end")
    axes[0][0].set_title(problem, loc="left")
    legend = axes[0][-1]
    legend.set_axis_off()
    handles = [Line2D([], [], label=short(method), linewidth=1.5, markersize=5, **look(k))
               for k, method in enumerate(chosen)]
    controls = {row["control"] for row in ladders}
    handles += [Line2D([], [], color="black", marker="o", markersize=5, linewidth=1.2, label=text, **CONTROLS[control])
                for control, text in (("fixed", "constant steps"), ("adaptive", "steps from tolerances"))
                if control in controls]
    handles += [Line2D([], [], color=QUIET, linewidth=7, alpha=0.22, label="Pareto front"),
                Line2D([], [], color=PALE, linewidth=1.0, label="not on a front:")]
    legend.legend(handles=handles, loc="upper left", borderaxespad=0, fontsize=9.5)
    others = [short(method) for method in dict.fromkeys(row["method"] for row in ladders) if method not in chosen]
    legend.text(0.02, 0.0, "\n".join(textwrap.wrap(", ".join(others), 34)), transform=legend.transAxes, fontsize=8.2,
                color=QUIET, va="bottom")
    return figure


def draw(result):
    problems = list(dict.fromkeys(row["problem"] for row in result.summary()))
    return [figure for figure in (draw_problem(result, problem) for problem in problems) if figure is not None]


if __name__ == "__main__":
    sys.exit(plot_style.main(__doc__, plot_style.expect_kind("work_precision", draw)))
