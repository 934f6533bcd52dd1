#!/usr/bin/env python3
"""Draws a study of stiffness: what an accuracy costs over decades of stiffness and where implicit methods begin to pay;
the stiffness measures of the spectrum; the observed order over step and stiffness."""

import sys

import plot_style  # first: it finds a Python with the libraries
import numpy
from matplotlib.colors import BoundaryNorm
from matplotlib.lines import Line2D
from plot_style import ALARM, PALETTE, QUIET, cell_edges, label, look, new_figure, number, parameter_label

CLASSES = {"explicit": "-", "exponential": ":", "implicit": (0, (5, 2))}
CHEAPEST = {"explicit": PALETTE[1], "implicit": PALETTE[0]}
ORDERS = numpy.arange(-0.5, 9.0, 1.0)   # colours of local orders: one per whole order
COLUMNS = 5


def short(call):
    return call.replace("implicit_euler_linearised", "linearised_euler").replace("linear_solver=", "")


def rows_of(result, problem, measure):
    return [row for row in result.summary() if row["problem"] == problem and row["measure"] == measure]


def axis_of(result, case):
    """The varied parameter as it is drawn: its size, and a label that names it."""
    values = result.values("parameter", case)
    name = plot_style_text(case["parameter"].attrs["name"])
    return numpy.abs(values), parameter_label(name, (values < 0).any())


def plot_style_text(value):
    return value.decode("utf-8") if isinstance(value, bytes) else str(value)


def draw_cost(result, problem):
    rows = [row for row in rows_of(result, problem, "cost")
            if numpy.isfinite(result.values("cost", result.case_of(row))).any()]
    overview = rows_of(result, problem, "overview")
    if not rows or not overview:
        return None
    whole = result.case_of(overview[0])
    figure, axes = new_figure(result, 15.5, 10.2, 2, 3, gridspec_kw={"width_ratios": [1, 1, 0.42]})
    steps, cost, seconds, spectrum = axes[0][0], axes[0][1], axes[1][1], axes[1][0]
    for index, row in enumerate(rows):
        case = result.case_of(row)
        stiffness, name = axis_of(result, case)
        style = look(index) | {"linestyle": CLASSES[row["stepping"]], "linewidth": 1.3, "markersize": 4.5}
        taken = result.values("accepted_steps", case) + result.values("rejected_steps", case)
        reached = numpy.isfinite(result.values("cost", case))
        steps.loglog(stiffness[reached], taken[reached], **style)
        for panel, column in ((cost, "cost"), (seconds, "seconds")):
            panel.loglog(stiffness, result.values(column, case), color="#CFCFCF", linewidth=0.9, zorder=1,
                         linestyle=CLASSES[row["stepping"]])
    stiffness, name = axis_of(result, whole)
    steps.loglog(stiffness, result.values("stiffness_index", whole) / 2, color=QUIET, linewidth=5, alpha=0.3)
    beside = max(0, stiffness.size - 2)
    steps.annotate("h|λ| = 2", (stiffness[beside], result.values("stiffness_index", whole)[beside] / 2), color=QUIET,
                   xytext=(8, -18), textcoords="offset points", fontsize=10)
    steps.set_title(f"{problem}: steps for the target error", loc="left")
    steps.set_ylabel("steps, accepted and rejected")
    for panel, column, what in ((cost, "cost", "cost [right-hand sides]"), (seconds, "seconds", label("wall-clock time", "s"))):
        for stepping, colour in CHEAPEST.items():
            curve = result.values(f"cheapest_{stepping}_{column}", whole)
            spread = result.values(f"cheapest_{stepping}_{column}_spread", whole)
            panel.fill_between(stiffness, curve / spread, curve * spread, color=colour, alpha=0.18, linewidth=0)
            panel.loglog(stiffness, curve, color=colour, linewidth=2.4, marker="o", markersize=4,
                         label=f"cheapest {stepping}")
        crossing, low, high = (overview[0][f"crossing_{column}{end}"] for end in ("", "_low", "_high"))
        if numpy.isfinite(crossing):
            panel.axvspan(low, high, color=ALARM, alpha=0.08, linewidth=0)
            panel.axvline(crossing, color=ALARM, linewidth=1.2)
            panel.annotate(f"implicit pays\nfrom {number(float(f'{crossing:.2g}'))}", (crossing, 0.03), rotation=90,
                           xycoords=("data", "axes fraction"), xytext=(-4, 0), textcoords="offset points", ha="right",
                           va="bottom", color=ALARM, fontsize=9.5)
        panel.set_ylabel(what)
        panel.legend(loc="upper left")
    cost.set_title("all methods (grey) and the cheapest of a class", loc="left")
    spectrum.loglog(stiffness, result.values("stiffness_index", whole), label="stiffness index max|λ|·T", **look(0))
    for column, text, index in (("eigenvalue_ratio", "max|λ| / min|λ|", 1), ("stiffness_ratio", "max|Re λ| / min|Re λ|", 2)):
        values = result.values(column, whole)
        if numpy.isfinite(values).any():
            spectrum.loglog(stiffness, values, label=text, **look(index))
    spectrum.set_title("stiffness of the Jacobian", loc="left")
    spectrum.set_ylabel("quotient")
    spectrum.legend(loc="upper left")
    for panel in (steps, cost, seconds, spectrum):
        panel.set_xlabel(name)
    handles = [Line2D([], [], label=short(row["method"]), linewidth=1.3, markersize=4.5,
                      **(look(k) | {"linestyle": CLASSES[row["stepping"]]})) for k, row in enumerate(rows)]
    axes[0][2].legend(handles=handles, loc="upper left", borderaxespad=0, fontsize=9)
    handles = [Line2D([], [], color="black", linestyle=line, label=name, linewidth=1.3)
               for name, line in CLASSES.items() if any(row["stepping"] == name for row in rows)]
    axes[1][2].legend(handles=handles, loc="upper left", borderaxespad=0, fontsize=9.5)
    for corner in (axes[0][2], axes[1][2]):
        corner.set_axis_off()
    return figure


def order_text(row):
    stiff = f"{row['stiff_order']:.2f}" if numpy.isfinite(row["stiff_order"]) else "–"
    if numpy.isfinite(row["predicted_stiff_order"]):
        stiff += f" ({row['predicted_stiff_order']:.0f})"
    plain = f"{row['nonstiff_order']:.2f}" if numpy.isfinite(row["nonstiff_order"]) else "–"
    return f"not stiff {plain} ({row['classical_order']}), stiff {stiff}"


def draw_orders(result, problem):
    rows = [row for row in rows_of(result, problem, "orders") if "local_order" in result.case_of(row)
            and min(result.values("local_order", result.case_of(row)).shape) > 0
            and result.values("step", result.case_of(row)).size > 1]  # an order needs two steps
    if not rows:
        return None
    lines = -(-len(rows) // COLUMNS)
    figure, axes = new_figure(result, 15.5, 2.75 * lines + 1.1, lines, COLUMNS, sharex=True, sharey=True)
    colours = plot_style.plt.get_cmap("viridis", ORDERS.size - 1)
    norm = BoundaryNorm(ORDERS, colours.N)
    for axis, row in zip(axes.ravel(), rows):
        case = result.case_of(row)
        steps, eigenvalues = result.values("step", case), result.values("largest_eigenvalue", case)
        order = numpy.ma.masked_invalid(result.values("local_order", case))
        rank = numpy.argsort(eigenvalues)
        # A local order belongs between its two steps; rows are as high as their distance on the axis.
        edges = numpy.concatenate(([steps[0]], steps))[1:]
        levels = numpy.exp(cell_edges(numpy.log(eigenvalues[rank]), 1.0))
        mesh = axis.pcolormesh(edges, levels, numpy.ma.clip(order[rank][:, 1:], -0.4, 8.4), cmap=colours, norm=norm)
        axis.set_xscale("log")
        axis.set_yscale("log")
        axis.plot(steps, 1 / steps, color="white", linewidth=2.6)
        axis.plot(steps, 1 / steps, color="black", linewidth=1.2, linestyle=(0, (4, 2)))
        axis.set_xlim(steps[-1], steps[0])
        axis.set_ylim(levels[0], levels[-1])
        axis.set_facecolor("#EEEEEE")
        axis.grid(False)
        axis.set_title(f"{short(row['method'])}\n{order_text(row)}", loc="left", fontsize=9)
    for axis in axes.ravel()[len(rows):]:
        axis.set_axis_off()
    for index, axis in enumerate(axes.ravel()[:len(rows)]):
        if index + COLUMNS >= len(rows):
            axis.set_xlabel(label("step h", "s"))
            axis.tick_params(labelbottom=True)
        if index % COLUMNS == 0:
            axis.set_ylabel(label("largest |λ|", "1/s"))
    bar = figure.colorbar(mesh, ax=axes, ticks=numpy.arange(0, 9), shrink=min(1.0, 2.0 / lines), pad=0.01)
    bar.set_label("order from step 2h to h\nbrackets: predicted, dashed: h|λ| = 1\ngrey: no error above rounding", labelpad=10, fontsize=10)
    return figure


def draw(result):
    problems = list(dict.fromkeys(row["problem"] for row in result.summary()))
    figures = [drawing(result, problem) for problem in problems for drawing in (draw_cost, draw_orders)]
    return [figure for figure in figures if figure is not None]


if __name__ == "__main__":
    sys.exit(plot_style.main(__doc__, plot_style.expect_kind("stiffness", draw)))
