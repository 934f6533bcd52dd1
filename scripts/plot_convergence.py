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
WIDEST_LEGEND = 66  # characters on one line
MECHANICAL = {"error_position": "position error", "error_velocity": "velocity error"}
QUANTITIES = {**MECHANICAL, "error": "error"}


def order_text(row, suffixes):
    """ "order 2.00 [1.98, 2.02]", with the verdict unless it is the good one; for the orders of position and velocity
    "order x 2.00 [1.98, 2.02], v 2.00 [1.98, 2.02]"."""
    parts = []
    for name, suffix in suffixes.items():
        order, low, high = (row[f"order{end}{suffix}"] for end in ("", "_low", "_high"))
        fitted = f"{order:.2f} [{low:.2f}, {high:.2f}]" if numpy.isfinite(order) else "not fitted"
        parts.append(f"{name} {fitted}".strip())
    fitted = "order " + ", ".join(parts)
    return fitted if row["verdict"] == "holds" else f"{fitted}: {row['verdict']}"


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


def draw_reference_slopes(axes, anchors):
    """A dashed line for each predicted order, a little below the lowest series that claims it."""
    for order, (step, error) in sorted(anchors.items()):
        low, high = step.min(), step.max()
        end = 0.35 * error[step.argmax()]
        start = end * (low / high) ** order
        axes.loglog([low, high], [start, end], linestyle=(0, (5, 3)), linewidth=1.1, color=QUIET, zorder=1)
        # At the lower ends, since there lines of different slope lie furthest apart.
        axes.annotate(f"slope {order:g}", (low, start), xytext=(6, -1), textcoords="offset points", fontsize=9.5,
                      color=QUIET, va="top", zorder=1.5)


def draw_panel(result, axes, quantity, rows):
    """All series of one panel."""
    missing, anchors, errors = 0, {}, []
    for index, row in enumerate(rows):
        case = result.case_of(row)
        step, error = result.values("step", case), result.values(quantity, case)
        flags = quantity.replace("error", "used")  # each quantity has its own fit where the file tells
        used = result.values(flags if flags in case else "used", case).astype(bool)
        missing += draw_series(axes, step, error, used, look(index))
        fitted = used & drawable(step, error)
        expected = float(row["expected_order"])
        errors.append(error[drawable(step, error)])
        if expected > 0 and numpy.count_nonzero(fitted) > 1:
            anchor = (step[fitted], error[fitted])
            if expected not in anchors or anchor[1].max() < anchors[expected][1].max():
                anchors[expected] = anchor
    errors = numpy.concatenate(errors)
    if errors.size:
        axes.set_ylim(errors.min() / 12, errors.max() * 3)  # set by the data, with room for a label below
        draw_reference_slopes(axes, anchors)
    unit_step, unit_error = result.unit("step", case), result.unit(quantity, case)
    axes.set_xlabel(label("step h", unit_step))
    axes.set_ylabel(label(QUANTITIES[quantity], unit_error))
    if missing:
        axes.annotate(f"{missing} not shown: zero or not finite", (1.0, 0.0), xytext=(0, -50), ha="right",
                      xycoords="axes fraction", textcoords="offset points", fontsize=9.5, color=ALARM)


def draw_legend(axes, rows, name, quantities):
    mechanical = len(quantities) == 2 and all("order_position" in row for row in rows)
    suffixes = {"x": "_position", "v": "_velocity"} if mechanical else {"": ""}
    handles = []
    for index, row in enumerate(rows):
        orders = order_text(row, suffixes)
        space = " " if len(row[name]) + len(orders) <= WIDEST_LEGEND else "\n"
        handles.append(Line2D([], [], **look(index), linewidth=1.2, label=f"{row[name]}:{space}{orders}"))
    handles.append(Line2D([], [], linestyle="none", marker="o", color=QUIET, markerfacecolor="white",
                          label="hollow: not in the fit"))
    axes.set_axis_off()
    axes.legend(handles=handles, loc="upper left", bbox_to_anchor=(0.0, 1.02), borderaxespad=0,
                title="fitted order with 95 % interval", alignment="left", title_fontsize=10.5)


def quantities_of(result, rows):
    """Position and velocity where the cases of these rows tell them apart, else the one error of the state."""
    for row in rows:
        case = result.case_of(row)
        if not all(name in case and drawable(result.values("step", case), result.values(name, case)).any()
                   for name in MECHANICAL) and result.values("step", case).size:
            return ["error"]
    return list(MECHANICAL)


def draw(result, by="problem"):
    """The figures of a convergence study, a row of panels per problem or per method."""
    other = "method" if by == "problem" else "problem"
    groups = {}
    for row in result.summary():
        groups.setdefault(row[by], []).append(row)
    names = list(groups)
    figures = []
    for first in range(0, len(names), ROWS_PER_FIGURE):
        page = names[first:first + ROWS_PER_FIGURE]
        quantities = {name: quantities_of(result, groups[name]) for name in page}
        columns = max(len(chosen) for chosen in quantities.values())
        # The last column has the legends.
        figure, axes = new_figure(result, 5.2 * columns + 5.4, 4.3 * len(page) + 0.7, len(page), columns + 1,
                                  gridspec_kw={"width_ratios": [1.0] * columns + [1.1]})
        for row_of_axes, name in zip(axes, page):
            for panel in row_of_axes[len(quantities[name]):-1]:
                panel.remove()
            for panel, quantity in zip(row_of_axes, quantities[name]):
                draw_panel(result, panel, quantity, groups[name])
                panel.set_title(name, loc="left")
            draw_legend(row_of_axes[-1], groups[name], other, quantities[name])
        figures.append(figure)
    return figures


if __name__ == "__main__":
    sys.exit(plot_style.main(__doc__, plot_style.expect_kind("convergence", draw)))
