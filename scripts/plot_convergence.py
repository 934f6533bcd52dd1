#!/usr/bin/env python3
"""Draws error over step of a convergence study: one row of panels per problem (or method), position and velocity.

Hollow points were left out of the fit. Dashed lines have the slope that theory predicts.
"""

import sys

import plot_style  # first: it finds a Python with the libraries
import numpy
from matplotlib.lines import Line2D
from plot_style import ALARM, QUIET, label, look, new_figure

ROWS_PER_FIGURE = 3
QUANTITIES = {"error_position": "position error", "error_velocity": "velocity error"}


def order_text(row):
    """ "order 2.00 [1.98, 2.02]", with the verdict unless it is the good one."""
    if not numpy.isfinite(row["order"]):
        fitted = "no order fitted"
    else:
        fitted = f"order {row['order']:.2f} [{row['order_low']:.2f}, {row['order_high']:.2f}]"
    return fitted if row["verdict"] == "holds" else f"{fitted}, {row['verdict']}"


def drawable(step, error):
    """Which points a logarithmic picture can show."""
    return numpy.isfinite(error) & (error > 0) & (step > 0)


def draw_series(axes, step, error, used, style):
    """One scheme's points, hollow where the fit left them out. Returns how many could not be drawn."""
    shown = drawable(step, error)
    order = numpy.argsort(step)
    order = order[shown[order]]
    axes.loglog(step[order], error[order], color=style["color"], linewidth=1.2, alpha=0.6)
    for chosen, face in ((shown & used, style["color"]), (shown & ~used, "white")):
        axes.loglog(step[chosen], error[chosen], linestyle="none", marker=style["marker"], color=style["color"],
                    markerfacecolor=face, markeredgewidth=1.3)
    return int(numpy.count_nonzero(~shown))


def draw_reference_slopes(axes, anchors, highest_step):
    """A dashed line for each predicted order, a little below the lowest series that claims it."""
    bottom, top = numpy.log10(axes.get_ylim())
    ends = []
    for order, (step, error) in anchors.items():
        at = step.argmax()
        ends.append((0.35 * error[at] * (highest_step / step[at]) ** order, order, step.min()))
    height = numpy.inf  # of the label above, as the labels must not cover each other
    for end, order, low in sorted(ends, reverse=True):
        axes.loglog([low, highest_step], [end * (low / highest_step) ** order, end], linestyle=(0, (5, 3)),
                    linewidth=1.1, color=QUIET, zorder=1)
        height = min((numpy.log10(end) - bottom) / (top - bottom), height - 0.06)
        axes.annotate(f"slope {order:g}", (1.0, height), xycoords="axes fraction", fontsize=9.5, color=QUIET,
                      va="center", annotation_clip=False)


def draw_panel(result, axes, quantity, rows):
    """All series of one panel."""
    missing, anchors, errors, steps = 0, {}, [], []
    for index, row in enumerate(rows):
        case = result.case_of(row)
        step, error = result.values("step", case), result.values(quantity, case)
        used = result.values("used", case).astype(bool)
        missing += draw_series(axes, step, error, used, look(index))
        fitted = used & drawable(step, error)
        expected = float(row["expected_order"])
        errors.append(error[drawable(step, error)])
        steps.append(step[drawable(step, error)])
        if expected > 0 and numpy.count_nonzero(fitted) > 1:
            anchor = (step[fitted], error[fitted])
            if expected not in anchors or anchor[1].max() < anchors[expected][1].max():
                anchors[expected] = anchor
    errors = numpy.concatenate(errors)
    if errors.size:
        axes.set_ylim(errors.min() / 3, errors.max() * 3)  # set by the data, not by the reference slopes
        draw_reference_slopes(axes, anchors, numpy.concatenate(steps).max())
    unit_step, unit_error = result.unit("step", case), result.unit(quantity, case)
    axes.set_xlabel(label("step h", unit_step))
    axes.set_ylabel(label(QUANTITIES.get(quantity, "error"), unit_error))
    if missing:
        axes.annotate(f"{missing} not shown: zero or not finite", (1.0, 0.0), xytext=(0, -50), ha="right",
                      xycoords="axes fraction", textcoords="offset points", fontsize=9.5, color=ALARM)


def draw_legend(axes, rows, name):
    handles = [Line2D([], [], **look(index), linewidth=1.2, label=f"{row[name]}: {order_text(row)}")
               for index, row in enumerate(rows)]
    handles.append(Line2D([], [], linestyle="none", marker="o", color=QUIET, markerfacecolor="white",
                          label="hollow: not in the fit"))
    axes.legend(handles=handles, loc="upper left", bbox_to_anchor=(1.13, 1.02), borderaxespad=0,
                title="fitted order with 95 % interval", alignment="left", title_fontsize=10.5)


def draw(result, by="problem"):
    """The figures of a convergence study, a row of panels per problem or per method."""
    summary = result.summary()
    other = "method" if by == "problem" else "problem"
    groups = {}
    for row in summary:
        groups.setdefault(row[by], []).append(row)
    names = list(groups)
    figures = []
    for first in range(0, len(names), ROWS_PER_FIGURE):
        page = names[first:first + ROWS_PER_FIGURE]
        both = all(quantity in result.case_of(row) for name in page for row in groups[name] for quantity in QUANTITIES)
        quantities = list(QUANTITIES) if both else ["error"]
        figure, axes = new_figure(result, 5.2 * len(quantities) + 4.4, 4.3 * len(page) + 0.7, len(page),
                                  len(quantities))
        for row_of_axes, name in zip(axes, page):
            for panel, quantity in zip(row_of_axes, quantities):
                draw_panel(result, panel, quantity, groups[name])
                panel.set_title(name, loc="left")
            draw_legend(row_of_axes[-1], groups[name], other)
        figures.append(figure)
    return figures


if __name__ == "__main__":
    sys.exit(plot_style.main(__doc__, plot_style.expect_kind("convergence", draw)))
